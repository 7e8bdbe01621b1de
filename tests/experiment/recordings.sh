#!/bin/bash
# grrl-evaluate recordings: figures that make sense, the same whatever the number of jobs, and usage
# errors. ctest calls it as: recordings.sh GRRL_EVALUATE GRRL_PERCEIVE
set -u
EVALUATE=$1 PERCEIVE=$2
PROGRAM=("$EVALUATE" recordings --quiet)
# shellcheck source=tests/expect.sh
. "$(dirname "${BASH_SOURCE[0]}")/../expect.sh"

ONE='objects=R; camera=fixed'
expect 0 'Usage: grrl-evaluate recordings' --help
expect 0 '  camera    fixed, pan, roll' --help
expect 2 "'camra': must be objects, camera" --grid 'camra=roll'
expect 2 'camera=up: must be one of fixed, pan' --grid 'camera=up'
expect 2 '--count 0: must be a whole number' --count 0
expect 1 'no/grrl-perceive: cannot be run; see --program' --program no/grrl-perceive --grid "$ONE"
expect 1 'No such file' --program "$PERCEIVE" --grid "$ONE" --count 1 --csv "$WORK/no/file"

run() {
    "$EVALUATE" recordings --quiet --program "$PERCEIVE" --count 3 \
        --grid 'camera=fixed,roll; objects=R,door,two,hand' "$@" || wrong "$*: exit status $?"
}
# the last column is time
run --jobs 1 --csv "$WORK/one.csv" | sed 's/ *[0-9.]*$//' >"$WORK/one"
run --jobs 3 --csv "$WORK/three.csv" | sed 's/ *[0-9.]*$//' >"$WORK/three"
cmp "$WORK/one" "$WORK/three" || wrong "the figures depend on the number of jobs"
[ "$(wc -l <"$WORK/one.csv")" -eq 73 ] || wrong "the CSV has not 73 lines"
awk -F, 'NF != 14 { exit 1 }' "$WORK/one.csv" || wrong "rows of the CSV are not as long as its header"
awk -F, '$1 == "usual" && $4 == "ours" && $2 != "hand" { n++; right += $6 }
    END { exit !(n == 9 && right >= 6) }' "$WORK/one.csv" || wrong "most usual ones should be right"

"$EVALUATE" recordings --quiet --program "$PERCEIVE" --count 1 --grid "$ONE" --write "$WORK/written" \
    >/dev/null
head -n 1 "$WORK/written/R_usual_1.csv" | grep -qx 'frame,point,x_px,y_px,truth' ||
    wrong "the recording is not written"
"$PERCEIVE" --unit px "$WORK/written/R_usual_1.csv" >/dev/null || wrong "the recording is not read"

# a program that fails, and one that prints something else
printf '#!/bin/sh\nexit 1\n' >"$WORK/fails"
printf '#!/bin/sh\necho hello\n' >"$WORK/talks"
chmod +x "$WORK/fails" "$WORK/talks"
for program in fails talks; do
    "$EVALUATE" recordings --quiet --program "$WORK/$program" --count 1 --grid "$ONE" \
        --csv "$WORK/none.csv" >/dev/null || wrong "$program: exit status $?"
    grep -q '^usual,R,1,ours,1,0,' "$WORK/none.csv" || wrong "$program: not counted as failed"
done
if command -v gnuplot >/dev/null; then
    run --svg "$WORK/figure.svg" >/dev/null
    grep -q '<svg' "$WORK/figure.svg" || wrong "no picture"
fi
[ "$FAILURES" -eq 0 ]
