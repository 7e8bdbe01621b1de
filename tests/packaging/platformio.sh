#!/bin/sh
# PlatformIO packs lib/, and the package compiles with what its manifest says and nothing else.
# platformio.sh VERSION
set -eu
version=$1
# shellcheck source=tests/packaging/common.sh
. "$(dirname "$0")/common.sh"
need arm-none-eabi-gcc gcc-arm-none-eabi
pio=$(tool pio)
python=$(dirname "$pio")/python

# pack FOLDER: must say what is wrong with it
refused() {
    if "$python" "$here/pio_pack.py" "$1" "$work/bad.tar.gz" >"$work/log" 2>&1; then
        wrong "a package with a wrong manifest was packed"
    fi
    grep -q "$2" "$work/log" || wrong "$(cat "$work/log")"
}

mkdir "$work/bad" "$work/package"
sed 's/"license": "MIT"/"license": "mine"/' "$source/lib/library.json" >"$work/bad/library.json"
refused "$work/bad" license
sed 's/"version": "[^"]*"/"version": "new"/' "$source/lib/library.json" >"$work/bad/library.json"
refused "$work/bad" version

quiet "$python" "$here/pio_pack.py" "$source/lib" "$work/grrl-$version.tar.gz"
quiet tar xzf "$work/grrl-$version.tar.gz" -C "$work/package"
for file in library.json LICENSE include/grrl/grrl.h src/policies.c; do
    [ -s "$work/package/$file" ] || wrong "$file is not in the package"
done
# shellcheck disable=SC2046 # flags have no spaces
compile_glob platformio "$work/package/src" arm-none-eabi-gcc -mcpu=cortex-m0plus -mthumb \
    -I"$work/package/include" -I"$work/package/src" -DGRRL_PROFILE=tiny \
    $("$python" -c 'import json, sys; print(*json.load(open(sys.argv[1]))["build"]["flags"])' \
        "$work/package/library.json")
