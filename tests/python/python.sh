#!/bin/bash
# python.sh ROOT CASE [PROGRAM..]: the Python package, in the environment of python/setup-env.
#   tests GRRL-PERCEIVE GRRL-EXPERIMENT GRRL-SIM GRRL-AGENT   its tests, next to these programs
#   sdist     a source distribution holds all it needs, and builds without Box2D
# Exit status 77: skipped.
set -u
ROOT=$1 CASE=$2
shift 2
export LC_ALL=C.UTF-8

if [ ! -f "$ROOT/build/python/packages.stamp" ]; then
    echo "skipped: the Python packages are missing; python/setup-env installs them"
    exit 77
fi
"$ROOT/python/setup-env" || exit 1 # the sources may have changed since
VENV=$ROOT/build/python/venv
export PATH=$VENV/bin:$PATH PYTHONDONTWRITEBYTECODE=1

case $CASE in
tests)
    export GRRL_PERCEIVE=$1 GRRL_EXPERIMENT=$2 GRRL_SIM=$3 GRRL_AGENT=$4 MPLBACKEND=Agg
    cd "$ROOT/python" && exec python -m pytest -p no:cacheprovider tests
    ;;
sdist)
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
    fail() {
        echo "FAILED: $*"
        tail -n 30 "$work/log"
        exit 1
    }
    cd "$ROOT/python" || exit 1
    python -c 'import sys; from scikit_build_core.build import build_sdist; build_sdist(sys.argv[1])' \
        "$work" >"$work/log" 2>&1 || fail "no source distribution"
    options=()
    command -v ccache >/dev/null &&
        options=(-Ccmake.define.CMAKE_C_COMPILER_LAUNCHER=ccache
            -Ccmake.define.CMAKE_CXX_COMPILER_LAUNCHER=ccache)
    cd "$work" && python -m pip install --no-index --no-deps --no-build-isolation --target "$work/site" \
        -Ccmake.define.CMAKE_DISABLE_FIND_PACKAGE_box2d=ON "${options[@]}" grrl-*.tar.gz \
        >"$work/log" 2>&1 || fail "the source distribution does not build"
    PYTHONPATH=$work/site python - "$ROOT/examples/hinge.csv" "$work/site" <<'END' >"$work/log" 2>&1 ||
import sys
import grrl
assert grrl.__file__.startswith(sys.argv[2]), grrl.__file__
model = grrl.perceive(grrl.io.from_csv(sys.argv[1], unit="mm"), noise=0.7)
assert model.term == "D(lb, R(L(s, f1), L(s, f2)))", model.term
try:
    grrl.World("RPR")
except ImportError as error:
    assert "libbox2d-dev" in str(error), error
else:
    raise AssertionError("a world without Box2D")
END
        fail "what is built without Box2D"
    ;;
*)
    echo "FAILED: $CASE: there is no such case"
    exit 1
    ;;
esac
