#!/bin/bash
# A second agent and a second simulator on the same bus: the run is the same, they are told of, and
# the second agent learns nothing. What nobody answers ends by its time-out, with a message.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7732?ttl=0'
"$HELPERS/memq_run" RPRPR 60 6 clean.store >memq.txt 2>&1 || fail "memq_run ended with $?"
start agent timeout 100 "$AGENT" --lcm-url "$URL" --seed 6 --store first.store
agent=$LAST
start sim timeout 100 "$SIM" --lcm-url "$URL" --object RPRPR --trials 60 --seed 6 --results r.csv
sim=$LAST

# until_true WHAT COMMAND..: waits until the command succeeds
until_true() {
    local what=$1
    shift
    for _ in $(seq 1000); do
        "$@" 2>/dev/null && return
        sleep 0.01
    done
    fail "$what"
}

until_true "there are no results" grep -q '^2,' r.csv
start agent2 "$AGENT" --lcm-url "$URL" --seed 6 --store second.store --tracker-timeout 2
agent2=$LAST
until_true "the second agent does not wait" \
    grep -q 'another agent is in control and this one waits' agent2.txt
start sim2 "$SIM" --lcm-url "$URL" --object RR --trials 1 --agent-timeout 2
sim2=$LAST
finish "$sim" grrl-sim
finish "$agent" grrl-agent
same clean.store first.store
grep -q 'another simulator or tracker is sending' agent.txt || fail "the agent tells of no rival"
# Now the two that are left find each other or time out: both end by themselves, and say why.
wait "$agent2" || grep -q 'no simulator or tracker for 2 s' agent2.txt || fail "the second agent"
wait "$sim2" || grep -q 'no agent for 2 s' sim2.txt || fail "the second simulator"
exit 0
