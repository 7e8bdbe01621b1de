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
here=$SOURCE/onboard
count=machine_count
bytes=$here/controller.c:hash_bytes
# What calls through a pointer reach: the counter, the policies, what takes and gives bytes.
pointers="controller.c=$count learner.c=@policies policy.c=@policies record.c=$bytes"
pointers+=" replay.c=$here/image/main.c:read_input worst.c=$count,@policies"
root=main # the entry code of the RISC-V is in assembly and uses no stack
[ "$target" != cortex-m4 ] || root=reset
awk -v root="$root" -v unknown=64 -v skipped="$here/image/machine.c:overflow_stack" \
    -v pointers="$pointers" -f "$here/check/stack.awk" "${graphs[@]}" \
    >"$folder/$target.stack" || { cat "$folder/$target.stack"; fail "see above"; }

emulate "$target" "$image" worst | tee "$folder/$target.worst"
"${CROSS}size" -A -d "$image" >"$folder/$target.size"
"${CROSS}size" -A -d "$folder/$target-alone/onboard/grrl-image" | sed 's/^\./alone ./' >>"$folder/$target.size"
awk -v target="$target" -f "$SOURCE/onboard/check/budget.awk" \
    policy=learn "$folder/$target-learn.txt" policy=paper "$folder/$target-paper.txt" \
    "$folder/$target.stack" "$folder/$target.size" "$folder/$target.worst" \
    >"$folder/$target.rows" || fail "over the budget"
awk -f "$SOURCE/onboard/check/table.awk" target="$target" "$folder/$target.rows"
