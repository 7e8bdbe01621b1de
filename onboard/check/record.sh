#!/bin/bash
# record.sh RECORDER REPLAYER FOLDER: a learning run of 50 trials, and what it must come to.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
mkdir -p "$3"
"$1" RPRPRPR 50 1 "$3/run.rec" | tee "$3/pushes.txt"
"$2" "$3/run.rec" | tee "$3/expected.txt"
# Learning shows: the last ten trials take fewer pushes than the first ten.
awk '{ for (i = 2; i <= 11; i++) first += $i; for (i = 42; i <= 51; i++) last += $i
       print "pushes of the first ten trials", first ", of the last ten", last
       exit !(NF == 51 && last < first) }' "$3/pushes.txt" || fail "the run shows no learning"
