#!/bin/sh
# grrl as a part of another project (add_subdirectory, as FetchContent does it): it needs nothing but a
# C compiler, looks for nothing, installs nothing and adds no test. part.sh CC CXX
set -eu
cc=$1 cxx=$2
# shellcheck source=tests/consumer/common.sh
. "$(dirname "$0")/common.sh"

# configure LANGUAGES [OPTION..]: packages that grrl must not ask for cannot be found
configure() {
    languages=$1
    shift
    rm -rf "$work/build"
    quiet cmake -S "$here" -B "$work/build" -DGRRL_SOURCE="$source" \
        -DCONSUMER_LANGUAGES="$languages" -DCMAKE_C_COMPILER="$cc" \
        -DCMAKE_DISABLE_FIND_PACKAGE_lcm=ON -DCMAKE_DISABLE_FIND_PACKAGE_box2d=ON \
        -DCMAKE_DISABLE_FIND_PACKAGE_cmocka=ON -DCMAKE_DISABLE_FIND_PACKAGE_Boost=ON "$@"
    if grep -iE '^[^:]*(lcm|box2d|cmocka|boost|igraph|nauty|python)[^:]*:' "$work/build/CMakeCache.txt" |
        grep -v '^CMAKE_DISABLE_FIND'; then
        wrong "the configuration looked for these"
    fi
}

configure C
if grep '^CMAKE_CXX_COMPILER:' "$work/build/CMakeCache.txt"; then
    wrong "a project in C had to find a C++ compiler"
fi
quiet cmake --build "$work/build"
expect_links 16 "$work/build/consumer"
quiet cmake --install "$work/build" --prefix "$work/installed"
[ ! -e "$work/installed" ] || wrong "installed: $(find "$work/installed" -type f)"
(cd "$work/build" && ctest -N) | grep -q 'Total Tests: 0' || wrong "tests were added"

configure "C;CXX" -DCMAKE_CXX_COMPILER="$cxx" -DGRRL_MAX_LINKS=10
quiet cmake --build "$work/build"
expect_links 10 "$work/build/consumer"
expect_links 10 "$work/build/consumer_cxx"
