#!/bin/bash
# Each process stopped for longer than the other takes for a restart, and continued: the run goes on
# with the same result.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7731?ttl=0'
"$HELPERS/memq_run" RPRPR 30 4 clean.store >memq.txt 2>&1 || fail "memq_run ended with $?"
start agent timeout 100 "$AGENT" --lcm-url "$URL" --seed 4 --store kept.store
agent=$LAST
start sim timeout 100 "$SIM" --lcm-url "$URL" --object RPRPR --trials 30 --seed 4 --results r.csv
sim=$LAST

# lines N: waits until so many lines of results are there
lines() {
    for _ in $(seq 2000); do
        [ "$(wc -l <r.csv 2>/dev/null || echo 0)" -ge "$1" ] && return
        sleep 0.01
    done
    fail "there are no $1 lines of results"
}

# freeze NAME PID: timeout's child, which is the process itself
freeze() {
    local process
    process=$(pgrep -P "$2") || fail "$1 is not there any more"
    kill -STOP "$process"
    local before after
    before=$(wc -l <r.csv)
    [ "$before" -lt 31 ] || fail "the run was over before $1 was frozen"
    sleep 2.5
    grep -q '^State:.*stopped' "/proc/$process/status" || fail "$1 was not stopped"
    after=$(wc -l <r.csv)
    [ "$after" -le $((before + 1)) ] || fail "the run went on though $1 was stopped"
    kill -CONT "$process"
}

lines 3
freeze "the agent" "$agent"
lines 6
freeze "the simulator" "$sim"
finish "$sim" grrl-sim
finish "$agent" grrl-agent
same clean.store kept.store
[ "$(grep -c aborted r.csv)" = 0 ] || fail "a trial was aborted"
