# shellcheck shell=bash disable=SC2034
# Sourced by the tests of grrl-perceive, which ctest calls as: test.sh GRRL_PERCEIVE VERSION SOURCES
set -u
PERCEIVE=$1 VERSION=$2 SOURCES=$3
PROGRAM=("$PERCEIVE")
# shellcheck source=tests/expect.sh
. "$(dirname "${BASH_SOURCE[0]}")/../expect.sh"

finish() {
    [ "$FAILURES" -eq 0 ] || exit 1
}
