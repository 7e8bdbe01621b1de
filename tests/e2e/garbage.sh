#!/bin/bash
# Random packets on every channel do not change what is learned.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7727?ttl=0'
"$HELPERS/memq_run" RPRPR 30 3 clean.store >memq.txt 2>&1 || fail "memq_run ended with $?"
start garbage "$HELPERS/garbage" "$URL" 60
start agent timeout 60 "$AGENT" --lcm-url "$URL" --seed 3 --store dirty.store
agent=$LAST
start sim timeout 60 "$SIM" --lcm-url "$URL" --object RPRPR --trials 30 --seed 3
finish "$LAST" grrl-sim
finish "$agent" grrl-agent
grep -q 'not a message of this type\|ends within\|must be' agent.txt sim.txt ||
    fail "no garbage arrived"
same clean.store dirty.store
