# shellcheck shell=bash
# Sourced by tests of a program's command line. PROGRAM, an array, is what `expect` runs.
export LC_ALL=C
WORK=$(mktemp -d)
trap 'rm -rf "$WORK"' EXIT
FAILURES=0

wrong() {
    echo "FAILED: $*"
    FAILURES=$((FAILURES + 1))
}

# expect STATUS PATTERN ARGUMENT..: exit status, and a basic regular expression that the output has
expect() {
    local status=$1 pattern=$2 output actual
    shift 2
    output=$("${PROGRAM[@]}" "$@" 2>&1)
    actual=$?
    [ "$actual" -eq "$status" ] || wrong "$*: exit status $actual instead of $status: $output"
    printf '%s\n' "$output" | grep -q -e "$pattern" || wrong "$*: no '$pattern' in: $output"
}
