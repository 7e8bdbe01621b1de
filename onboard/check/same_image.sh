#!/bin/bash
# same_image.sh FOLDER TARGET: replays the recorded runs on an emulated controller.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
folder=$1 target=$2
need_target "$target"
build_in "$folder/$target" "$PRESET"
for policy in $POLICIES; do
    emulate "$target" "$folder/$target/onboard/grrl-image" replay "$folder/$policy.rec" |
        tee "$folder/$target-$policy.txt"
    same "$folder/$policy.expected" "$folder/$target-$policy.txt"
done
# An image with one policy decides as one with all.
build_in "$folder/$target-alone" "$PRESET" -DONBOARD_POLICIES=learn -DGRRL_BUILD_TESTS=OFF
emulate "$target" "$folder/$target-alone/onboard/grrl-image" replay "$folder/learn.rec" \
    >"$folder/$target-alone.txt"
same "$folder/learn.expected" "$folder/$target-alone.txt"
if emulate "$target" "$folder/$target-alone/onboard/grrl-image" replay "$folder/paper.rec" \
    >"$folder/$target-refused.txt"; then
    fail "an image without the policy paper must refuse it"
fi
grep -q 'nothing found' "$folder/$target-refused.txt" || fail "not a word of the missing policy"
