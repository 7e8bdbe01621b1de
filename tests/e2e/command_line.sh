#!/bin/bash
# Wrong options end with 2 and a message, damaged stores with 1 and stay as they are.
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
refused 2 "$AGENT" --alpha 0
refused 2 "$AGENT" --alpha 0.5x
refused 2 "$AGENT" --gamma 1
refused 2 "$AGENT" --beta nan
refused 2 "$AGENT" --noise 0
refused 2 "$AGENT" --seed -1
refused 2 "$AGENT" --experiences 0
refused 2 "$AGENT" --experiences 7000000
refused 2 "$AGENT" --store
refused 2 "$AGENT" --quiet --explain
refused 2 "$AGENT" extra
refused 2 "$SIM"
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
refused 1 "$AGENT" --lcm-url bogus
refused 1 "$AGENT" --lcm-url 'file://missing.lcm'

for program in "$AGENT" "$SIM"; do
    "$program" --help | grep -q -- '--lcm-url' || fail "$program --help"
    "$program" --version | grep -q '[0-9]' || fail "$program --version"
done

"$HELPERS/memq_run" RR 3 1 good.store >memq.txt 2>&1 || fail "memq_run ended with $?"
damaged() {
    cp "$1" before.store
    refused 1 "$AGENT" --lcm-url "$URL" --store "$1"
    same before.store "$1"
}
head -c 20 good.store >short.store
damaged short.store
cp good.store flipped.store
printf '\377' | dd of=flipped.store bs=1 seek=$(($(stat -c %s good.store) / 2)) conv=notrunc 2>/dev/null
cmp -s good.store flipped.store && printf '\000' |
    dd of=flipped.store bs=1 seek=$(($(stat -c %s good.store) / 2)) conv=notrunc 2>/dev/null
damaged flipped.store
echo "not a store at all, but a letter" >letter.store
damaged letter.store
cat good.store good.store >long.store
damaged long.store
: >empty.store
damaged empty.store
refused 1 "$AGENT" --lcm-url "$URL" --store good.store --experiences 1

# A signal is a clean end.
start agent "$AGENT" --lcm-url "$URL" --store good.store
sleep 0.5
kill -TERM "$LAST"
finish "$LAST" "the agent after SIGTERM"
