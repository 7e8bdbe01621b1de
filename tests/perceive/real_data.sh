#!/bin/bash
# Real recordings, where there are any: tracks of a chain of three links and of three cars, handles
# of doors and drawers. They are no part of this project; without them the test is skipped.
. "$(dirname "$0")/common.sh"
DATA=${GRRL_SHARED:-$SOURCES/../shared}/data
if [ ! -f "$DATA/tracks/articulated.csv" ] || [ ! -f "$DATA/handles/index.csv" ]; then
    echo "skipped: GRRL_SHARED names no folder with data/tracks and data/handles"
    exit 77
fi
command -v python3 >/dev/null || {
    echo "skipped: python3 is not installed"
    exit 77
}

for name in articulated three-cars; do
    "$PERCEIVE" --json "$DATA/tracks/$name.csv" >"$WORK/$name.json" || wrong "$name: status $?"
done
python3 - "$DATA/tracks" "$WORK" <<'END' || wrong "the tracks"
import csv, itertools, json, sys

def read(name):
    rows = csv.DictReader(open(f"{sys.argv[1]}/{name}.csv"))
    return json.load(open(f"{sys.argv[2]}/{name}.json")), {
        int(row["point"]): row["truth_group"] for row in rows}

def error(model, truth):
    """Share of features in another body than their group's, under the best pairing."""
    groups = sorted(set(truth.values()))
    best = 0
    bodies = [set(body["features"]) for body in model["bodies"]]
    bodies += [set()] * max(0, len(groups) - len(bodies))
    for pairing in itertools.permutations(bodies, len(groups)):
        right = sum(truth[i] == g for g, body in zip(groups, pairing) for i in body)
        best = max(best, right)
    return 1 - best / len(truth)

chain, truth = read("articulated")
print("articulated: error", error(chain, truth), chain["term"])
assert len(chain["bodies"]) == 3 and error(chain, truth) <= 0.01
assert [j["type"] for j in chain["joints"]] == ["revolute"] * 2
ends = [end for j in chain["joints"] for end in (j["a"], j["b"])]
assert sorted(ends.count(end) for end in set(ends)) == [1, 1, 2]
cars, truth = read("three-cars")
print("three-cars: error", error(cars, truth), [j["probability"] for j in cars["joints"]])
assert len(cars["bodies"]) == 3
assert all(j["probability"] < 0.95 for j in cars["joints"])
END

right=0
called=0
total=0
while IFS=, read -r file joint _; do
    [ "$file" = file ] && continue
    total=$((total + 1))
    answer=$("$PERCEIVE" --handle "$DATA/handles/$file") || wrong "$file: status $?"
    case $joint-$answer in
    *-undetermined*) echo "$file: $joint, undetermined" ;;
    R-revolute* | P-prismatic*) right=$((right + 1)) called=$((called + 1)) ;;
    *) called=$((called + 1)) && echo "$file: $joint, but ${answer%%$'\n'*}" ;;
    esac
done <"$DATA/handles/index.csv"
echo "handles: $right right of $called called of $total"
[ $((35 * right)) -ge $((34 * called)) ] || wrong "handles: $right right of $called called"
[ $((10 * called)) -ge $((9 * total)) ] || wrong "handles: $called called of $total"
cosine=$DATA/cases/cosine-synth_cosine-noise1.log
if [ -f "$cosine" ]; then
    "$PERCEIVE" --handle "$cosine" | grep -q '^neither' || wrong "a cosine is no joint"
fi
finish
