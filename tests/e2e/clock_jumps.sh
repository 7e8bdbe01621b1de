#!/bin/bash
# The time of day jumps an hour ahead and back all the time, on a bus that loses messages, so that
# repetitions are needed: the run is the same and takes no hour.
. "$(dirname "$0")/common.sh"
SIM_URL='udpm://239.255.76.67:7734?ttl=0' AGENT_URL='udpm://239.255.76.67:7735?ttl=0'
JUMPS=$(echo "$HELPERS"/libclock_jump.*)
# The sanitizer's library wants to be first, but does without.
export ASAN_OPTIONS=verify_asan_link_order=0
"$HELPERS/memq_run" RR 6 8 clean.store >memq.txt 2>&1 || fail "memq_run ended with $?"
start relay "$HELPERS/bad_bus_relay" "$SIM_URL" "$AGENT_URL" 2 0.1 0 0
relay=$LAST
start agent env LD_PRELOAD="$JUMPS" timeout 60 "$AGENT" --lcm-url "$AGENT_URL" --seed 8 \
    --store jumped.store --tracker-timeout 20
agent=$LAST
start sim env LD_PRELOAD="$JUMPS" timeout 60 "$SIM" --lcm-url "$SIM_URL" --object RR --trials 6 \
    --seed 8 --agent-timeout 20
finish "$LAST" grrl-sim
finish "$agent" grrl-agent
kill -TERM "$relay"
finish "$relay" "the relay"
grep -q ' [1-9][0-9]* lost' relay.txt || fail "no message was lost"
for program in agent sim; do
    grep -q 'the time of day jumps' "$program.txt" || fail "the clock of grrl-$program stood firm"
done
same clean.store jumped.store
