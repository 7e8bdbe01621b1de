#!/bin/bash
# budget.sh FOLDER TARGET: writes the image's resource use to TARGET.rows and checks the limits. Also
# checks: no heap, no printing, no double precision, no recursion. Runs after same_image.sh.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
folder=$1 target=$2
need_target "$target"
image=$folder/$target/onboard/grrl-image

forbidden='_?(malloc|calloc|realloc|free|sbrk)(_r)?|_?[a-z]*printf(_r)?|__aeabi_d.*|__aeabi_.*2d'
forbidden+='|__.*df[0-9]?|__.*df(si|di|sf|tf)2?'
if "${CROSS}nm" "$image" | awk '{ print $NF }' | grep -xE "$forbidden"; then
    fail "these must not be linked: no heap, no printing, no double precision"
fi

mapfile -t graphs < <(find "$folder/$target" -name '*.ci')
# Calls through pointers: where they occur, and what they may call.
pointers=$(sed -n 's/.*targetname: "__indirect_call" label: "\([^"]*\)".*/\1/p' "${graphs[@]}" |
    sed 's/:.*//; s|.*/||' | sort -u | tr '\n' ' ')
[ "$pointers" = "controller.c record.c replay.c worst.c " ] ||
    fail "calls through pointers in $pointers: budget.sh does not know what they call"
awk -v root=main -v unknown=64 -v skipped="$SOURCE/onboard/image/machine.c:overflow_stack" \
    -v callbacks="machine_count $SOURCE/onboard/controller.c:hash_bytes \
$SOURCE/onboard/image/main.c:read_input" -f "$SOURCE/onboard/check/stack.awk" "${graphs[@]}" \
    >"$folder/$target.stack" || { cat "$folder/$target.stack"; fail "see above"; }

emulate "$target" "$image" worst | tee "$folder/$target.worst"
"${CROSS}size" -A -d "$image" >"$folder/$target.size"
awk -v target="$target" -f "$SOURCE/onboard/check/budget.awk" \
    policy=learn "$folder/$target-learn.txt" policy=paper "$folder/$target-paper.txt" \
    "$folder/$target.stack" "$folder/$target.size" "$folder/$target.worst" \
    >"$folder/$target.rows" || fail "over the budget"
awk -f "$SOURCE/onboard/check/table.awk" target="$target" "$folder/$target.rows"
