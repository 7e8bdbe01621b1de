#!/bin/sh
# The Arduino library: its sources, and a sketch that includes grrl.h, compile with -I src alone.
set -eu
# shellcheck source=tests/packaging/common.sh
. "$(dirname "$0")/common.sh"
need arm-none-eabi-gcc gcc-arm-none-eabi

quiet "$source/packaging/arduino" "$work/libraries"
library=$work/libraries/grrl
for field in name version author maintainer sentence paragraph category url architectures; do
    grep -q "^$field=." "$library/library.properties" || wrong "library.properties has no $field"
done
[ -s "$library/src/$(sed -n 's/^includes=//p' "$library/library.properties")" ] ||
    wrong "the header that library.properties names is not in src"
compile_glob arduino "$library/src" arm-none-eabi-gcc -mcpu=cortex-m0plus -mthumb -I"$library/src" \
    -DGRRL_PROFILE=tiny
cat >"$work/sketch.cpp" <<'SKETCH'
#include <grrl.h>
static grrl_learner learner;
void setup() { grrl_learner_begin_trial(&learner, 1); }
SKETCH
quiet arm-none-eabi-g++ -mcpu=cortex-m0plus -mthumb -fno-exceptions -I"$library/src" \
    -DGRRL_PROFILE=tiny -c "$work/sketch.cpp" -o "$work/sketch.o"
if "$source/packaging/arduino" "$work/libraries" 2>"$work/log"; then
    wrong "an existing folder was overwritten"
fi
grep -q exists "$work/log" || wrong "not a word of the folder that exists: $(cat "$work/log")"
