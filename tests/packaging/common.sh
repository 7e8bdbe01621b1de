# shellcheck shell=sh
# Sourced by the tests of packages: what tests/consumer has, and the glob of a firmware project.
# shellcheck source=tests/consumer/common.sh
. "$(dirname "$0")/../consumer/common.sh"

# need COMMAND PACKAGE
need() {
    command -v "$1" >/dev/null || skip "there is no $1 (Debian: $2)"
}

# tool NAME: the path of a program of packaging/setup-env, for path=$(tool NAME)
tool() {
    [ -x "$source/build/packaging/venv/bin/$1" ] ||
        skip "there is no $1: packaging/setup-env was not run" >&2
    echo "$source/build/packaging/venv/bin/$1"
}

# compile_glob NAME FOLDER COMPILER OPTION..: every C file below FOLDER, as a firmware project does, with
# its usual dialect; no warning, and nothing but arithmetic and a few functions of C left undefined
compile_glob() {
    name=$1 folder=$2 compiler=$3
    shift 3
    mkdir "$work/$name"
    if ! (cd "$work/$name" && find "$folder" -name '*.c' -print0 |
        xargs -0 -P 2 -n 8 "$compiler" -std=gnu17 -Os -Wall -Wextra -Werror -ffp-contract=off "$@" -c) \
        >"$work/log" 2>&1; then
        head -n 30 "$work/log"
        wrong "$name: does not compile"
    fi
    [ "$(find "$work/$name" -name '*.o' | wc -l)" -gt 40 ] || wrong "$name: where are the sources?"
    # The arithmetic of libgcc, and the C library's part without memory, files or printing.
    allowed='__aeabi_(mem[a-z0-9]*|[a-z]*[0-9]*[a-z]+|u?idiv(mod)?|[dfilu]+2[dfilu]+z?|fcmp.*)|__gnu_[a-z0-9_]*'
    allowed="$allowed|__[a-z]*(sf|di|si|sfsi|ti|hi)[a-z0-9]*|mem(cpy|set|cmp|move|chr)|str(len|cmp|ncmp|chr|spn|cspn)"
    allowed="$allowed|(sqrt|sin|cos|atan2|fmin|fmax|floor|ceil|round|exp|log|log1p|fabs|hypot|pow|acos|asin|remainder|fmod|erf|erfc|ldexp|frexp|expm1|tan|atan|lgamma|lround|rint|lrint|trunc|copysign|cbrt|sincos)f"
    allowed="$allowed|__assert_func|__errno|__assert_no_args|errno"
    if "${compiler%gcc}nm" "$work/$name"/*.o | awk 'NF == 2 && $1 == "U" { wanted[$2] } NF == 3 { here[$3] }
        END { for (name in wanted) if (!(name in here)) print name }' | grep -vxE "$allowed"; then
        wrong "$name: these must not be needed"
    fi
}
