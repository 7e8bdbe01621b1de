#!/bin/sh
# purpose.sh PROJECT: every source file opens with a comment that says what it is for.
set -eu
cd "$1"

# silent FOLDER: the source files in it that open otherwise than with a comment of some words
silent() (
    cd "$1"
    find . -type d \( -name .git -o -name 'build*' -o -name out \) -prune -o -type f \
        \( -name '*.c' -o -name '*.h' -o -name '*.cpp' -o -name '*.hpp' \) -print | sort |
        while IFS= read -r file; do
            head -n 2 "$file" | tr '\n' ' ' |
                grep -qE '^(//|/\*)[ *]*[[:alnum:]`"][^/]* [^/]* ' || printf '%s\n' "${file#./}"
        done
)

# That silent sees anything at all.
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo '/* Adds two numbers. */' >"$work/one_line.c"
printf '/*\n * many.h: several lines about numbers.\n */\n' >"$work/many.h"
printf '// Subtracts two numbers.\n' >"$work/slashes.cpp"
printf '#include <a.h>\n/* Adds two numbers. */\n' >"$work/late.c"
printf '/* */\n#include <a.h>\n' >"$work/nothing_said.hpp"
: >"$work/empty.h"
[ "$(silent "$work" | tr '\n' ' ')" = 'empty.h late.c nothing_said.hpp ' ] || {
    echo "FAILED: of six files, three without purpose, this test finds: $(silent "$work")"
    exit 1
}

failed=0 found=$(silent .)
for file in $found; do
    echo "$file:1: must open with a comment: what the file is for"
    failed=1
done
exit $failed
