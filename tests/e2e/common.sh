# Sourced by every end-to-end test, which ctest calls as: test.sh BIN_AGENT BIN_SIM BIN_HELPERS BIN_PERCEIVE
# Where there is no multicast on lo, the test runs in a network namespace of its own; where that is
# not allowed either, it is skipped (77).
set -u
AGENT=$1 SIM=$2 HELPERS=$3 PERCEIVE=$4
export LC_ALL=C

if [ -z "${GRRL_E2E_NETWORK:-}" ]; then
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
PIDS=()
cleanup() {
    for pid in "${PIDS[@]}"; do kill -9 "$pid" 2>/dev/null; done
    rm -rf "$WORK"
}
trap cleanup EXIT
cd "$WORK" || exit 1

# start NAME COMMAND..: in the background, output in NAME.txt, process id in LAST
start() {
    local name=$1
    shift
    "$@" >"$name.txt" 2>&1 &
    LAST=$!
    PIDS+=("$LAST")
}

fail() {
    echo "FAILED: $*"
    for file in *.txt; do
        echo "--- $file"
        tail -20 "$file"
    done
    exit 1
}

# finish PID WHAT: it must end with 0
finish() {
    wait "$1" || fail "$2 ended with $?"
}

same() {
    cmp "$1" "$2" || fail "$1 and $2 differ"
}
