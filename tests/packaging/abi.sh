#!/bin/sh
# packaging/abi sees a struct that grew, and fails for it once the version is released.
set -eu
# shellcheck source=tests/packaging/common.sh
. "$(dirname "$0")/common.sh"
need abidiff abigail-tools

mkdir "$work/tree"
for part in CMakeLists.txt CHANGELOG.md lib cmake cli packaging; do
    cp -R "$source/$part" "$work/tree/$part"
done
mkdir "$work/tree/tools"
cp "$source/tools/common.sh" "$work/tree/tools"
cp -R "$source/tools/man" "$source/tools/completion" "$work/tree/tools"
header=$work/tree/lib/include/grrl/base/geometry.h
grep -q '^struct grrl_vec2 {$' "$header" || wrong "there is no struct grrl_vec2 any more"
sed -i 's/^struct grrl_vec2 {$/struct grrl_vec2 {\n    float w;/' "$header"

version=$(sed -n 's/^project(grrl VERSION \([0-9.]*\) .*/\1/p' "$source/CMakeLists.txt")
sed -i "s/^## $version.*/## $version (unreleased)/" "$work/tree/CHANGELOG.md"
"$work/tree/packaging/abi" >"$work/log" 2>&1 || wrong "not released, and yet: $(cat "$work/log")"
grep -q 'grrl_vec2' "$work/log" || wrong "the struct that grew is not named: $(cat "$work/log")"
sed -i "s/^## $version.*/## $version/" "$work/tree/CHANGELOG.md"
if "$work/tree/packaging/abi" >"$work/log" 2>&1; then
    wrong "a released struct grew, and packaging/abi is content"
fi
grep -q 'raise the version' "$work/log" || wrong "$(cat "$work/log")"
