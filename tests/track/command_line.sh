#!/bin/bash
# command_line.sh TRACK PERCEIVE VIDEO VERSION SOURCE: what grrl-track says and does with good and bad input.
set -u
TRACK=$1 PERCEIVE=$2 VIDEO=$3 VERSION=$4 SOURCE=$5
export LC_ALL=C
WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
cd "$WORK" || exit 1

fail() {
    echo "FAILED: $*"
    [ ! -f err ] || cat err
    exit 1
}

# refuses STATUS TEXT ARGUMENT..: ends with the status, and says the text
refuses() {
    local status=$1 text=$2
    shift 2
    "$TRACK" "$@" >out 2>err </dev/null
    local got=$?
    [ $got = "$status" ] || fail "grrl-track $* ended with $got, not $status"
    grep -qF -- "$text" err || fail "grrl-track $* does not say: $text"
}

[ "$("$TRACK" --version)" = "grrl-track $VERSION" ] || fail "--version"
"$TRACK" --help | grep -q -- --calibrate || fail "--help does not name --calibrate"
refuses 2 "no input"
refuses 2 "one input only" --camera 1 film.avi
refuses 2 "must be a number from 0.01 to 100" --scale 0 film.avi
refuses 2 "must be PX,PY=X,Y" --points "1,2 3,4" film.avi
refuses 2 "must be at least four points, not 2" --points "1,2=0,0 3,4=1,1" film.avi
refuses 2 "only one of --scale, --points and --calibration" --scale 1 --calibration x film.avi
refuses 2 "points on LCM are in metres" --lcm
refuses 2 "as in 9x6x25" --calibrate 9x6 film.avi
refuses 1 "there is no camera 97" --camera 97
refuses 1 "film.avi: No such file" film.avi
mkdir folder
refuses 1 "there are no images in this folder" folder
echo "this is text" >text.avi
refuses 1 "codec to decode it is missing" text.avi
cp text.avi folder/1.png
refuses 1 "not a readable image" folder
refuses 1 "not a calibration" --calibration text.avi "$SOURCE/examples/arm.mp4"
refuses 1 "no checkerboard with 9 x 6" --calibrate 9x6x25 --calibration c "$SOURCE/examples/arm.mp4"
refuses 1 "cannot write a video there" --draw none/x.avi "$SOURCE/examples/arm.mp4"

# Tracks of a film of ours, drawn: the film is as long as it was, and the points are those again.
"$VIDEO" RR 1 1 film.avi >/dev/null || fail "track_video"
"$TRACK" --scale 1.56 --csv a.csv --draw drawn.avi film.avi 2>err || fail "film.avi"
"$TRACK" --scale 1.56 --csv - film.avi >b.csv 2>err || fail "film.avi to standard output"
cmp a.csv b.csv || fail "two runs differ"
[ "$(head -n 1 a.csv)" = frame,point,x,y,visible ] || fail "the header"
"$TRACK" --csv c.csv drawn.avi 2>err || fail "what was drawn cannot be read"
[ "$(head -n 1 c.csv)" = frame,point,x_px,y_px,visible ] || fail "the header in pixels"
[ "$(tail -n 1 a.csv | cut -d, -f1)" = "$(tail -n 1 c.csv | cut -d, -f1)" ] ||
    fail "the drawn film is not as long"
"$TRACK" --frames 3 --draw pictures film.avi 2>err || fail "a folder of pictures"
[ "$(ls pictures | wc -l)" = 3 ] || fail "not three pictures"
"$TRACK" --csv d.csv pictures 2>err || fail "the folder cannot be read"
if [ -w /dev/full ]; then
    refuses 1 "No space left" --csv /dev/full film.avi
fi

# The sample: a structure that grrl-perceive finds.
"$TRACK" --scale 1.56 --quiet "$SOURCE/examples/arm.mp4" 2>err | "$PERCEIVE" - >belief.txt ||
    fail "grrl-perceive ended with $?"
grep -qx 'bodies 4' belief.txt && grep -qx 'joints 3' belief.txt &&
    [ "$(grep -c '^  f[0-9]* f[0-9]* revolute' belief.txt)" = 2 ] &&
    [ "$(grep -c '^  f[0-9]* f[0-9]* prismatic' belief.txt)" = 1 ] &&
    grep -q '^D(lb, R(R(L(., f[0-9]*), P(L(., f[0-9]*), L(., f[0-9]*))), L(., f[0-9]*)))$' belief.txt ||
    fail "another structure: $(head -n 1 belief.txt)"
