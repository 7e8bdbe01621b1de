#!/bin/sh
# Every manifest tells the version of the project, which is in CMakeLists.txt. version.sh VERSION
set -eu
version=$1
# shellcheck source=tests/packaging/common.sh
. "$(dirname "$0")/common.sh"

# tells FILE PATTERN: the pattern takes the version out of one line of the file
tells() {
    found=$(sed -n "$2" "$source/$1")
    [ "$found" = "$version" ] ||
        wrong "$1: version '$found', but CMakeLists.txt has $version; tools/version sets them all"
}

tells CMakeLists.txt 's/^project(grrl VERSION \([0-9.]*\) .*/\1/p'
tells lib/library.json 's/^  "version": "\(.*\)",$/\1/p'
tells lib/library.properties 's/^version=//p'
tells lib/idf_component.yml 's/^version: "\(.*\)"$/\1/p'
tells python/pyproject.toml 's/^version = "\(.*\)"$/\1/p'
grep -q "^## $version\( \|$\)" "$source/CHANGELOG.md" || wrong "CHANGELOG.md has no heading ## $version"
cmp "$source/LICENSE" "$source/lib/LICENSE" || wrong "lib/LICENSE is not a copy of LICENSE"

# The command that sets them, on a copy.
mkdir "$work/lib" "$work/python"
for file in CMakeLists.txt lib/library.json lib/library.properties lib/idf_component.yml \
    python/pyproject.toml; do
    cp "$source/$file" "$work/$file"
done
quiet "$source/tools/version" 12.3.4 "$work"
for file in CMakeLists.txt lib/library.json lib/library.properties lib/idf_component.yml \
    python/pyproject.toml; do
    [ "$(diff "$source/$file" "$work/$file" | grep -c '^>.*12[.]3[.]4')" -eq 1 ] ||
        wrong "tools/version does not set $file"
    [ "$(diff "$source/$file" "$work/$file" | grep -c '^>')" -eq 1 ] ||
        wrong "tools/version changes more of $file: $(diff "$source/$file" "$work/$file")"
done
if "$source/tools/version" 1.2 "$work" 2>"$work/log"; then
    wrong "the version 1.2 was taken"
fi
grep -q 'three numbers' "$work/log" || wrong "$(cat "$work/log")"
