#!/bin/bash
# pixels.sh AGENT SIM TRACK PERCEIVE: a trial in which the agent sees nothing but what grrl-track makes
# of pictures. It ends, and a second run gives the same pushes, the same points and experiences. So does
# an agent that observes the log.
. "$(dirname "$0")/../e2e/common.sh"
TRACK=$3

# run NAME PORT
run() {
    local url="udpm://239.255.76.67:$2?ttl=0" agent track
    start "track_$1" timeout 120 "$TRACK" --lcm --scale 1.56 --lcm-url "$url"
    track=$LAST
    start "agent_$1" timeout 120 "$AGENT" --lcm-url "$url" --store "$1.store"
    agent=$LAST
    start "sim_$1" timeout 120 "$SIM" --lcm-url "$url" --object RR --camera --cap 4 --seed 2 \
        --log "$1.lcm" --results "$1.csv"
    finish "$LAST" grrl-sim
    finish "$agent" grrl-agent
    finish "$track" grrl-track
}

run first 7731
run second 7732
same first.csv second.csv
same first.store second.store
start observer timeout 60 "$AGENT" --observe --lcm-url "file://first.lcm?speed=0" --store observed.store
finish "$LAST" "the observing agent"
same first.store observed.store
[ "$(wc -l <first.csv)" = 2 ] || fail "the trial did not end"
grep -Eq '^1,[1-4],(discovered|capped)$' first.csv || fail "what came of the trial?"
