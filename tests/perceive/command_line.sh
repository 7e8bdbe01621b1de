#!/bin/bash
# grrl-perceive on recordings made here: a hinge, a slide, a handle; and what it refuses.
. "$(dirname "$0")/common.sh"

# tracks KIND SCALE: two links of 12 features, the second turned by up to 40 degrees or slid by 30 mm
tracks() {
    awk -v kind="$1" -v scale="$2" 'BEGIN {
        srand(1)
        print "point,frame,y,x,visible"
        for (f = 0; f <= 60; f++)
            for (i = 0; i < 36; i++) {
                u = 0.13 * (i % 12 + 0.5) / 12
                v = (i * 7 % 5 - 2) * 0.008
                if (i < 12) { x = u - 0.13; y = v }
                else if (i >= 24) { x = (i * 13 % 12 - 6) * 0.15; y = (i * 5 % 7 - 3) * 0.2 + 0.1 }
                else if (kind == "R") {
                    a = 0.7 * f / 60
                    x = u * cos(a) - v * sin(a); y = u * sin(a) + v * cos(a)
                } else { x = u + 0.03 * f / 60; y = v }
                if (i < 24) { # the object as a whole turns and moves
                    b = 0.3 * f / 60
                    t = x * cos(b) - y * sin(b) + 0.05 * f / 60
                    y = x * sin(b) + y * cos(b); x = t
                }
                n = 0.0002
                x += n * (rand() + rand() + rand() - 1.5) * 2; y += n * (rand() + rand() - 1) * 2
                printf "%d,%d,%.6f,%.6f,%d\n", i * 3 + 100, f, y * scale, x * scale, 1
            }
    }'
}
tracks R 1 >"$WORK/hinge.csv"
tracks P 1000 >"$WORK/slide.csv"

expect 0 "^grrl-perceive $VERSION\$" --version
expect 0 '^Usage: grrl-perceive' --help
expect 0 '^D(lb, R(' "$WORK/hinge.csv"
expect 0 '^bodies 2$' "$WORK/hinge.csv"
expect 0 'f1 f2 revolute\|f2 f1 revolute' "$WORK/hinge.csv"
expect 0 '^D(lb, P(' --unit mm "$WORK/slide.csv"
expect 0 '"type": "prismatic"' --unit mm --json "$WORK/slide.csv"
expect 0 '"noise": 0.5,' --unit mm --noise 0.5 --json "$WORK/slide.csv"
expect 0 'profile tracker, noise 0.1[6-9]' --unit mm --noise auto "$WORK/slide.csv"
expect 0 'D(lb, R(' --noise auto "$WORK/hinge.csv"
expect 0 'profile tracker, noise 0.7 mm' --unit mm "$WORK/slide.csv"
expect 0 'profile camera, noise 1 px' --unit px "$WORK/slide.csv"
expect 0 'profile tracker, noise 1.5 px' --unit px --profile tracker --noise 1.5 "$WORK/slide.csv"

# the samples that the documentation shows, and one in the wrong unit
SAMPLES=$(dirname "$0")/../../examples
expect 0 'pivot (40.1, -19.69) +- (0.62, 0.62) mm, seen from 0 to 40.1 degrees' \
    --unit mm "$SAMPLES/hinge.csv"
expect 0 '^revolute 0.99' --handle "$SAMPLES/door.txt"
expect 0 'all points lie within 1[.].* mm.*is the unit right?' --unit mm "$WORK/hinge.csv"

# the order of rows means nothing, standard input is a file
{ head -1 "$WORK/hinge.csv"; tail -n +2 "$WORK/hinge.csv" | sort -r; } >"$WORK/reversed.csv"
"$PERCEIVE" --json "$WORK/hinge.csv" >"$WORK/a.json"
"$PERCEIVE" --json - <"$WORK/reversed.csv" >"$WORK/b.json"
cmp "$WORK/a.json" "$WORK/b.json" || wrong "the answer depends on the order of the rows"
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys
model = json.load(open(sys.argv[1]))
assert model["format"] == "grrl-perceive 1", model
assert len(model["bodies"]) == 2 and len(model["joints"]) == 1, model
joint = model["joints"][0]
assert joint["type"] == "revolute" and len(joint["covariance"]) == 3, joint
total = joint["p_revolute"] + joint["p_prismatic"] + joint["p_disconnected"]
assert abs(total - 1) < 1e-3, joint
ids = sorted(i for body in model["bodies"] for i in body["features"])
assert len(set(ids)) == len(ids) >= 22 and min(ids) >= 100, ids' "$WORK/a.json" ||
        wrong "the JSON is not as documented"
fi

# the picture
expect 0 '^D(lb, R(' --svg "$WORK/hinge.svg" "$WORK/hinge.csv"
grep -q '<ellipse' "$WORK/hinge.svg" && grep -q '^</svg>$' "$WORK/hinge.svg" || wrong "the picture"
expect 0 '^D(lb, P(' --unit mm --svg "$WORK/slide.svg" "$WORK/slide.csv"
grep -q 'stroke-dasharray' "$WORK/slide.svg" || wrong "the picture has no sliding axis"
expect 1 'No such file' --svg "$WORK/no/folder.svg" "$WORK/hinge.csv"

expect 2 'picture.PNG: must be a file for SVG' --svg picture.PNG "$WORK/hinge.csv"

# what camera and motion left open is said: a tilted table, a drawer pulled once, a link of two points
awk 'BEGIN { srand(3); print "frame,point,x_px,y_px"
    for (f = 0; f <= 40; f++) for (i = 0; i < 40; i++) {
        if (i < 24) { x = (i % 6) * 200; y = int(i / 6) * 150 }
        else if (i < 38) { x = 300 + (i % 7) * 40 + 3 * f; y = 200 + 60 * (i > 30) }
        else { x = 900 - 3 * f; y = 90 + 40 * (i - 38) + 2 * f }
        printf "%d,%d,%.2f,%.2f\n", f, i, x + rand(), y + rand() } }' >"$WORK/drawer.csv"
expect 0 'undetermined (.*: slid once, which independent motion explains as well' "$WORK/drawer.csv"
expect 0 'warning: 2 points move with no body: links of fewer than 4 points' "$WORK/drawer.csv"
# a door of two points before a wall: they move, and are no part of the wall
awk 'BEGIN { srand(5); print "frame,point,x_px,y_px"
    for (f = 0; f <= 120; f++) for (i = 0; i < 14; i++) {
        if (i < 12) { x = (i % 4) * 300; y = int(i / 4) * 250 }
        else { a = 0.8 * (f < 40 ? 0 : f < 80 ? (f - 40) / 40 : 3 - f / 40)
            x = 420 + (i - 9) * 40 * cos(a); y = 300 + (i - 9) * 40 * sin(a) }
        printf "%d,%d,%.2f,%.2f\n", f, i, x + rand(), y + rand() } }' >"$WORK/ajar.csv"
expect 0 'warning: 2 points move with no body: links of fewer than 4 points' "$WORK/ajar.csv"
expect 0 '"unassigned": \[12, 13\]' --json "$WORK/ajar.csv"
awk 'BEGIN { srand(4); print "frame,point,x_px,y_px"
    for (f = 0; f <= 60; f++) for (i = 0; i < 54; i++) {
        if (i < 30) { x = (i % 6 - 2.5) * 200; y = (int(i / 6) - 2) * 160 }
        else { u = (i % 12) * 30; v = i % 2 * 70 - 35; a = 1.4 * f / 60
            x = u * cos(a) - v * sin(a) - 100; y = u * sin(a) + v * cos(a) - 60 }
        s = 2600 / (2600 + 0.5 * y)
        printf "%d,%d,%.2f,%.2f\n", f, i, 640 + s * x + rand() - 0.5, 360 + s * 0.866 * y + rand() - 0.5 } }' \
    >"$WORK/tilted.csv"
expect 0 'warning: the camera looks at the plane from [23].* degrees aside: undone' "$WORK/tilted.csv"
expect 0 '^D(lb, R(L(l, f1), L(l, f2)))$' "$WORK/tilted.csv"

# the same table by four points of it, in mm: pivot at (-100, -60), 1.4 rad; another order is no table
CORNERS=$(awk 'BEGIN { for (i = 0; i < 4; i++) {
    x = i % 2 * 1000 - 500; y = int(i / 2) * 640 - 320; s = 2600 / (2600 + 0.5 * y)
    printf "%.3f,%.3f=%d,%d ", 640 + s * x, 360 + s * 0.866 * y, x, y } }')
"$PERCEIVE" --rectify "$CORNERS" --unit mm --json "$WORK/tilted.csv" >"$WORK/tilted.json" 2>"$WORK/tilted.err" ||
    wrong "--rectify: exit status $?"
[ ! -s "$WORK/tilted.err" ] || wrong "--rectify warns: $(cat "$WORK/tilted.err")"
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys
model = json.load(open(sys.argv[1]))
joint, = model["joints"]
assert (model["unit"], model["profile"], joint["type"]) == ("mm", "camera", "revolute")
assert abs(joint["x"] + 100) < 3 and abs(joint["y"] + 60) < 3, joint
assert abs(joint["upper"] - joint["lower"] - 80.2) < 1, joint' "$WORK/tilted.json" || wrong "--rectify: the joint"
fi
expect 0 'positions are beyond the horizon of the table' \
    --rectify '140,700=-500,320 1140,700=500,320 440,400=-500,-320 840,400=500,-320' --unit mm "$WORK/tilted.csv"
expect 1 'every point lies beyond the horizon' \
    --rectify '140,9700=-500,320 1140,9700=500,320 440,9400=-500,-320 840,9400=500,-320' "$WORK/tilted.csv"
expect 2 'must be four points, no three of them on a line' --rectify '0,0=0,0 1,1=1,0 2,2=1,1 0,9=0,1' a
expect 2 'must be four points of one plane seen from one side' --rectify '0,0=0,0 9,0=1,1 9,9=1,0 0,9=0,1' a
expect 2 'must be four pixels and their positions' --rectify '0,0=0,0 9,0=1,0 9,9=1,1' a
expect 2 'rectify is for a file of tracks in pixels' --rectify "$CORNERS" --log a
expect 2 'the unit is that of the table' --rectify "$CORNERS" --unit px a

# how the joints move: 40.1 and 30 in 60 frames
expect 0 '^D(lb, R(' --motion "$WORK/hinge_motion.csv" "$WORK/hinge.csv"
expect 0 '^D(lb, P(' --unit mm --motion "$WORK/slide_motion.csv" "$WORK/slide.csv"
expect 1 'No such file' --motion "$WORK/no/folder.csv" "$WORK/hinge.csv"
expect 2 'do not work with --handle' --motion a --handle b
for kind in hinge slide; do
    awk -F, -v kind=$kind 'function size(v) { return v < 0 ? -v : v }
        NR == 1 { header = $0; next }
        { truth = kind == "hinge" ? 40.107 * $1 / 60 : 30 * $1 / 60; n++
          off = size(size($5) - truth); worst = off > worst ? off : worst; unit = $6; frame = $1 }
        END { exit !(header == "frame,a,b,type,value,unit" && n == 61 && frame == 60 &&
                     worst < 0.5 && unit == (kind == "hinge" ? "degrees" : "mm")) }' \
        "$WORK/${kind}_motion.csv" || wrong "the motion of the $kind"
done

# more tracks than the library holds are told
awk 'BEGIN { print "frame,point,x,y"; for (f = 0; f < 3; f++) for (i = 0; i < 1100; i++)
    printf "%d,%d,%f,%f\n", f, i, i / 1000, f / 100 }' >"$WORK/many.csv"
expect 0 'warning: 1100 tracks, but this build holds .*left out' "$WORK/many.csv"
"$PERCEIVE" --json "$WORK/many.csv" >"$WORK/many.json" 2>/dev/null
{ head -1 "$WORK/many.csv"; tail -n +2 "$WORK/many.csv" | sort -r; } >"$WORK/many_reversed.csv"
"$PERCEIVE" --json "$WORK/many_reversed.csv" 2>/dev/null | cmp - "$WORK/many.json" ||
    wrong "what is left out depends on the order of the rows"
if command -v python3 >/dev/null; then
    python3 -c 'import json, sys
model = json.load(open(sys.argv[1]))
out = model["left_out"]
assert out["tracks"] == len(set(out["points"])) < 1100 and model["tracks"] == 1100, out
assert abs(out["percent"] - 100 * out["tracks"] / 1100) < 0.1, out
used = {i for body in model["bodies"] for i in body["features"]}
used |= set(model["background"]) | set(model["unassigned"])
assert used.isdisjoint(out["points"]) and len(used) + out["tracks"] == 1100
assert model["dropped"]["beyond_capacity"] == 3 * out["tracks"], model["dropped"]
assert len(model["warnings"]) == 2, model["warnings"] # and more than a third of all points' "$WORK/many.json" ||
        wrong "the JSON does not name the tracks left out"
fi
printf 'frame,point,x,y\n0,1,5000,0\n1,1,5000,0\n' >"$WORK/far.csv"
expect 1 'every point lies too far from the origin: pixels' "$WORK/far.csv"
printf 'frame,point,x,y\n0,1,,\n1,1,,\n' >"$WORK/nothing.csv"
expect 1 'no point is visible' "$WORK/nothing.csv"

# lost points: the same answer as when they are not written at all
awk -F, 'NR == 1 || ($1 - 100) / 3 % 5 != 2 || $2 < 20 || $2 > 40' "$WORK/hinge.csv" >"$WORK/gaps.csv"
awk -F, -v OFS=, 'NR > 1 && ($1 - 100) / 3 % 5 == 2 && $2 >= 20 && $2 <= 40 { $3 = $4 = 0 } 1' \
    "$WORK/hinge.csv" >"$WORK/zeros.csv"
awk -F, -v OFS=, 'NR > 1 && ($1 - 100) / 3 % 5 == 2 && $2 >= 20 && $2 <= 40 { $3 = $4 = "NaN" } 1' \
    "$WORK/hinge.csv" >"$WORK/nans.csv"
awk -F, -v OFS=, 'NR > 1 { k = $1; if ((k - 100) / 3 % 5 == 2 && $2 >= 20 + int((k - 100) / 15) && $2 <= 40) {
    $3 = y[k]; $4 = x[k] } y[k] = $3; x[k] = $4 } 1' "$WORK/hinge.csv" >"$WORK/frozen.csv"
"$PERCEIVE" "$WORK/gaps.csv" | sed '/^points dropped/d' >"$WORK/gaps"
for kind in zeros nans; do
    "$PERCEIVE" "$WORK/$kind.csv" 2>/dev/null | sed '/^points dropped/d' | cmp - "$WORK/gaps" ||
        wrong "$kind are taken for positions"
done
expect 0 'warning: 147 of 2196 positions are exactly (0, 0)' "$WORK/zeros.csv"
expect 0 '"marked": 147' --json "$WORK/zeros.csv"
expect 0 'warning: 147 of 2196 positions are empty or NaN' "$WORK/nans.csv"
expect 0 'positions repeat the previous one exactly' "$WORK/frozen.csv"

# units doubted
awk -F, -v OFS=, 'NR > 1 { $3 = 0.5 + $3 / 4; $4 = 0.5 + $4 / 4 } 1' "$WORK/hinge.csv" >"$WORK/norm.csv"
expect 0 'warning: all points lie within 0 to 1: normalised' "$WORK/norm.csv"
expect 0 'warning: all points lie within 0 to 1: normalised' --unit px "$WORK/norm.csv"
"$PERCEIVE" --unit m "$WORK/norm.csv" 2>&1 | grep -q normalised && wrong "--unit m is doubted"
awk -F, -v OFS=, 'NR > 1 { $3 *= 30; $4 *= 30 } 1' "$WORK/hinge.csv" >"$WORK/wide.csv"
expect 0 'm apart: pixels or millimetres' "$WORK/wide.csv"
printf 'frame,point,x,y\n0,1,0,0\n0,2,1,0\n0,3,2,0\n1,1,0,0\n1,2,1,0\n1,3,2,1\n' >"$WORK/three.csv"
expect 0 'warning: 3 tracks: a link needs at least 4 points' "$WORK/three.csv"

# more noise than assumed is told, unless the user set or measured it
awk -F, -v OFS=, 'BEGIN { srand(6) } NR > 1 { $3 += 0.006 * (rand() - 0.5); $4 += 0.006 * (rand() - 0.5) } 1' \
    "$WORK/hinge.csv" >"$WORK/noisy.csv"
expect 0 'warning: the points scatter by 0.001[5-9] m from frame to frame, but 0.0007 is assumed' "$WORK/noisy.csv"
for quiet in "$WORK/hinge.csv" "--noise auto $WORK/noisy.csv" "--noise 0.001 $WORK/noisy.csv"; do
    # shellcheck disable=SC2086
    "$PERCEIVE" $quiet 2>&1 | grep -q 'scatter by' && wrong "the noise is doubted: $quiet"
done

# a noise that cannot be measured
printf 'frame,point,x,y\n0,1,0,0\n1,1,0,0\n2,1,1,0\n' >"$WORK/short.csv"
expect 1 'auto: too few points' --noise auto "$WORK/short.csv"
awk 'BEGIN { print "frame,point,x,y"; for (f = 0; f < 9; f++) for (i = 0; i < 20; i++)
    printf "%d,%d,%d,%d\n", f, i, i, f }' >"$WORK/rounded.csv"
expect 1 'auto: the points do not scatter' --noise auto "$WORK/rounded.csv"

# a handle
awk 'BEGIN { for (i = 0; i < 80; i++) print 0.4 * cos(i / 50), 0.4 * sin(i / 50), 1.0 }' >"$WORK/door"
awk 'BEGIN { for (i = 0; i < 80; i++) print 20 * i, 12 * i }' >"$WORK/drawer"
expect 0 '^revolute 0.99' --handle "$WORK/door"
expect 0 '"radius": 0.4' --handle "$WORK/door" --json
expect 0 '^prismatic [01]' --handle "$WORK/drawer" --unit mm
expect 1 'is the unit right' --handle "$WORK/drawer" --unit m
expect 0 '"type": "prismatic"' --handle "$WORK/drawer" --unit mm --json
awk 'BEGIN { for (i = 0; i < 80; i++) print i / 200, 0.06 * sin(i / 12) }' >"$WORK/wave"
expect 0 '^neither 0.99' --handle "$WORK/wave"
awk 'BEGIN { for (i = 0; i < 80; i++) print 0.4, 0.3 }' >"$WORK/still"
expect 0 '^rigid 1.000' --handle "$WORK/still"
expect 0 '"p_rigid": 1,' --handle "$WORK/still" --json
awk 'BEGIN { for (i = 0; i < 80; i++) print 0.5 * cos(i / 600), 0.5 * sin(i / 600) }' >"$WORK/ajar"
expect 0 '^undetermined 0' --handle "$WORK/ajar"

awk '{ print $1, $2, $3, 0, 0, 0, 1 }' "$WORK/door" >"$WORK/poses"
"$PERCEIVE" --handle "$WORK/poses" | cmp - <("$PERCEIVE" --handle "$WORK/door") || wrong "the poses"

# what is wrong, and where
printf 'frame,point,x,y\n0,1,2,oops\n' >"$WORK/bad.csv"
expect 1 'bad.csv:2:7: oops: a position is a finite number' "$WORK/bad.csv"
expect 1 'No such file' "$WORK/missing.csv"
expect 1 'No such file' --log "$WORK/missing.lcm"
expect 1 'no messages on GRRL_POINTS; an LCM log with' --log "$WORK/hinge.csv"
expect 1 'columns x_px and y_px, or give --unit px' --profile camera "$WORK/hinge.csv"
expect 2 'no input'
expect 2 'one input only' --handle a b
expect 2 'one file of tracks only' a b
expect 2 '--unit inch: must be m, mm or px' --unit inch a
expect 2 '--profile lidar: must be tracker or camera' --profile lidar a
expect 2 '--noise 0: must be a number above 0, or auto' --noise 0 a
expect 2 '--noise automatic: must be' --noise automatic a
expect 2 'noise auto does not work with --handle' --noise auto --handle a
expect 2 '--trial needs --log' --trial 2 a
expect 2 'camera is for positions in pixels' --profile camera --unit mm a
expect 2 'Try grrl-perceive --help' --nonsense
finish
