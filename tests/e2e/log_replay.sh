#!/bin/bash
# The log that the simulator writes teaches an observer what the live agent learned.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7722?ttl=0'
start agent timeout 60 "$AGENT" --lcm-url "$URL" --store live.store
agent=$LAST
start sim timeout 60 "$SIM" --lcm-url "$URL" --object RPR --trials 5 --log run.lcm --results r.csv
finish "$LAST" grrl-sim
finish "$agent" grrl-agent
[ "$(wc -l <r.csv)" = 6 ] || fail "r.csv does not hold a line for each trial"
timeout 60 "$AGENT" --observe --lcm-url "file://run.lcm?speed=0" --store log.store >observer.txt 2>&1 ||
    fail "the observer ended with $?"
same live.store log.store

# Every trial ended with the structure known: grrl-perceive finds it in the same frames.
for trial in 1 2 3 4 5; do
    "$PERCEIVE" --log run.lcm --trial $trial >belief.txt 2>&1 || fail "grrl-perceive ended with $?"
    if ! grep -qx 'bodies 4' belief.txt || ! grep -qx 'joints 3' belief.txt; then
        fail "grrl-perceive finds another structure in trial $trial"
    fi
done

# A log that is cut off ends the observer cleanly, too.
head -c 100000 run.lcm >cut.lcm
timeout 60 "$AGENT" --observe --lcm-url "file://cut.lcm?speed=0" --store cut.store >cut.txt 2>&1 ||
    fail "the observer of half a log ended with $?"

# A length that no memory can hold, which LCM's own reader would believe.
{
    cat run.lcm
    printf '\355\241\332\001\0\0\0\0\0\0\0\1\0\0\0\0\0\0\0\1\0\0\0\13\177\377\377\377GRRL_POINTS'
} >huge.lcm
timeout 60 "$AGENT" --observe --lcm-url "file://huge.lcm?speed=0" >huge.txt 2>&1
[ $? = 1 ] || fail "the observer of a log with a huge message did not end with 1"
grep -q 'huge.lcm: byte .*: a message of 2147483647 bytes' huge.txt || fail "it does not say why"
