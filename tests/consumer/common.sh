# shellcheck shell=sh
# Sourced by the tests of other people's builds: a folder of the test, quiet commands.
here=$(cd "$(dirname "$0")" && pwd)
# shellcheck disable=SC2034 # used by those who source this
source=$(cd "$here/../.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

wrong() {
    echo "$*"
    exit 1
}

# quiet COMMAND..: what it writes is shown if it fails
quiet() {
    "$@" >"$work/log" 2>&1 || {
        cat "$work/log"
        wrong "failed: $*"
    }
}

# expect_links N PROGRAM: it must say so
expect_links() {
    output=$("$2") || wrong "$2: exit status $?"
    [ "$output" = "$1 links" ] || wrong "$2: expected '$1 links', found '$output'"
}

# skip WHAT: ctest counts the test as skipped
skip() {
    echo "skipped: $*"
    exit 77
}
