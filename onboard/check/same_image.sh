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
