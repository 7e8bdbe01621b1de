#!/bin/bash
# grrl-evaluate: figures that make sense, the same whatever the number of jobs, and usage errors.
# ctest calls it as: evaluate.sh GRRL_EVALUATE VERSION
set -u
EVALUATE=$1 VERSION=$2
PROGRAM=("$EVALUATE")
# shellcheck source=tests/expect.sh
. "$(dirname "${BASH_SOURCE[0]}")/../expect.sh"

expect 0 "^grrl-evaluate $VERSION\$" --version
expect 0 'Usage: grrl-evaluate perception' --help
expect 2 'no study: name perception or recordings'
expect 2 'no study' learning
expect 2 '--trials 0: must be a whole number' perception --trials 0
expect 2 '--noise 1;2: must be numbers' perception --noise '1;2'
expect 2 '--dropout 2: must be a number from 0 to 1' perception --dropout 2
expect 2 '--objects: RXR: ' perception --objects 'RR; RXR'
expect 1 'No such file' perception --quiet --objects RR --noise 1 --trials 1 --csv "$WORK/no/file"

run() {
    "$EVALUATE" perception --quiet --objects 'scissors; RRR; D(R(l1, l2), P(l3, l4))' --trials 3 \
        --cap 12 --noise 1,2 --dropout 0.1 --outliers 0.01 "$@" || wrong "$*: exit status $?"
}
# the last column is time
run --jobs 1 --csv "$WORK/one.csv" | sed 's/ *[0-9.]*$//' >"$WORK/one"
run --jobs 3 --csv "$WORK/three.csv" | sed 's/ *[0-9.]*$//' >"$WORK/three"
cmp "$WORK/one" "$WORK/three" || wrong "the figures depend on the number of jobs"
[ "$(wc -l <"$WORK/one.csv")" -eq 17 ] || wrong "the CSV has not 17 lines"
awk -F, 'NR == 1 { n = NF } NR > 1 && !/^"/ && NF != n { exit 1 }' "$WORK/one.csv" ||
    wrong "rows of the CSV are not as long as its header"
awk -F, '/^RRR,1,ours/ { good = $9 < 20 && $13 < 10 } END { exit !good }' "$WORK/one.csv" ||
    wrong "most of what is believed of RRR should be right"
if command -v gnuplot >/dev/null; then
    run --svg "$WORK/figure.svg" >/dev/null
    grep -q '<svg' "$WORK/figure.svg" || wrong "no picture"
fi
[ "$FAILURES" -eq 0 ]
