#!/bin/bash
# A real-time run recorded by lcm-logger and played by lcm-logplayer teaches an observer the same.
. "$(dirname "$0")/common.sh"
command -v lcm-logger >/dev/null && command -v lcm-logplayer >/dev/null || {
    echo "skipped: lcm-logger and lcm-logplayer are not installed"
    exit 77
}
URL='udpm://239.255.76.67:7723?ttl=0'
start logger lcm-logger --lcm-url="$URL" -f run.lcm
logger=$LAST
sleep 1
start agent timeout 100 "$AGENT" --lcm-url "$URL" --store live.store
agent=$LAST
start sim timeout 100 "$SIM" --lcm-url "$URL" --object RR --real-time --cap 4
finish "$LAST" grrl-sim
finish "$agent" grrl-agent
sleep 0.5
kill -INT "$logger" && wait "$logger"
start observer timeout 60 "$AGENT" --observe --lcm-url 'udpm://239.255.76.67:7724?ttl=0' --store log.store
observer=$LAST
sleep 0.5
lcm-logplayer --lcm-url='udpm://239.255.76.67:7724?ttl=0' --speed=4 run.lcm >player.txt 2>&1 ||
    fail "lcm-logplayer ended with $?"
finish "$observer" "the observer"
same live.store log.store
