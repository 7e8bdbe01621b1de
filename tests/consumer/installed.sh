#!/bin/sh
# Installs a build and compiles the consumer against the copy, by CMake and by pkg-config:
# installed.sh BUILD_DIR CC LINKS, where LINKS is the GRRL_MAX_LINKS of the build.
set -eu
build=$1
cc=$2
links=$3
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cmake --install "$build" --prefix "$work/first" >"$work/log" || {
    cat "$work/log"
    exit 1
}
mv "$work/first" "$work/grrl" # an installed copy must not know where it was installed

check() {
    output=$("$1")
    [ "$output" = "$links links" ] || {
        echo "$2: expected '$links links', found '$output'"
        exit 1
    }
}

cmake -S "$here" -B "$work/build" -DCMAKE_C_COMPILER="$cc" -DCMAKE_PREFIX_PATH="$work/grrl" \
    -DCMAKE_C_FLAGS='-std=c11 -Wall -Wextra -Werror'
cmake --build "$work/build"
check "$work/build/consumer" find_package

pc=$(find "$work/grrl" -name grrl.pc)
PKG_CONFIG_PATH=$(dirname "$pc")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046 # the flags are words
"$cc" -std=c11 -Wall -Wextra -Werror "$here/consumer.c" -o "$work/by_pkg_config" \
    $(pkg-config --cflags --libs grrl)
check "$work/by_pkg_config" pkg-config

# The installed programs start.
for program in "$work"/grrl/bin/*; do
    [ -e "$program" ] || continue
    "$program" --version
done
