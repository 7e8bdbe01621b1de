#!/bin/bash
# An agent killed in mid-trial: the trial is aborted and does not count, a new agent goes on with
# the experiences of the last trial saved. Several are killed, for one may be hit between two trials.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7725?ttl=0'
start agent1 "$AGENT" --lcm-url "$URL" --store kept.store
agent=$LAST
start sim timeout 100 "$SIM" --lcm-url "$URL" --object RPRPRPR --trials 100 --results r.csv
sim=$LAST
rows() { wc -l <r.csv 2>/dev/null || echo 0; }
for round in 1 2 3 4 5; do
    before=$(rows)
    for _ in $(seq 1500); do
        [ "$(rows)" -ge $((before + 4)) ] && break
        sleep 0.02
    done
    sleep 0.01 # into the next trial
    kill -9 "$agent"
    wait "$agent" 2>/dev/null
    cp kept.store before.store || fail "nothing was saved before"
    kill -0 "$sim" 2>/dev/null || fail "the simulator ended with the agent"
    start "agent$((round + 1))" "$AGENT" --lcm-url "$URL" --store kept.store --tracker-timeout 20
    agent=$LAST
done
finish "$sim" grrl-sim
finish "$agent" "the last agent"
[ "$(grep -c -E 'discovered|capped' r.csv)" = 100 ] || fail "not 100 trials that count"
grep -q aborted r.csv || fail "no trial was aborted"
cmp -s before.store kept.store && fail "the last agent saved nothing"
exit 0
