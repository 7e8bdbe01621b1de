#!/bin/bash
# live.sh FOLDER AGENT BRIDGE SIM RECORDER REPLAYER: the emulated controller learns on LCM, through
# its serial line. Its results must equal those of the recorder, which uses no LCM, line or emulator.
# Its last ten trials must take less than half of the pushes of random choice. Runs after
# same_image.sh.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
if [ -z "${GRRL_LIVE_NETWORK:-}" ]; then
    GRRL_LIVE_NETWORK=1 exec "$SOURCE/tools/network" bash "${BASH_SOURCE[0]}" "$@"
fi
folder=$1 agent=$2 bridge=$3 sim=$4 recorder=$5 replayer=$6
object=RPRPRPR trials=20 seed=1
need_target cortex-m4
trap 'kill $(jobs -p) 2>/dev/null || true; wait' EXIT

# simulate NAME PORT AGENT-COMMAND..: output goes to NAME.txt, the trials' pushes to NAME.csv
simulate() {
    local name=$folder/$1 url="udpm://239.255.76.67:$2?ttl=0" start=$SECONDS
    shift 2
    "$@" --lcm-url "$url" --seed "$seed" >"$name.txt" 2>&1 &
    timeout 1000 "$sim" --lcm-url "$url" --object "$object" --trials "$trials" --seed "$seed" \
        --quiet --agent-timeout 60 --results "$name.csv" || { cat "$name.txt" && fail "grrl-sim"; }
    wait $! || { cat "$name.txt" && fail "$1 ended with $?"; }
    printf '%s: %s trials in %s s\n' "${name##*/}" "$trials" $((SECONDS - start))
}

simulate random 7746 "$agent" --policy random
simulate live 7745 "$SOURCE/onboard/emulated" "$folder/cortex-m4/onboard/grrl-image" "$bridge"
cat "$folder/live.txt"
"$recorder" "$object" "$trials" "$seed" learn "$folder/live.rec"
"$replayer" "$folder/live.rec" >"$folder/live.expected"
same "$folder/live.expected" "$folder/live.txt"
awk -F, 'FNR == 1 { file++ }
    $3 == "discovered" || $3 == "capped" {
        if (file == 1) { sum += $2; n++ } else pushes[++m] = $2
    }
    END {
        for (i = m - 9; i <= m; i++) last += pushes[i] / 10
        random = n > 0 ? sum / n : 0
        printf "pushes a trial: %.1f at random, %.1f in the last ten trials learned\n", random, last
        exit !(m >= 20 && last < random / 2)
    }' "$folder/random.csv" "$folder/live.csv" || fail "the run shows no learning"
