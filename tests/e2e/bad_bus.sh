#!/bin/bash
# A bus that loses a tenth of all messages, repeats and delays some: the learning curve and the
# experiences are those of a good bus, bit for bit.
. "$(dirname "$0")/common.sh"
SIM_URL='udpm://239.255.76.67:7729?ttl=0' AGENT_URL='udpm://239.255.76.67:7730?ttl=0'

# run NAME SIM_URL AGENT_URL
run() {
    start "agent_$1" timeout 120 "$AGENT" --lcm-url "$3" --seed 5 --store "$1.store"
    local agent=$LAST
    start "sim_$1" timeout 120 "$SIM" --lcm-url "$2" --object RPR --trials 5 --seed 5 \
        --results "$1.csv"
    finish "$LAST" "grrl-sim, $1"
    finish "$agent" "grrl-agent, $1"
}

run good "$SIM_URL" "$SIM_URL"
start relay "$HELPERS/bad_bus_relay" "$SIM_URL" "$AGENT_URL" 1 0.1 0.05 0.05
relay=$LAST
for _ in $(seq 200); do
    grep -q ready relay.txt && break
    sleep 0.05
done
run bad "$SIM_URL" "$AGENT_URL"
kill -TERM "$relay"
finish "$relay" "the relay"
cat relay.txt
grep -q ' [1-9][0-9]* lost, [1-9][0-9]* twice, [1-9][0-9]* late' relay.txt || fail "it was a good bus"
same good.csv bad.csv
same good.store bad.store
