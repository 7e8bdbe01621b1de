#!/bin/bash
# Two processes over udpm write the same experiences as one process over memq.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7721?ttl=0'
"$HELPERS/memq_run" PRP 5 7 memq.store >memq.txt 2>&1 || fail "memq_run ended with $?"
start agent timeout 60 "$AGENT" --lcm-url "$URL" --seed 7 --store udpm.store
agent=$LAST
start sim timeout 60 "$SIM" --lcm-url "$URL" --object PRP --trials 5 --seed 7
finish "$LAST" grrl-sim
finish "$agent" grrl-agent
same memq.store udpm.store
cat memq.txt sim.txt
