#!/bin/sh
# Installs a build and compiles C and C++ programs against the copy, by CMake and by pkg-config:
# installed.sh BUILD_DIR CC CXX VERSION
set -eu
build=$1 cc=$2 cxx=$3 version=$4
# shellcheck source=tests/consumer/common.sh
. "$(dirname "$0")/common.sh"
links=$(sed -n 's/^#define GRRL_MAX_LINKS //p' "$build/lib/include/grrl_capacities.h")
quiet cmake --install "$build" --prefix "$work/first"
mv "$work/first" "$work/grrl" # an installed copy must not know where it was installed
include=$work/grrl/include

# found_by_cmake LANGUAGES PROGRAM..
found_by_cmake() {
    languages=$1
    shift
    rm -rf "$work/build"
    quiet cmake -S "$here" -B "$work/build" -DCONSUMER_LANGUAGES="$languages" -DCONSUMER_VERSION="$version" \
        -DCMAKE_C_COMPILER="$cc" -DCMAKE_CXX_COMPILER="$cxx" -DCMAKE_PREFIX_PATH="$work/grrl" \
        -DCMAKE_C_FLAGS='-std=c11 -Wall -Wextra -Werror' -DCMAKE_CXX_FLAGS='-Wall -Wextra -Werror'
    quiet cmake --build "$work/build"
    for program in "$@"; do
        expect_links "$links" "$work/build/$program"
    done
}
found_by_cmake "C;CXX" consumer consumer_cxx
found_by_cmake C consumer
found_by_cmake CXX consumer_cxx

pc=$(find "$work/grrl" -name grrl.pc)
PKG_CONFIG_PATH=$(dirname "$pc")
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH") # for a shared library
export PKG_CONFIG_PATH LD_LIBRARY_PATH
[ "$(pkg-config --modversion grrl)" = "$version" ] ||
    wrong "grrl.pc: version $(pkg-config --modversion grrl), not $version"
# shellcheck disable=SC2046 # the flags are words
{
    quiet "$cc" -std=c11 -Wall -Wextra -Werror "$here/consumer.c" -o "$work/by_pkg_config" \
        $(pkg-config --cflags --libs grrl)
    quiet "$cxx" -Wall -Wextra -Werror "$here/consumer.cpp" -o "$work/by_pkg_config_cxx" \
        $(pkg-config --cflags --libs grrl)
}
expect_links "$links" "$work/by_pkg_config"
expect_links "$links" "$work/by_pkg_config_cxx"
unset LD_LIBRARY_PATH

# Each header stands alone, in C and in C++.
(cd "$include" && find grrl -name '*.h') >"$work/headers"
while read -r header; do
    printf '#include "%s"\nint alone;\n' "$header" >"$work/alone.c"
    quiet "$cc" -std=c11 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$include" "$work/alone.c"
    quiet "$cxx" -x c++ -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I"$include" "$work/alone.c"
done <"$work/headers"

# Another capacity than the library's: an error that names it.
if "$cc" -DGRRL_MAX_LINKS=$((links - 1)) -fsyntax-only -I"$include" "$here/consumer.c" \
    2>"$work/log"; then
    wrong "GRRL_MAX_LINKS=$((links - 1)) compiles against a library with $links"
fi
grep -q "GRRL_MAX_LINKS: grrl was built with $links" "$work/log" || {
    cat "$work/log"
    wrong "the error does not name the capacity"
}
quiet "$cc" -DGRRL_MAX_LINKS="$links" -fsyntax-only -I"$include" "$here/consumer.c"

# The installed programs start.
for program in "$work"/grrl/bin/*; do
    [ -e "$program" ] || continue
    "$program" --version
done
