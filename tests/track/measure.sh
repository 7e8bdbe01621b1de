#!/bin/bash
# measure.sh ROOT: the table of track/measure from runs made up here, its messages, and that nothing
# of it runs on when it is interrupted.
set -u
MEASURE=$1/track/measure
WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
cd "$WORK" || exit 1
export LC_ALL=C

fail() {
    echo "FAILED: $*"
    exit 1
}

# refused STATUS PATTERN OPTION..
refused() {
    local expected=$1 pattern=$2 status=0
    shift 2
    bash "$MEASURE" "$@" >output.txt 2>&1 || status=$?
    [ "$status" -eq "$expected" ] || fail "$*: ended with $status instead of $expected"
    grep -q -- "$pattern" output.txt || fail "$*: $(cat output.txt)"
}

refused 2 '--trials 0: must be a whole number from 1 to 1000' --trials 0
refused 2 '--policy: unknown option' --policy learn
refused 2 '--out needs a value' --out
refused 1 'nowhere/runs: no such folder' --table --out nowhere

# Two seeds from pixels: mean 6, deviation 2.16, half an interval 1.96 x 2.16 / 2; one of four capped.
# The ratio's half interval is 1.96 x 1.5 x sqrt((1.08 / 6)^2 + (1 / 4)^2).
mkdir -p out/runs
head='trial,pushes,outcome'
printf '%s\n' $head 1,4,discovered 2,5,discovered 3,1,aborted >out/runs/RPR-learn-pixels-1.csv
printf '%s\n' $head 1,6,discovered 2,9,capped >out/runs/RPR-learn-pixels-2.csv
printf '%s\n' $head 1,3,discovered 2,5,discovered >out/runs/RPR-learn-ideal-1.csv
table=$(bash "$MEASURE" --table --out out | tail -n 1)
[ "$table" = '| RPR | learn | 4 | 6.0 ± 2.1 | 4.0 ± 2.0 | 1.50 ± 0.91 | 25.0% | 0.0% |' ] || fail "$table"

# Processes that never end, each in the place of a real one.
mkdir -p tree/track tree/tools tree/build/release/{agent,sim,track}
cp "$MEASURE" tree/track/
cp "$1/tools/common.sh" tree/tools/
printf '#!/bin/sh\nexec "$@"\n' >tree/tools/network
for program in agent/grrl-agent sim/grrl-sim track/grrl-track; do
    printf '#!/bin/sh\necho $$ >>"%s/started"\nexec sleep 1000\n' "$WORK" \
        >"tree/build/release/$program"
done
chmod +x tree/tools/network tree/build/release/*/*
touch started
bash tree/track/measure --objects RPR --policies learn --jobs 2 --out endless 2>interrupted.txt &
measuring=$!
for ((i = 0; i < 600; i++)); do # all five: tracker, agent and simulator, then agent and simulator
    [ "$(wc -l <started)" -lt 5 ] || break
    sleep 0.1
done
[ "$(wc -l <started)" = 5 ] || fail "started: $(cat started)"
kill -TERM "$measuring"
status=0
wait "$measuring" || status=$?
[ "$status" -eq 143 ] || fail "interrupted: ended with $status instead of 143"
grep -q 'interrupted' interrupted.txt || fail "$(cat interrupted.txt)"
while read -r pid; do
    for ((i = 0; i < 100; i++)); do
        kill -0 "$pid" 2>/dev/null || continue 2
        sleep 0.1
    done
    fail "process $pid of an interrupted measurement runs on"
done <started
