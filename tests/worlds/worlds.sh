#!/bin/bash
# worlds.sh ROOT CASE [PROGRAM..]: the MuJoCo world, in the environment of worlds/mujoco/setup.
#   unit [GRRL-TERM]                the Python unit tests
#   lock_step GRRL-AGENT            two trials, twice: nothing stalls, and both runs are the same
#   real_time GRRL-AGENT            the same agent at the camera's rate
#   command_line                    options and exit codes
# Exit status 77: skipped.
set -u
ROOT=$1 CASE=$2
shift 2
WORLD=$ROOT/worlds/mujoco/grrl-mujoco
export LC_ALL=C

if [ ! -f "$ROOT/build/mujoco/packages.stamp" ]; then
    echo "skipped: the Python packages are missing; worlds/mujoco/setup installs them"
    exit 77
fi
"$ROOT/worlds/mujoco/setup" || exit 1 # the messages may have changed since

if [ "$CASE" = unit ]; then
    tests=$ROOT/tests/worlds
    export PYTHONPATH=$ROOT/worlds/mujoco:$ROOT/build/mujoco/types:$tests
    export PYTHONDONTWRITEBYTECODE=1 GRRL_TERM=${1:-}
    exec "$ROOT/build/mujoco/venv/bin/python" -m unittest discover -s "$tests" -t "$tests"
fi

if [ "$CASE" != command_line ] && [ -z "${GRRL_E2E_NETWORK:-}" ]; then
    export GRRL_E2E_NETWORK=1
    setup='ip link set lo up && ip route add 224.0.0.0/4 dev lo'
    if unshare -rn sh -c "$setup" 2>/dev/null; then
        exec unshare -rn sh -c "$setup && exec bash \"\$0\" \"\$@\"" "$0" "$ROOT" "$CASE" "$@"
    elif ! ip route get 239.255.76.67 2>/dev/null | grep -q 'dev lo'; then
        echo "skipped: no multicast route on lo, and no leave to make a network namespace"
        exit 77
    fi
fi

WORK=$(mktemp -d)
PIDS=()
cleanup() {
    for pid in "${PIDS[@]}"; do kill -9 "$pid" 2>/dev/null; done
    rm -rf "$WORK"
}
trap cleanup EXIT
cd "$WORK" || exit 1

fail() {
    echo "FAILED: $*"
    tail -n 20 ./*.txt
    exit 1
}

# run NAME PORT OPTION..: a run with seed 5; both processes must end with 0 within the time
run() {
    local name=$1 url="udpm://239.255.76.67:$2?ttl=0" agent
    shift 2
    timeout 120 "$AGENT" --lcm-url "$url" --seed 5 --store "$name.store" >"$name.agent.txt" 2>&1 &
    agent=$!
    PIDS+=("$agent")
    timeout 120 "$WORLD" --lcm-url "$url" --seed 5 --agent-timeout 20 --results "$name.csv" "$@" \
        >"$name.world.txt" 2>&1 || fail "the world of $name ended with $? (124: it stalled)"
    wait "$agent" || fail "the agent of $name ended with $?"
}

case $CASE in
lock_step)
    AGENT=$1
    run first 7761 --object RPR --trials 2 --cap 15 --log first.lcm
    run second 7762 --object RPR --trials 2 --cap 15 --log second.lcm
    cmp first.csv second.csv || fail "the trials differ"
    cmp first.store second.store || fail "what was learned differs"
    [ "$(wc -l <first.csv)" -eq 3 ] || fail "not two trials"
    "$AGENT" --observe --lcm-url "file://first.lcm?speed=0" --store log.store --quiet ||
        fail "the log cannot be read"
    cmp first.store log.store || fail "the log teaches something else"
    cat first.world.txt
    ;;
real_time)
    AGENT=$1
    run live 7763 --object RP --trials 1 --cap 3 --real-time
    [ "$(wc -l <live.csv)" -eq 2 ] || fail "not one trial"
    cat live.world.txt
    ;;
command_line)
    # refuses STATUS WORDS OPTION..
    refuses() {
        local want=$1 words=$2 status=0
        shift 2
        timeout 60 "$WORLD" "$@" >out.txt 2>&1 || status=$?
        [ "$status" -eq "$want" ] || fail "$* ended with $status, not $want"
        grep -q -- "$words" out.txt || fail "$* does not say: $words"
    }
    refuses 0 'Exit status' --help
    refuses 2 'required: --object'
    refuses 2 "no letter 'X'" --object RXR
    refuses 2 'cannot be read' --object no/such.grrl
    refuses 2 'cannot move' --object 'R(l1, R(l3, R(l2, l1)))'
    refuses 2 'must be a whole number from 1' --object RPR --trials 0
    refuses 2 'must be a number from 0 to 100' --object RPR --noise nan
    refuses 1 'no agent for 0.1 s' --object RPR --lcm-url memq:// --agent-timeout 0.1
    refuses 1 'no/such.csv' --object RPR --lcm-url memq:// --results no/such.csv
    "$WORLD" --object RPR --lcm-url memq:// >out.txt 2>&1 &
    pid=$!
    PIDS+=("$pid")
    sleep 3
    kill -TERM "$pid"
    wait "$pid" || fail "stopped by a signal, it ended with $?"
    ;;
*)
    fail "$CASE: there is no such case"
    ;;
esac
