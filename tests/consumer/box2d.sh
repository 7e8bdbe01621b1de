#!/bin/sh
# Box2D 3 in place of 2.4 is told when configuring, whatever its package claims to be compatible with.
set -eu
# shellcheck source=tests/consumer/common.sh
. "$(dirname "$0")/common.sh"

# package VERSION COMPATIBLE: a package of that version
package() {
    echo 'set(box2d_FOUND TRUE)' >"$work/box2dConfig.cmake"
    printf 'set(PACKAGE_VERSION %s)\nset(PACKAGE_VERSION_COMPATIBLE %s)\n' "$1" "$2" \
        >"$work/box2dConfigVersion.cmake"
}

configure() {
    cmake -Dbox2d_DIR="$work" -P "$source/cmake/box2d.cmake" >"$work/log" 2>&1
}

for compatible in FALSE TRUE; do
    package 3.1.0 $compatible
    if configure; then
        wrong "Box2D 3.1.0 was taken"
    fi
    for part in 'needs Box2D 2.4' 'found 3.1.0' libbox2d-dev; do
        grep -q "$part" "$work/log" || wrong "'$part' is not in: $(cat "$work/log")"
    done
done
package 2.4.2 TRUE
configure || wrong "Box2D 2.4.2 was refused: $(cat "$work/log")"
