#!/bin/bash
# A tracker and a robot without a supervisor, over a network: the agent ends by itself with the term,
# the red button ends it with 3, and each mistake is told within 3 s.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7737?ttl=0'

# plant MISTAKE SECONDS
plant() {
    start "plant_$1" "$HELPERS/own_plant" "$URL" "$2" "$1"
    PLANT=$LAST
}
end_plant() {
    kill -9 "$PLANT" 2>/dev/null
    wait "$PLANT" 2>/dev/null
}

plant none 60
timeout 60 "$AGENT" --lcm-url "$URL" --store own.store --explain --pushes 3 >pushes.txt 2>&1 ||
    fail "--pushes 3 ended with $?"
grep -q '^trial 0 after push 3: D(lb, ' pushes.txt || fail "no term after push 3"
[ "$(grep -c ' push [0-9]*: f' pushes.txt)" = 3 ] || fail "not 3 decisions"
grep -q '^found after push 3: D(lb, ' pushes.txt || fail "no term at the end"
[ -s own.store ] || fail "nothing was saved"
timeout 60 "$AGENT" --lcm-url "$URL" --until-sure 0.999 --pushes 1 >unsure.txt 2>&1
[ $? = 1 ] || fail "an agent that is not sure did not end with 1"
grep -q 'not sure after 1 push' unsure.txt || fail "it does not say that it is not sure"
timeout 60 "$AGENT" --lcm-url "$URL" --force 2 --speed 0.05 --travel 15 --table=-1,-1,1,1 --pushes 1 \
    >limits.txt 2>&1 || fail "the limits of the robot: ended with $?"
start signalled "$AGENT" --lcm-url "$URL"
agent=$LAST
sleep 1
kill -TERM "$agent"
finish "$agent" "the agent after SIGTERM"
grep -q '^found after push' signalled.txt || fail "a signal ends it without the term"
end_plant

start stopped timeout 60 "$AGENT" --lcm-url "$URL"
agent=$LAST
plant stop 3
wait "$agent"
[ $? = 3 ] || fail "GRRL_STOP did not end the agent with 3"
grep -q 'stopped by GRRL_STOP from session 78, reason COLLISION' stopped.txt || fail "it does not say why"
wait "$PLANT"

# tells MISTAKE TEXT: within 3 s, once, and counts it; the agent ends at a signal with 0
tells() {
    start "$1" timeout 60 "$AGENT" --lcm-url "$URL"
    local agent=$LAST i
    plant "$1" 20
    for i in $(seq 31); do
        grep -qs "$2" "$1.txt" && break
        sleep 0.1
    done
    [ "$i" -lt 31 ] || fail "$1: not told within 3 s: $2"
    sleep 0.5
    kill -TERM "$agent"
    finish "$agent" "$1: the agent"
    [ "$(grep -c "$2" "$1.txt")" = 1 ] || fail "$1: told more than once: $2"
    grep -q 'in all [1-9]' "$1.txt" || fail "$1: not counted"
    end_plant
}
tells no_status 'nothing acknowledges push 1 after 2 s: the robot must'
tells trial 'without a supervisor send trial_id 0'
tells rest 'the phase has been REST for 2 s'
tells millimetres 'are they millimetres?'
tells ids 'the ids change from frame to frame'
tells slow 'frames per second; it needs 10 to 100'
exit 0
