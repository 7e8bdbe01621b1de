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

# A log that is cut off ends the observer cleanly, too.
head -c 100000 run.lcm >cut.lcm
timeout 60 "$AGENT" --observe --lcm-url "file://cut.lcm?speed=0" --store cut.store >cut.txt 2>&1 ||
    fail "the observer of half a log ended with $?"
