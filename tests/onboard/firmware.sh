#!/bin/bash
# firmware.sh FIRMWARE FEED: the example firmware, compiled for this machine, decides as a learner beside
# the simulated world does, for some trials on end, and its host tells what is wrong.
set -euo pipefail
firmware=$1 feed=$2
work=$(mktemp -d)
children=()
trap 'kill "${children[@]}" 2>/dev/null || true; rm -rf "$work"' EXIT

fail() {
    printf 'FAILED: %s\n' "$*"
    exit 1
}

export GRRL_LINE=$work/line
timeout 100 "$firmware" &
children+=($!)
timeout 100 "$feed" "$GRRL_LINE" RPR 4 1 >"$work/out" 2>&1 || { cat "$work/out" && fail "grrl-feed"; }
cat "$work/out"
grep -qE '^pushes( [0-9]+){4}$' "$work/out" || fail "not four trials"
decisions=$(sed -n 's/^decisions \([0-9]*\),.*/\1/p' "$work/out")
[ "$decisions" -ge 8 ] || fail "too few decisions for four trials"
wait "${children[0]}" || fail "the firmware ended with $?"

# What is wrong is said.
status=0
timeout 100 "$feed" "$work/nobody" RPR 1 1 >"$work/out" 2>&1 || status=$?
[ "$status" -eq 1 ] && grep -q 'no firmware there' "$work/out" || fail "nobody on the line: $(cat "$work/out")"
