#!/bin/bash
# Wrong options end with 2 and a message, what is no store with 1 and stays as it is; a damaged store
# is set aside.
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7728?ttl=0'

# refused STATUS COMMAND..
refused() {
    local expected=$1
    shift
    timeout 20 "$@" >out.txt 2>err.txt
    local status=$?
    [ "$status" = "$expected" ] || fail "$* ended with $status, not $expected"
    [ -s err.txt ] || fail "$* gave no message"
}

refused 2 "$AGENT" --polcy learn
refused 2 "$AGENT" --policy lern
refused 2 "$AGENT" --alpha 0.2
grep -q -e '--alpha needs --policy paper' err.txt || fail "--alpha 0.2: $(cat err.txt)"
refused 2 "$AGENT" --policy random --store random.store
grep -q 'the policy random does not learn' err.txt || fail "random: $(cat err.txt)"
refused 2 "$AGENT" --policy paper --alpha 0
refused 2 "$AGENT" --policy paper --alpha 0.5x
refused 2 "$AGENT" --policy paper --alpha 2
grep -q -e '--alpha 2: must be a number above 0 to 1' err.txt || fail "--alpha 2: $(cat err.txt)"
refused 2 "$AGENT" --policy paper --gamma 1
refused 2 "$AGENT" --policy paper --z 1001
refused 2 "$AGENT" --policy paper --beta nan
refused 2 "$AGENT" --noise 0
refused 2 "$AGENT" --noise 1e-60
refused 2 "$AGENT" --seed -1
refused 2 "$AGENT" --experiences 0
refused 2 "$AGENT" --experiences 7000000
refused 2 "$AGENT" --store
refused 2 "$AGENT" --quiet --explain
refused 2 "$AGENT" --tracker-timeout 0
refused 2 "$AGENT" --tracker-timeout soon
refused 2 "$AGENT" --table 0,0,1
refused 2 "$AGENT" --table 0,0,1,1,2
refused 2 "$AGENT" --table 0,0,0,1
refused 2 "$AGENT" --table 0,0,nan,1
grep -q 'X0,Y0,X1,Y1 in metres, X0 below X1' err.txt || fail "--table: $(cat err.txt)"
refused 2 "$AGENT" --force 0
refused 2 "$AGENT" --force 101
refused 2 "$AGENT" --speed 0.6
refused 2 "$AGENT" --travel 0.03
refused 2 "$AGENT" --until-sure 1
refused 2 "$AGENT" --pushes 0
refused 2 "$AGENT" --observe --pushes 3
grep -q -e '--observe pushes nothing' err.txt || fail "--observe --pushes: $(cat err.txt)"
refused 2 "$AGENT" extra
refused 2 "$SIM"
refused 2 "$SIM" --object RR --object RRR
grep -q -e '--object: given twice' err.txt || fail "--object twice: $(cat err.txt)"
refused 2 "$SIM" --object RXR
refused 2 "$SIM" --object 'R(l1, l1)'
refused 2 "$SIM" --object RR --trials 0
refused 2 "$SIM" --object RR --trials 1e3
refused 2 "$SIM" --object RR --dropout 1.5
refused 2 "$SIM" --object RR --noise -1
refused 2 "$SIM" --object RR --agent-timeout 0
refused 1 "$SIM" --object RR --lcm-url "$URL" --agent-timeout 0.3
refused 1 "$SIM" --object RR --lcm-url "$URL" --results no/such/folder/r.csv
refused 1 "$SIM" --object RR --lcm-url "$URL" --log no/such/folder/run.lcm
refused 1 "$AGENT" --lcm-url "$URL" --store no/such/folder/a.store
refused 2 "$AGENT" --start mixed # of nothing
refused 1 "$AGENT" --lcm-url "$URL" --store started.store --start no/such/a.store
[ ! -e started.store ] || fail "a store without the one it should start with"
refused 1 "$AGENT" --lcm-url "$URL" --store started.store --start mixed --policy paper # learn's
timeout 20 "$AGENT" --lcm-url "$URL" --store started.store --start mixed --tracker-timeout 0.3 >out.txt 2>err.txt
grep -q 'started.store is new: it starts with [0-9]* cases of .*/mixed.store' out.txt || fail "--start: $(cat out.txt)"
cp started.store before.store
timeout 20 "$AGENT" --lcm-url "$URL" --store started.store --start no/such/a.store --tracker-timeout 0.3 >out.txt 2>err.txt
same before.store started.store # it was there: --start has no effect
refused 1 "$AGENT" --lcm-url bogus
refused 1 "$AGENT" --lcm-url 'file://missing.lcm'

for program in "$AGENT" "$SIM"; do
    "$program" --help | grep -q -- '--lcm-url' || fail "$program --help"
    "$program" --version | grep -q '[0-9]' || fail "$program --version"
done

"$HELPERS/memq_run" RR 3 1 good.store >memq.txt 2>&1 || fail "memq_run ended with $?"
# kept FILE: another program's file, or of another version: refused and left alone
kept() {
    cp "$1" before.store
    refused 1 "$AGENT" --lcm-url "$URL" --store "$1"
    same before.store "$1"
}
# set_aside FILE: a damaged store is kept under another name, and the agent starts
set_aside() {
    cp "$1" before.store
    timeout 20 "$AGENT" --lcm-url "$URL" --store "$1" --tracker-timeout 0.3 --quiet >out.txt 2>err.txt
    grep -q "it is now $1.damaged" err.txt || fail "no word of $1.damaged"
    same before.store "$1.damaged"
    timeout 20 "$AGENT" --lcm-url "$URL" --store "$1" --tracker-timeout 0.3 --quiet >out.txt 2>err.txt
    grep -q damaged err.txt && fail "$1 is damaged again"
}
head -c 20 good.store >short.store
set_aside short.store
head -c -7 good.store >torn.store
set_aside torn.store
cp before.store torn.store # a second time: the first one stays
timeout 20 "$AGENT" --lcm-url "$URL" --store torn.store --tracker-timeout 0.3 >out.txt 2>err.txt
grep -q 'at least 1 are lost; it is now torn.store.damaged.2' err.txt || fail "no torn.store.damaged.2"
same before.store torn.store.damaged.2
cp good.store flipped.store
printf '\377' | dd of=flipped.store bs=1 seek=$(($(stat -c %s good.store) / 2)) conv=notrunc 2>/dev/null
cmp -s good.store flipped.store && printf '\000' |
    dd of=flipped.store bs=1 seek=$(($(stat -c %s good.store) / 2)) conv=notrunc 2>/dev/null
set_aside flipped.store
cat good.store good.store >long.store
set_aside long.store
: >empty.store
set_aside empty.store
echo "not a store at all, but a letter" >letter.store
kept letter.store
refused 1 "$AGENT" --lcm-url "$URL" --store good.store --experiences 1
refused 1 "$AGENT" --lcm-url "$URL" --store good.store --policy paper # learn's
grep -q 'it belongs to another policy' err.txt || fail "another policy: $(cat err.txt)"

# A signal is a clean end.
start agent "$AGENT" --lcm-url "$URL" --store good.store
sleep 0.5
kill -TERM "$LAST"
finish "$LAST" "the agent after SIGTERM"
