#!/bin/bash
# kill -9 of both processes at random times, over and over: the store is always one that an
# undisturbed run of the same seeds has after some trial. Then the agent and the simulator are
# killed in turns while the store is kept: it loads every time.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7737?ttl=0'
TRIALS=12 ROUNDS=15
RANDOM=11 # the seed of the times

# The states between trials; the first is that of an agent that has learned nothing yet.
for k in $(seq "$TRIALS"); do
    "$HELPERS/memq_run" RPRPR "$k" 3 "state.$k" >>memq.txt 2>&1 || fail "memq_run ended with $?"
done
start agent "$AGENT" --lcm-url "$URL" --store state.0 --tracker-timeout 0.3
wait "$LAST"
[ -s state.0 ] || fail "an agent that starts saves nothing"

# kill_both TRIALS SECONDS: starts both, kills both so long after so many trials
kill_both() {
    start agent "$AGENT" --lcm-url "$URL" --seed 3 --store killed.store
    local agent=$LAST
    start sim "$SIM" --lcm-url "$URL" --object RPRPR --trials "$TRIALS" --seed 3 \
        --results killed.csv
    local sim=$LAST
    for _ in $(seq 2000); do
        [ "$(grep -c '^[0-9]' killed.csv 2>/dev/null)" -ge "$1" ] 2>/dev/null && break
        sleep 0.005
    done
    sleep "$2"
    kill -9 "$agent" "$sim" 2>/dev/null # or they are through
    wait "$agent" "$sim" 2>/dev/null
}

seen=
for round in $(seq "$ROUNDS"); do
    rm -f killed.store killed.store.new killed.csv
    kill_both $((RANDOM % TRIALS)) "0.0$((RANDOM % 10))"
    [ -e killed.store ] || continue # killed before the first save
    found=
    for k in $(seq 0 "$TRIALS"); do
        cmp -s "state.$k" killed.store && found=$k
    done
    [ -n "$found" ] || fail "round $round: the store is of no trial's end"
    seen="$seen $found"
done
echo "killed after trials:$seen"
[ "$(printf '%s\n' $seen | sort -u | wc -l)" -ge 3 ] || fail "always killed at the same time:$seen"

rm -f killed.store
# start_sim SEED: for the rest of this test; with nobody to answer it ends by itself
start_sim() {
    start sim "$SIM" --lcm-url "$URL" --object RPRPR --trials 100000 --seed "$1" --quiet \
        --agent-timeout 10
    sim=$LAST
}
start_sim 4
for round in $(seq 10); do
    start agent "$AGENT" --lcm-url "$URL" --store killed.store --tracker-timeout 20
    agent=$LAST
    sleep "0.$((2 + RANDOM % 8))"
    if [ $((round % 2)) = 0 ]; then
        kill -9 "$sim"
        wait "$sim" 2>/dev/null
        start_sim "$round"
        sleep 1.5 # the agent turns to the new one
    fi
    kill -9 "$agent"
    wait "$agent" 2>/dev/null
    grep -q -i 'damaged\|cannot\|ends early' agent.txt && fail "round $round: the store does not load"
done
[ -e killed.store.damaged ] && fail "a store was set aside"
kill -9 "$sim"
wait "$sim" 2>/dev/null
"$AGENT" --lcm-url "$URL" --store killed.store --tracker-timeout 0.2 >last.txt 2>&1
grep -q -i 'damaged\|cannot\|ends early' last.txt && fail "the last store does not load"
exit 0
