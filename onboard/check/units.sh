#!/bin/bash
# units.sh FOLDER TARGET: runs the library's tests on an emulated controller. Runs after same_image.sh.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
folder=$1 target=$2
need_target "$target"
ctest --test-dir "$folder/$target" --output-on-failure | tee "$folder/$target-units.txt"
grep -q '^100% tests passed' "$folder/$target-units.txt" || fail "a test failed"
