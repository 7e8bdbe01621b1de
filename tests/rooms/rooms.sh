#!/bin/sh
# rooms.sh PROJECT: no room of lib/ uses one that is not below it, no header includes itself by a
# circle, and the library includes no header of C but those of rooms.txt. First, that this refuses
# small libraries in which one thing is wrong: without that it could see nothing and pass.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
project=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# check FOLDER TABLE
check() (
    cd "$1"
    # The names of our files have no spaces.
    # shellcheck disable=SC2046
    awk -f "$here/rooms.awk" "$2" $(find lib/include lib/src -name '*.[ch]' | sort)
)

# small: a library of two rooms and one beside, in $work, in which all is well
small() {
    rm -rf "${work:?}/lib"
    mkdir -p "$work/lib/include/grrl/low" "$work/lib/include/grrl/high" "$work/lib/src/low" \
        "$work/lib/src/beside"
    printf 'low\nhigh low\nbeside low\nsystem stdint.h\n' >"$work/table.txt"
    echo '#include "grrl/high/roof.h"' >"$work/lib/include/grrl/grrl.h"
    echo '#include <stdint.h>' >"$work/lib/include/grrl/low/floor.h"
    echo '#include "grrl/low/floor.h"' >"$work/lib/include/grrl/high/roof.h"
    echo '#include "low/cellar.h"' >"$work/lib/src/low/cellar.c"
    echo '#include "grrl/low/floor.h"' >"$work/lib/src/low/cellar.h"
    echo '#include "low/cellar.h"' >"$work/lib/src/beside/shed.c"
}

# refused FILE LINE MESSAGE: with this line added to a file, the check says so and fails
refused() {
    small
    mkdir -p "$(dirname "$work/$1")"
    printf '%s\n' "$2" >>"$work/$1"
    if said=$(check "$work" table.txt); then
        echo "FAILED: passes with $2 in $1"
        exit 1
    fi
    case $said in
    *"$3"*) ;;
    *)
        echo "FAILED: with $2 in $1 it must say: $3; it says: $said"
        exit 1
        ;;
    esac
}

small
check "$work" table.txt >/dev/null || {
    check "$work" table.txt
    echo "FAILED: refuses a library in which all is well"
    exit 1
}
refused lib/include/grrl/low/floor.h '#include "grrl/high/roof.h"' 'low must not use high'
refused lib/src/low/cellar.c '  # include <grrl/high/roof.h>' 'cellar.c:2: low must not use high'
refused lib/src/beside/shed.c '#include "grrl/high/roof.h"' 'beside must not use high'
refused lib/src/low/cellar.h '#include "low/cellar.h"' 'a circle: '
refused lib/include/grrl/low/floor.h '#include "grrl/high/roof.h"' 'a circle: '
refused lib/src/low/cellar.c '#include "grrl/grrl.h"' 'low includes the umbrella'
refused lib/include/grrl/high/roof.h '#include "low/cellar.h"' 'includes the private'
refused lib/src/low/cellar.c '#include "cellar.h"' 'no such file'
refused lib/src/low/cellar.c '#include <stdlib.h>' 'does without <stdlib.h>'
refused lib/src/attic/box.c '#include "low/cellar.h"' 'the folder is no room'
refused table.txt 'shed roof' 'roof, which must stand above it'

check "$project" "$here/rooms.txt"
