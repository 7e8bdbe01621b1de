# shellcheck shell=bash
# Sourced by the scripts that make a Python environment, after tools/common.sh: made once, and again
# when the requirements change. Sets DIR, the folder in build/, with the environment in DIR/venv.

# begin_environment NAME: nobody else works in it until this script ends
begin_environment() {
    DIR=$ROOT/build/$1
    mkdir -p "$DIR"
    exec 9>"$DIR/setup.lock"
    flock 9
}

# done_before STAMP TEXT
done_before() {
    [ "$(cat "$DIR/$1" 2>/dev/null)" = "$2" ]
}

# stamp STAMP TEXT
stamp() {
    printf '%s\n' "$2" >"$DIR/$1"
}

# logged TEXT COMMAND..: TEXT says what went wrong, with the end of the output
logged() {
    local what=$1
    shift
    "$@" >"$DIR/setup.log" 2>&1 || {
        tail -n 20 "$DIR/setup.log" >&2
        fail "$what; all its output is in $DIR/setup.log"
    }
}

# find_python: the path of one that can make an environment
find_python() {
    local candidate
    for candidate in python3 /usr/bin/python3; do
        if "$candidate" -c 'import ensurepip, sys, venv; sys.exit(sys.version_info < (3, 11))' \
            2>/dev/null; then
            printf '%s\n' "$candidate"
            return
        fi
    done
    fail "needs Python 3.11 or newer with venv; on Debian 12: apt-get install python3-venv"
}

# install_requirements FILE: succeeds at once if they are installed
install_requirements() {
    local packages python
    packages=$(cksum <"$1")
    ! done_before packages.stamp "$packages" || return 0
    python=$(find_python)
    rm -f "$DIR"/*.stamp
    note "installing the packages of ${1#"$ROOT"/} into ${DIR#"$ROOT"/}/venv"
    logged "venv failed" "$python" -m venv --clear "$DIR/venv"
    logged "pip failed (is there a network that reaches PyPI?)" \
        "$DIR/venv/bin/python" -m pip install --disable-pip-version-check --no-deps -r "$1"
    stamp packages.stamp "$packages"
}
