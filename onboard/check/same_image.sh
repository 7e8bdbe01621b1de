#!/bin/bash
# same_image.sh FOLDER TARGET: the recorded run on an emulated controller.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
folder=$1 target=$2
need_target "$target"
build_in "$folder/$target" "$PRESET"
emulate "$target" "$folder/$target/onboard/grrl-image" "$folder/run.rec" | tee "$folder/$target.txt"
same "$folder/expected.txt" "$folder/$target.txt"
