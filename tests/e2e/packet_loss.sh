#!/bin/bash
# The kernel drops a tenth of all packets, in a network namespace made for it: the learning curve
# and the experiences are those of a network that drops none, bit for bit.
export PATH=$PATH:/usr/sbin:/sbin
if [ -z "${GRRL_E2E_LOSSY:-}" ]; then
    export GRRL_E2E_LOSSY=1 GRRL_E2E_NETWORK=1
    setup='ip link set lo up && ip route add 224.0.0.0/4 dev lo &&
        iptables-legacy -A INPUT -p udp -m statistic --mode random --probability 0.1 -j DROP'
    if ! command -v iptables-legacy >/dev/null || ! unshare -rn sh -c "$setup" 2>/dev/null; then
        echo "skipped: no iptables-legacy (package iptables), or no leave to make a namespace"
        exit 77
    fi
    exec unshare -rn sh -c "$setup && exec bash \"\$0\" \"\$@\"" "$0" "$@"
fi
. "$(dirname "$0")/common.sh"
URL='udpm://239.255.76.67:7736?ttl=0'

"$HELPERS/memq_run" RPR 4 9 clean.store >memq.txt 2>&1 || fail "memq_run ended with $?"
start agent timeout 120 "$AGENT" --lcm-url "$URL" --seed 9 --store lossy.store
agent=$LAST
start sim timeout 120 "$SIM" --lcm-url "$URL" --object RPR --trials 4 --seed 9 --results r.csv
finish "$LAST" grrl-sim
finish "$agent" grrl-agent
iptables-legacy -L INPUT -v -x -n | tail -1
iptables-legacy -L INPUT -v -x -n | tail -1 | grep -q '^ *[1-9]' || fail "no packet was dropped"
same clean.store lossy.store
[ "$(wc -l <r.csv)" = 5 ] || fail "r.csv does not hold a line for each trial"
grep -q aborted r.csv && fail "a trial was aborted"
exit 0
