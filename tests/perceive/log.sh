#!/bin/bash
# grrl-perceive on LCM logs: phases, trials, repeated frames, damaged messages.
. "$(dirname "$0")/common.sh"
MAKE_LOG=$4
for kind in whole damaged empty; do
    "$MAKE_LOG" "$WORK/$kind.lcm" "$kind" || wrong "make_log $kind"
done
head -c 20000 "$WORK/whole.lcm" >"$WORK/cut.lcm"
{ # a length that no memory can hold
    cat "$WORK/whole.lcm"
    printf '\355\241\332\001\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\1\0\0\0\13\177\377\377\377GRRL_POINTS'
} >"$WORK/huge.lcm"
expect 0 '^D(lb, R(' --log "$WORK/whole.lcm"
expect 0 '^60 frames of 24 tracks' --log "$WORK/whole.lcm"
expect 0 '^joints 0$' --log "$WORK/whole.lcm" --trial 1
expect 0 'warning: 36 damaged messages left out' --log "$WORK/damaged.lcm"
expect 0 '^51 frames' --log "$WORK/damaged.lcm"
expect 0 'frames of 24 tracks' --log "$WORK/cut.lcm"
expect 1 'needed, this has none' --log "$WORK/empty.lcm"
expect 1 'no points of trial 3; leave --trial away' --log "$WORK/whole.lcm" --trial 3
expect 1 'huge.lcm: byte .*: a message of 2147483647 bytes' --log "$WORK/huge.lcm"
expect 2 'does not go with --log' --log "$WORK/whole.lcm" --unit mm
finish
