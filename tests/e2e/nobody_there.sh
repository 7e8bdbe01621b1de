#!/bin/bash
# An agent without a simulator and one that has lost it say what they wait for, and end with 1 after
# --tracker-timeout; an agent that sees nothing ends the simulator's run with a message.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7733?ttl=0'
"$AGENT" --lcm-url "$URL" --tracker-timeout 0.5 >alone.txt 2>&1
[ $? = 1 ] || fail "the agent alone did not end with 1"
grep -q 'no simulator or tracker for 0.5 s' alone.txt || fail "the agent alone does not say why"

start agent timeout 60 "$AGENT" --lcm-url "$URL" --tracker-timeout 6 --store kept.store
agent=$LAST
start sim "$SIM" --lcm-url "$URL" --object RPRPR --trials 1000 --results r.csv
sim=$LAST
for _ in $(seq 1500); do
    [ "$(wc -l <r.csv 2>/dev/null || echo 0)" -ge 3 ] && break
    sleep 0.02
done
kill -9 "$sim"
wait "$sim" 2>/dev/null
wait "$agent"
[ $? = 1 ] || fail "the agent that lost its simulator did not end with 1"
grep -q 'waiting for points on the same LCM provider: start grrl-sim' agent.txt ||
    fail "the agent does not say what it waits for"
[ -s kept.store ] || fail "the experiences are gone"

start agent2 "$AGENT" --lcm-url "$URL"
timeout 60 "$SIM" --lcm-url "$URL" --object RR --dropout 1 >blind.txt 2>&1
[ $? = 1 ] || fail "a run in which nothing is seen did not end with 1"
grep -q 'finds nothing to push' blind.txt || fail "the simulator does not say why it ends"
grep -q 'no link is visible that could be pushed' agent2.txt || fail "the agent does not tell"
