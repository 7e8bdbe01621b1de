#!/bin/sh
# CMake and the header agree on every capacity of every profile, and refuse a profile that is none.
# profiles.sh CC
set -eu
cc=$1
# shellcheck source=tests/packaging/common.sh
. "$(dirname "$0")/common.sh"

configure() {
    rm -rf "$work/build"
    cmake -S "$source" -B "$work/build" -DCMAKE_C_COMPILER="$cc" -DGRRL_BUILD_PROCESSES=OFF \
        -DGRRL_BUILD_TESTS=OFF -DGRRL_BUILD_BENCH=OFF -DGRRL_BUILD_TOOLS=OFF "$@" >"$work/log" 2>&1
}

# from_header OPTION..: the numbers, one a line, as the preprocessor has them
from_header() {
    {
        echo '#include "grrl/base/config.h"'
        while read -r name; do
            echo "capacity $name ($name)" | sed 's/capacity GRRL/capacity _GRRL/'
        done <"$work/names"
    } | "$cc" "$@" -I"$source/lib/include" -E -P -x c - | sed -n 's/^capacity //p' |
        while read -r name value; do
            # shellcheck disable=SC2004 # an expression of the preprocessor
            echo "${name#_} $(($value))"
        done
}

numbers=
for profile in tiny small default large; do
    configure -DGRRL_PROFILE=$profile || wrong "$profile: $(cat "$work/log")"
    sed -n 's/^#define \(GRRL_[A-Z_]*\) \([0-9]*\)$/\1 \2/p' \
        "$work/build/lib/include/grrl_capacities.h" >"$work/cmake"
    cut -d ' ' -f 1 "$work/cmake" >"$work/names"
    [ "$(wc -l <"$work/names")" -ge 11 ] || wrong "$profile: $(cat "$work/cmake")"
    from_header -DGRRL_PROFILE=$profile >"$work/header"
    diff "$work/cmake" "$work/header" || wrong "$profile: CMake and config.h differ"
    [ "$(sort -u "$work/cmake")" != "$numbers" ] || wrong "$profile is the profile before it"
    numbers=$(sort -u "$work/cmake")
done

# A number comes before the profile; nothing is the profile default.
from_header -DGRRL_PROFILE=tiny -DGRRL_MAX_LINKS=9 | grep -qx 'GRRL_MAX_JOINTS 18' || wrong "9 links"
from_header >"$work/none"
from_header -DGRRL_PROFILE=default | diff - "$work/none" || wrong "no profile is not default"

echo '#include "grrl/base/config.h"' |
    "$cc" -DGRRL_PROFILE=medium -I"$source/lib/include" -fsyntax-only -x c - 2>"$work/log" &&
    wrong "the header took the profile medium"
grep -q 'GRRL_PROFILE must be tiny, small, default or large' "$work/log" || wrong "$(cat "$work/log")"
if configure -DGRRL_PROFILE=medium; then
    wrong "CMake took the profile medium"
fi
grep -q "GRRL_PROFILE is 'medium': it must be tiny, small, default or large" "$work/log" ||
    wrong "$(cat "$work/log")"
