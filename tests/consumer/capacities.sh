#!/bin/sh
# Without CMake, from the sources alone: library and program of the same capacities link and agree,
# those of others do not link. capacities.sh CC
set -eu
cc=$1
# shellcheck source=tests/consumer/common.sh
. "$(dirname "$0")/common.sh"
cd "$work"
# shellcheck disable=SC2046 # our file names have no spaces
quiet "$cc" -std=c11 -DGRRL_MAX_LINKS=12 -I"$source/lib/include" -I"$source/lib/src" -c \
    $(find "$source/lib/src" -name '*.c')
quiet ar rcs libgrrl.a ./*.o

# with DEFINITION..: a program on this library
with() {
    "$cc" -std=c11 "$@" -I"$source/lib/include" "$here/consumer.c" -o consumer libgrrl.a -lm 2>log
}

with -DGRRL_MAX_LINKS=12 || wrong "does not link: $(cat log)"
expect_links 12 ./consumer
with -DGRRL_MAX_LINKS=12 -DGRRL_MAX_JOINTS=24 || wrong "the default, spelled out: $(cat log)"
for other in -DGRRL_MAX_LINKS=11 -DGRRL_MAX_LINKS=16 "-DGRRL_MAX_LINKS=12 -DGRRL_MAX_JOINTS=20" \
    "-DGRRL_MAX_LINKS=12 -DGRRL_SYMBOL_BYTES=8"; do
    # shellcheck disable=SC2086 # words
    if with $other; then
        wrong "$other: links with a library of other capacities"
    fi
    grep -q 'undefined.*grrl_graph_clear_links' log || wrong "$other: $(cat log)"
done

# Values that are no plain number.
for value in many 16+1 0; do
    rm -rf build
    if cmake -S "$source" -B build -DCMAKE_C_COMPILER="$cc" -DGRRL_BUILD_PROCESSES=OFF \
        -DGRRL_BUILD_TESTS=OFF -DGRRL_BUILD_BENCH=OFF -DGRRL_MAX_LINKS=$value >log 2>&1; then
        wrong "GRRL_MAX_LINKS=$value was taken"
    fi
    grep -q "GRRL_MAX_LINKS is '$value'" log || wrong "$value: $(cat log)"
done
