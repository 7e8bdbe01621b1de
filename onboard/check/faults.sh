#!/bin/bash
# faults.sh FOLDER TARGET: a fault ends the image with its own exit code. Runs after same_image.sh.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
folder=$1 target=$2
need_target "$target"
# fault and exit code: 16 and the number of the exception
codes='null=20 address=21 stack=20 divide=22 assert=3 none=0'
[ "$target" = cortex-m4 ] || codes='null=21 address=23 stack=23 assert=3 none=0'
for pair in $codes; do
    code=0
    emulate "$target" "$folder/$target/onboard/grrl-image" fault "${pair%=*}" || code=$?
    printf '%s: exit code %s\n' "${pair%=*}" "$code"
    [ "$code" -eq "${pair#*=}" ] || fail "${pair%=*} must exit with ${pair#*=}"
done
code=0
emulate "$target" "$folder/$target/onboard/grrl-image" replay "$folder/learn.pushes" >/dev/null ||
    code=$?
[ "$code" -eq 1 ] || fail "a file that is not a recording must give exit code 1, not $code"
