#!/bin/bash
# grrl-perceive on LCM logs: phases, trials, repeated frames, damaged messages.
. "$(dirname "$0")/common.sh"
MAKE_LOG=$4
for kind in whole damaged empty; do
    "$MAKE_LOG" "$WORK/$kind.lcm" "$kind" || wrong "make_log $kind"
done
head -c 20000 "$WORK/whole.lcm" >"$WORK/cut.lcm"
expect 0 '^D(lb, R(' --log "$WORK/whole.lcm"
expect 0 '^60 frames of 24 tracks' --log "$WORK/whole.lcm"
expect 0 '^joints 0$' --log "$WORK/whole.lcm" --trial 1
expect 0 'warning: 36 damaged messages left out' --log "$WORK/damaged.lcm"
expect 0 '^51 frames' --log "$WORK/damaged.lcm"
expect 0 'frames of 24 tracks' --log "$WORK/cut.lcm"
expect 1 'needed, this has none' --log "$WORK/empty.lcm"
expect 1 'no points of trial 3; leave --trial away' --log "$WORK/whole.lcm" --trial 3
expect 2 'does not go with --log' --log "$WORK/whole.lcm" --unit mm
finish
