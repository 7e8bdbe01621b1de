#!/bin/bash
# bridge.sh AGENT SIM HELPERS BRIDGE CONTROLLER: grrl-bridge and a controller do as grrl-agent does,
# push for push, and damaged bytes on the line between them change nothing.
BRIDGE=$4 CONTROLLER=$5
. "$(dirname "$0")/../e2e/common.sh"

# simulate NAME PORT AGENT-COMMAND..: the trials with this agent, their results in NAME.csv
simulate() {
    local name=$1 url="udpm://239.255.76.67:$2?ttl=0" agent
    shift 2
    start "$name-agent" timeout 200 "$@" --lcm-url "$url" --seed 7
    agent=$LAST
    start "$name-sim" timeout 200 "$SIM" --lcm-url "$url" --object PRPR --trials 6 --seed 7 \
        --agent-timeout 60 --results "$name.csv" --log "$name.lcm"
    finish "$LAST" grrl-sim
    finish "$agent" "$name"
    grep -E '^(models|decisions|updates|store) ' "$name-agent.txt" >"$name.hashes"
}

# on_line NAME PORT DAMAGE: with a controller behind a line that damages one byte in DAMAGE
on_line() {
    start "$1-controller" timeout 200 "$CONTROLLER" --socket "$1.socket" --damage "$3" --seed 5
    local controller=$LAST
    simulate "$1" "$2" "$BRIDGE" --serial "$1.socket"
    finish "$controller" grrl-controller
}

simulate agent 7741 "$AGENT" --experiences 256
on_line clean 7742 0
on_line noisy 7743 4000
[ "$(wc -l <agent.csv)" -ge 7 ] || fail "no results"
same agent.csv clean.csv
same agent.csv noisy.csv
[ "$(wc -l <clean.hashes)" -eq 4 ] || fail "no hashes"
same clean.hashes noisy.hashes
line=$(grep '^line: ' noisy-agent.txt)
echo "$line"
[[ $line =~ damaged\ frames:\ ([0-9]+)\ out,\ ([0-9]+)\ in ]] || fail "no count of damaged frames"
[ "${BASH_REMATCH[1]}" -gt 20 ] && [ "${BASH_REMATCH[2]}" -gt 5 ] || fail "the noise was too weak"
grep -q 'damaged frames: 0 out, 0 in; 0 requests resent, 0 surplus answers' clean-agent.txt ||
    fail "damage on a clean line"

# The bridge has no learning in it; the agent has, so that these names mean something.
learning=' T grrl_(cases_learn|experience_update|learn_choose|perception_update|grounding_push)$'
[ "$(nm "$AGENT" | grep -cE "$learning")" -eq 5 ] || fail "grrl-agent does not learn?"
! nm "$BRIDGE" | grep -E "$learning" || fail "grrl-bridge learns by itself"

# A controller that goes away ends the bridge.
url='udpm://239.255.76.67:7744?ttl=0'
start gone-controller "$CONTROLLER" --socket gone.socket
controller=$LAST
start gone-agent timeout 60 "$BRIDGE" --lcm-url "$url" --serial gone.socket
bridge=$LAST
start gone-sim "$SIM" --lcm-url "$url" --object RPRPRPR --trials 1000 --results gone.csv
for _ in $(seq 1500); do
    [ "$(wc -l <gone.csv 2>/dev/null || echo 0)" -ge 2 ] && break
    sleep 0.02
done
kill -9 "$controller"
status=0
wait "$bridge" || status=$?
[ "$status" -eq 1 ] || fail "grrl-bridge ended with $status and not 1"
grep -q 'gone.socket: ' gone-agent.txt || fail "not a word of the line that is gone"

# What is wrong is said.
expect() {
    local status=$1 text=$2 got=0
    shift 2
    "$@" >said.txt 2>&1 || got=$?
    [ "$got" -eq "$status" ] || fail "exit status $got and not $status of: $*"
    grep -q -- "$text" said.txt || fail "not a word of \"$text\" from: $*"
}
expect 0 'Usage: grrl-bridge' "$BRIDGE" --help
expect 0 'grrl-bridge [0-9]' "$BRIDGE" --version
expect 2 'serial is required' "$BRIDGE"
expect 2 'a name of 1 to 15' "$BRIDGE" --serial x --policy much-longer-than-a-name
expect 2 'must be a whole number from 0' "$BRIDGE" --serial x --seed -1
expect 2 'no arguments' "$BRIDGE" --serial x y
expect 2 'serial: given twice' "$BRIDGE" --serial x --serial y
expect 1 'start the controller first' "$BRIDGE" --serial ./none.socket --lcm-url "$url"
: >file
expect 1 'file' "$BRIDGE" --serial ./file --lcm-url "$url"
expect 2 'must be a whole number' "$CONTROLLER" --socket x --damage few
expect 2 'socket is required' "$CONTROLLER"
