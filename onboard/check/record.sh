#!/bin/bash
# record.sh RECORDER REPLAYER FOLDER: records a learning run of 50 trials for each policy, and its
# expected results.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
mkdir -p "$3"
for policy in $POLICIES; do
    "$1" RPRPRPR 50 1 "$policy" "$3/$policy.rec" | tee "$3/$policy.pushes"
    "$2" "$3/$policy.rec" | tee "$3/$policy.expected"
    # The run must show learning: the last ten trials take fewer pushes than the first ten.
    awk '{ for (i = 2; i <= 11; i++) first += $i; for (i = 42; i <= 51; i++) last += $i
           print "pushes of the first ten trials", first ", of the last ten", last
           exit !(NF == 51 && last < first) }' "$3/$policy.pushes" ||
        fail "the run of the policy $policy shows no learning"
done
! cmp -s "$3/learn.expected" "$3/paper.expected" || fail "both policies give the same results"
