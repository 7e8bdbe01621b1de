#!/bin/bash
# grrl-perceive on LCM logs: phases, trials, repeated frames, damaged messages, damaged logs, several
# sessions.
. "$(dirname "$0")/common.sh"
MAKE_LOG=$4
for kind in whole damaged empty mixed restarted ended; do
    "$MAKE_LOG" "$WORK/$kind.lcm" "$kind" || wrong "make_log $kind"
done
SIZE=$(stat -c %s "$WORK/whole.lcm")
EVENTS=240                 # all of one size
EVENT=$((SIZE / EVENTS))
[ $((EVENT * EVENTS)) -eq "$SIZE" ] || wrong "the events differ in size"

# cut FROM TO NAME: the whole log without those bytes
cut_out() {
    { head -c "$1" "$WORK/whole.lcm"; tail -c +$(($2 + 1)) "$WORK/whole.lcm"; } >"$WORK/$3.lcm"
}
expect 0 '^D(lb, R(' --log "$WORK/whole.lcm"
expect 0 '^60 frames of 24 tracks' --log "$WORK/whole.lcm"
expect 0 '"whole": true' --log "$WORK/whole.lcm" --json
expect 0 '"warnings": \[\]' --log "$WORK/whole.lcm" --json
expect 0 '^joints 0$' --log "$WORK/whole.lcm" --trial 1
expect 0 'warning: 36 damaged messages left out' --log "$WORK/damaged.lcm"
expect 0 '^51 frames' --log "$WORK/damaged.lcm"
expect 1 'no messages on GRRL_POINTS' --log "$WORK/empty.lcm"
expect 1 'no points of trial 3; omit --trial' --log "$WORK/whole.lcm" --trial 3
expect 1 'a regular file, since it is read twice' --log "$WORK"
expect 2 'does not work with --log' --log "$WORK/whole.lcm" --unit mm

# bytes cut out within trial 1: trial 2 is whole, trial 1 is not
from=$((40 * EVENT + 100)) to=$((43 * EVENT + 17))
cut_out $from $to hole
where="damaged at byte $((40 * EVENT)) and whole again at byte $((41 * EVENT + 83))"
expect 0 "$where" --log "$WORK/hole.lcm"
expect 0 'trial 2 is read, which the damage does not affect' --log "$WORK/hole.lcm"
expect 0 '"whole": true' --log "$WORK/hole.lcm" --json
expect 0 '^60 frames' --log "$WORK/hole.lcm"
expect 0 'trial 1 is read, and frames of it may be lost there' --log "$WORK/hole.lcm" --trial 1
expect 0 '"damages": 1, .*"whole": false' --log "$WORK/hole.lcm" --trial 1 --json
expect 0 '^58 frames' --log "$WORK/hole.lcm" --trial 1 # of each frame there are two
# from one event's beginning to another's, and over the border of two trials
cut_out $((40 * EVENT)) $((50 * EVENT)) seam
expect 0 "lacks events before byte $((40 * EVENT));" --log "$WORK/seam.lcm"
cut_out $((110 * EVENT + 5)) $((130 * EVENT)) border
expect 0 'trial 2 is read, and frames of it may be lost there' --log "$WORK/border.lcm"
expect 0 'trial 1 is read, and frames of it may be lost there' --log "$WORK/border.lcm" --trial 1
# bytes too many, and a zero in a sync word
{ head -c $((EVENT * 200)) "$WORK/whole.lcm"; printf 'garbage'
  tail -c +$((EVENT * 200 + 1)) "$WORK/whole.lcm"; } >"$WORK/more.lcm"
expect 0 'trial 2 is read, and frames of it' --log "$WORK/more.lcm"
cp "$WORK/whole.lcm" "$WORK/zero.lcm"
printf '\0' | dd of="$WORK/zero.lcm" bs=1 seek=$((7 * EVENT)) conv=notrunc status=none
expect 0 "damaged at byte $((6 * EVENT)) and whole again at byte $((8 * EVENT));" \
    --log "$WORK/zero.lcm"
# cut off, within an event and within a trial
head -c $((EVENT * 20 + 1)) "$WORK/whole.lcm" >"$WORK/cut.lcm"
expect 0 "cut off or damaged from byte $((EVENT * 20)) to its end" --log "$WORK/cut.lcm"
expect 0 'trial 1 is read, and frames of it may be lost there' --log "$WORK/cut.lcm"
expect 0 'frames of 24 tracks' --log "$WORK/cut.lcm"
# a length that no memory can hold
{
    cat "$WORK/whole.lcm"
    printf '\355\241\332\001\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\1\0\0\0\13\177\377\377\377GRRL_POINTS'
} >"$WORK/huge.lcm"
expect 0 "cut off or damaged from byte $SIZE to its end" --log "$WORK/huge.lcm"

# every cut of a few events: an answer or a message, and never an answer that claims to be whole
head -c $((EVENT * 3)) "$WORK/whole.lcm" >"$WORK/few.lcm"
for n in $(seq 1 97 $((EVENT * 3 - 1))); do
    head -c "$n" "$WORK/few.lcm" >"$WORK/part.lcm"
    output=$("$PERCEIVE" --json --log "$WORK/part.lcm" 2>&1)
    case $?-$output in
    1-*'no messages on GRRL_POINTS'*) ;;
    0-*'is read, and frames of it may be lost'*'"whole": false'*) ;;
    0-*'"whole": true'*) [ $((n % EVENT)) -eq 0 ] || wrong "cut at $n: no word of it" ;;
    *) wrong "cut at $n: $output" ;;
    esac
done

# two senders, and one after the other
expect 0 'of 2 sessions are mixed: .* only session 7, which has the most' --log "$WORK/mixed.lcm"
expect 0 '^D(lb, R(' --log "$WORK/mixed.lcm"
expect 0 '^60 frames of 24 tracks' --log "$WORK/mixed.lcm"
expect 0 '"session": 7, "sessions": 2, "interleaved": true' --json --log "$WORK/mixed.lcm"
expect 0 '2 sessions, one after the other; only session 7' --log "$WORK/restarted.lcm"
expect 0 '^60 frames of 24 tracks' --log "$WORK/restarted.lcm"
# what the supervisor says
expect 0 'the log has no end of trial 2' --log "$WORK/ended.lcm"
expect 0 '"whole": true' --log "$WORK/ended.lcm" --trial 1 --json
finish
