#!/bin/sh
# The same for a microcontroller: a C and a C++ program with grrl as a part of their project, and grrl
# by itself, which is then the library alone.
set -eu
# shellcheck source=tests/consumer/common.sh
. "$(dirname "$0")/common.sh"
for compiler in arm-none-eabi-gcc arm-none-eabi-g++; do
    command -v "$compiler" >/dev/null || skip "there is no $compiler (Debian: gcc-arm-none-eabi)"
done
echo '#include <string.h>' | arm-none-eabi-gcc -E - >/dev/null 2>&1 ||
    skip "there is no C library (Debian: libnewlib-arm-none-eabi)"

quiet cmake -S "$here" -B "$work/part" --toolchain "$here/arm.cmake" -DGRRL_SOURCE="$source"
quiet cmake --build "$work/part"
for program in consumer consumer_cxx; do
    arm-none-eabi-nm "$work/part/$program" | grep -q ' T grrl_perception_observe$\| T grrl_graph_add_link$' ||
        wrong "$program: the library is not in it"
done

quiet cmake -S "$source" -B "$work/alone" --toolchain "$here/arm.cmake"
if grep -E '^GRRL_(BUILD|CHECK)_[A-Z]*:BOOL=ON' "$work/alone/CMakeCache.txt"; then
    wrong "these are on for a machine that is not ours"
fi
grep -q '^GRRL_BUILD_TESTS:BOOL=OFF' "$work/alone/CMakeCache.txt" || wrong "no options were found"
