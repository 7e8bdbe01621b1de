#!/bin/bash
# A simulator killed in mid-trial: the agent abandons the trial and serves the next simulator.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7726?ttl=0'
start agent timeout 60 "$AGENT" --lcm-url "$URL" --store kept.store
agent=$LAST
start sim "$SIM" --lcm-url "$URL" --object RPRPRPR --trials 1000 --results r.csv
sim=$LAST
for _ in $(seq 1500); do
    [ "$(wc -l <r.csv 2>/dev/null || echo 0)" -ge 3 ] && break
    sleep 0.02
done
kill -9 "$sim"
wait "$sim" 2>/dev/null
kill -0 "$agent" 2>/dev/null || fail "the agent ended with the simulator"
start sim2 timeout 60 "$SIM" --lcm-url "$URL" --object RR --trials 3
finish "$LAST" "the second simulator"
finish "$agent" grrl-agent
grep -q 'restarted' agent.txt || fail "the agent did not notice"
