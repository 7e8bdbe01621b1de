#!/bin/bash
# experiment.sh GRRL-EXPERIMENT CASE: the program as it is called. Exit status 77: skipped.
set -u
BIN=$1 CASE=$2
export LC_ALL=C

if [ "$CASE" = transports ] && [ -z "${GRRL_E2E_NETWORK:-}" ]; then
    export GRRL_E2E_NETWORK=1
    setup='ip link set lo up && ip route add 224.0.0.0/4 dev lo'
    if unshare -rn sh -c "$setup" 2>/dev/null; then
        exec unshare -rn sh -c "$setup && exec bash \"\$0\" \"\$@\"" "$0" "$@"
    elif ! ip route get 239.255.76.67 2>/dev/null | grep -q 'dev lo'; then
        echo "skipped: no multicast route on lo, and no leave to make a network namespace"
        exit 77
    fi
fi

WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
cd "$WORK" || exit 1

fail() {
    echo "FAILED: $*"
    cat output.txt
    exit 1
}

# run DIR OPTION..: must end with 0
run() {
    local out=$1
    shift
    "$BIN" --out "$out" "$@" >output.txt 2>&1 || fail "--out $out $* ended with $?"
}

# same DIR DIR: both tables
same() {
    cmp "$1/trials.csv" "$2/trials.csv" || fail "trials of $1 and $2 differ"
    cmp "$1/summary.csv" "$2/summary.csv" || fail "summaries of $1 and $2 differ"
}

# refused PATTERN OPTION..: exit status 2 and a message
refused() {
    local pattern=$1 status=0
    shift
    "$BIN" "$@" >output.txt 2>&1 || status=$?
    [ "$status" -eq 2 ] || fail "$* ended with $status"
    grep -q -e "$pattern" output.txt || fail "$*: no '$pattern'"
}

case $CASE in
jobs)
    options=(--object RR --policy "random,learn,rule,motion,clairvoyant" --trials 2 --experiments 3)
    run one "${options[@]}" --jobs 1
    run two "${options[@]}" --jobs 2
    same one two
    [ "$(wc -l <one/trials.csv)" -eq 31 ] || fail "not 30 trials and a header"
    head -1 one/trials.csv | grep -qx \
        'object,policy,pretrain,experiment,seed,trial,pushes,outcome,wrong_joints' || fail header
    grep -qx 'RR,rule,none,2,1002,1,[0-9]*,discovered,[0-9]*' one/trials.csv || fail row
    grep -q '^RR,learn,none,1-2,1,2,3,' one/summary.csv || fail summary
    grep -q '<table>' one/report.html || fail report
    run other "${options[@]}" --seed 2
    ! cmp -s one/trials.csv other/trials.csv || fail "another seed changed nothing"
    ;;
figure)
    run figure --figure 4b --policy paper,random --trials 3 --experiments 2
    grep -q '^RRRR,paper,RRRRR:50,2,1002,3,' figure/trials.csv || fail "no pretrained curve"
    [ "$(wc -l <figure/trials.csv)" -eq 19 ] || fail "not 3 curves of 2 x 3 trials"
    if command -v gnuplot >/dev/null; then
        grep -q '<svg' figure/figure-4b.svg || fail "no SVG"
        [ "$(head -c 4 figure/figure-4b.png | tail -c 3)" = PNG ] || fail "no PNG"
        grep -q 'data:image/svg+xml;base64,' figure/report.html || fail "no picture in the report"
    fi
    run matrix --figure interference --object RR --object PR --policy learn --trials 2 --experiments 2
    [ "$(wc -l <matrix/trials.csv)" -eq 61 ] || fail "not 2 x 3 curves of 2 x 5 trials"
    grep -q '^PR,learn,RR:2,2,1002,5,' matrix/trials.csv || fail "no cell"
    grep -qE '^  RR +-?[0-9.]+[*]? +-?[0-9.]+[*]? *$' output.txt || fail "no row of the matrix"
    run ablations --figure ablations --policy learn,paper-exact --trials 2 --experiments 2
    grep -q '^RPRPRPR,paper-exact,none,2,1002,2,' ablations/trials.csv || fail "no ablation"
    grep -q 'recalls only the same structure' ablations/report.html || fail "no explanation"
    [ ! -e ablations/ablations.svg ] || grep -q '<svg' ablations/ablations.svg || fail "no SVG"
    ;;
transports)
    options=(--object PR --policy "random,learn,rule" --pretrain R:1 --trials 2 --experiments 2)
    run memq "${options[@]}" --transport memq
    run udpm "${options[@]}" --transport udpm
    same memq udpm
    ;;
killed)
    few=(--object RPR --policy "random,learn" --trials 3)
    options=("${few[@]}" --experiments 6)
    run whole "${options[@]}"
    for how in KILL TERM; do
        rm -rf parts
        "$BIN" --out parts "${options[@]}" --jobs 1 >output.txt 2>&1 &
        pid=$!
        for ((i = 0; i < 600; i++)); do
            compgen -G 'parts/experiments/random-*-1001.csv' >/dev/null && break
            sleep 0.01
        done
        kill -$how "$pid"
        status=0
        wait "$pid" 2>/dev/null || status=$?
        [ "$how" = KILL ] || [ "$status" -eq 130 ] || fail "SIGTERM: exit status $status"
        [ ! -e parts/trials.csv ] || fail "it ended before it was killed"
        run parts "${options[@]}"
        grep -q 'of 12 experiments are already done' output.txt || fail "nothing was kept"
        same whole parts
    done
    echo rubbish >"$(echo parts/experiments/learn-*-1003.csv)" # a broken one is done again
    run parts "${options[@]}"
    grep -q '11 of 12 experiments are already done' output.txt || fail "rubbish was believed"
    same whole parts
    run parts "${few[@]}" --experiments 2 # fewer are part of the same
    grep -q '4 of 4 experiments are already done' output.txt || fail "repeated"
    status=0
    "$BIN" --out parts "${options[@]}" --cap 9 >output.txt 2>&1 || status=$?
    [ "$status" -eq 1 ] || fail "other settings: exit status $status"
    grep -q "'cap 100' there, 'cap 9' here" output.txt || fail "other settings: no message"
    ;;
added) # what one command does, others may do after one another
    few=(--trials 2 --experiments 2)
    run whole --object RR --object PR --policy "random,learn" --seed 3..4 "${few[@]}"
    [ "$(wc -l <whole/trials.csv)" -eq 33 ] || fail "not 2 objects, 2 policies, 2 seeds, 2 x 2"
    grep -q '^PR,learn,none,4,4002,2,' whole/trials.csv || fail "no fourth experiment"
    run parts --object RR --policy random --seed 3 "${few[@]}"
    run parts --object RR --object PR --policy "random,learn" --seed 3..4 "${few[@]}"
    grep -q '2 of 16 experiments are already done' output.txt || fail "nothing was kept"
    same whole parts
    run two --object RR --pretrain R:2 --pretrain P:1 "${few[@]}"
    run one --object RR --pretrain R:2 "${few[@]}"
    grep -q '^RR,learn,"R:2, P:1",2,1002,2,' two/trials.csv || fail "they do not add up"
    ! cmp -s <(grep 'R:2' two/trials.csv | cut -d, -f4-) <(grep 'R:2' one/trials.csv | cut -d, -f3-) ||
        fail "the second one changes nothing"
    ;;
start) # learners start with a store
    few=(--object PR --policy "random,learn" --trials 2 --experiments 2)
    run empty "${few[@]}"
    run mixed "${few[@]}" --start mixed --pretrain RR:1
    grep -q '^PR,learn,mixed,2,1002,2,' mixed/trials.csv || fail "no curve from the store"
    grep -q '^PR,learn,"mixed, RR:1",2,1002,2,' mixed/trials.csv || fail "no pretraining after it"
    cmp <(grep random empty/trials.csv) <(grep random mixed/trials.csv) || fail "random differs"
    ! cmp -s <(grep learn empty/trials.csv | cut -d, -f4-) \
        <(grep 'learn,mixed,' mixed/trials.csv | cut -d, -f4-) || fail "the store changes nothing"
    store=$(echo empty/experiments/learn-*-1001.store)
    run own "${few[@]}" --start "$store"
    cp -r own same
    run same "${few[@]}" --start "$store"
    grep -q '4 of 4 experiments are already done' output.txt || fail "the same store is not known"
    run same "${few[@]}" --start "$(echo empty/experiments/learn-*-1002.store)"
    grep -q '2 of 4 experiments are already done' output.txt || fail "another store is not told apart"
    refused 'paper cannot start with .*mixed.store: a file from another policy' \
        --object PR --out x --start mixed --policy learn,paper
    refused '--start: no.store cannot be read' --object PR --out x --start no.store
    refused '--start : must be a store' --object PR --out x --start ''
    refused '--start: none of the policies learns' --object PR --out x --start mixed --policy random
    run none --object PR --policy "random,rules,learn" --trials 1 --experiments 2 --start mixed
    [ ! -e none/claims.txt ] || fail "robots with a store are compared as if they had none"
    cat "$store" "$store" >long.store
    refused 'cannot start with long.store: not a file of this kind' \
        --object PR --out x --start long.store
    head -c 200 "$store" >torn.store
    refused 'cannot start with torn.store: it ends early' \
        --object PR --out x --start torn.store
    [ ! -e x ] || fail "a folder was made all the same"
    ;;
worlds)
    options=(--policy "random,rules,learn" --trials 2 --experiments 2)
    run one --object RR --world default --world features=0.7,noise=1 --world size=0.5 "${options[@]}"
    grep -q '^"RR in features=0.7,noise=1",rule-spa,none,2,1002,2,' one/trials.csv || fail "no world"
    grep -q '^RR in size=0.5 .* \(yes\|NO\|unclear\)' <(sed 's/^ *//' one/claims.txt) || fail "no claim"
    [ "$(grep -c '^  every rule ' output.txt)" -eq 3 ] || fail "no line for every rule"
    run default --object RR "${options[@]}"
    cmp <(grep '^RR,' one/trials.csv) <(tail -n +2 default/trials.csv) || fail "no default world"
    ! cmp -s <(grep 'size' one/trials.csv | cut -d, -f2-) <(tail -n +2 default/trials.csv | cut -d, -f2-) ||
        fail "another world changes nothing"
    ;;
stream)
    printf '%s\n' 'links 2..4 # few' 'revolute 0, 1' 'objects 1, 2' 'size 0.8..1.2' >some.stream
    options=(--stream some.stream --policy "learn,rule,clairvoyant" --trials 4 --experiments 2)
    run one "${options[@]}" --jobs 1
    run two "${options[@]}" --jobs 2
    same one two
    cmp one/objects.csv two/objects.csv || fail "objects differ"
    [ "$(cut -d, -f6- one/objects.csv | sort -u | wc -l)" -gt 3 ] || fail "hardly any objects"
    "$BIN" "${options[@]}" --out one >output.txt 2>&1
    grep -q 'some.stream: above the clairvoyant' output.txt || fail "no distance from the bound"
    run after --stream some.stream:3 --then PR --trials 2 --experiments 2
    run pretrained --object PR --pretrain some.stream:3 --trials 2 --experiments 2
    same after pretrained
    grep -q '^PR,learn,some.stream:3,2,1002,2,' after/trials.csv || fail "no curve after the stream"
    cp some.stream before.stream
    echo 'links 2' >some.stream # another stream of this name has results of its own
    run one "${options[@]}"
    ! cmp -s one/trials.csv two/trials.csv || fail "results of the old stream"
    ;;
options)
    refused 'give either --figure or --object' --out x
    refused 'give either --figure or --object' --out x --object RR --figure 3b
    refused '--out is required' --object RR
    refused '--policy nobody: must be one or more' --object RR --out x --policy nobody
    refused 'without repetition' --object RR --out x --policy rule,rule
    refused '--policy : must be' --object RR --out x --policy ''
    refused '--trials 0: must be a whole number from 1' --object RR --out x --trials 0
    refused '--jobs -1: must be' --object RR --out x --jobs -1
    refused '--figure 5: must be 3b, 4a, 4b, 4c, all, ablations or interference' --figure 5 --out x
    refused '--pretrain RR: must be an object, a colon' --object RR --out x --pretrain RR
    refused '--pretrain requires --object' --figure 4a --out x --pretrain RR:2
    refused '--noise nan: must be' --object RR --out x --noise nan
    refused '--transport tcp: must be memq or udpm' --object RR --out x --transport tcp
    refused 'needs the simulator in the same process' --object RR --out x --transport udpm \
        --policy clairvoyant
    refused 'XY: ' --object XY --out x
    refused 'NO: ' --object RR --pretrain NO:2 --out x
    refused 'there are no arguments' --object RR --out x more
    refused '--object: the same one twice' --object RR --object RR --out x
    refused '--world sun=1: must be default, grid or' --object RR --out x --world sun=1
    refused '--world links=9: must be a number from 0.3 to 2 for links' --object RR --out x \
        --world links=9
    refused '--world: the same one twice' --object RR --out x --world grid --world links=0.7
    refused '--world requires --object' --figure 3b --out x --world links=0.7
    refused 'scissors: .* cannot follow links of another length' --object scissors --out x \
        --world links=0.7
    refused '--seed 3..2: must be' --object RR --out x --seed 3..2
    refused '--seed 1..: must be' --object RR --out x --seed 1..
    refused '--stream mixed: must be a file' --stream mixed --out x
    refused 'no.stream: cannot be read' --stream no.stream --out x
    echo 'links 1' >bad.stream
    refused "bad.stream:1:7: '1' must be a whole number" --stream bad.stream --out x
    refused 'Try grrl-experiment --help' --unknown
    [ ! -e x ] || fail "a folder was made all the same"
    "$BIN" --help | grep -q 'clairvoyant  knows the truth' || fail "--help"
    "$BIN" --version | grep -q '^grrl-experiment [0-9]' || fail "--version"
    status=0
    "$BIN" --object RR --out /dev/null/x >output.txt 2>&1 || status=$?
    [ "$status" -eq 1 ] || fail "a folder that cannot be: exit status $status"
    ;;
*)
    fail "no such case"
    ;;
esac
