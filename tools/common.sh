# shellcheck shell=bash
# Sourced by the commands in this folder: the project's location, messages, set-up, building.
# Exit status of every command: 0 success, 1 something failed, 2 wrong command line.
set -euo pipefail
ROOT=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd -P)
NAME=${0##*/}

note() {
    printf '%s: %s\n' "$NAME" "$*" >&2
}

fail() {
    note "$@"
    exit 1
}

usage_error() {
    note "$@"
    printf 'Try %s --help\n' "$0" >&2
    exit 2
}

# set_up GROUP..: see tools/setup
set_up() {
    "$ROOT/tools/setup" "$@" || exit 1
}

# build PRESET [TARGET..]: quiet unless it fails
build() {
    local preset=$1 log=$ROOT/build/$1.log
    shift
    local targets=()
    [ $# -eq 0 ] || targets=(--target "$@")
    mkdir -p "$ROOT/build"
    note "building in $ROOT/build/$preset"
    if ! (cd "$ROOT" && cmake --preset "$preset" &&
        cmake --build --preset "$preset" "${targets[@]}") >"$log" 2>&1; then
        tail -n 40 "$log" >&2
        fail "the build failed; its output is in $log"
    fi
}
