#!/bin/sh
# Builds the library as a shared one, with a capacity of its own, and uses it as installed. It exports
# all that its public headers declare and nothing else: shared.sh CC CXX VERSION
set -eu
cc=$1 cxx=$2 version=$3
# shellcheck source=tests/consumer/common.sh
. "$(dirname "$0")/common.sh"
quiet cmake -S "$source" -B "$work/shared" -DCMAKE_C_COMPILER="$cc" -DBUILD_SHARED_LIBS=ON \
    -DGRRL_MAX_LINKS=12 -DGRRL_BUILD_PROCESSES=OFF -DGRRL_BUILD_TESTS=OFF -DGRRL_BUILD_BENCH=OFF \
    -DGRRL_BUILD_ONBOARD=OFF
quiet cmake --build "$work/shared"
library=$work/shared/lib/libgrrl.so.$version
[ -f "$library" ] || wrong "there is no $library"

# Declared: functions and arrays, without what is static inline, which nm does not know.
(cd "$source/lib/include" && find grrl -name '*.h' | sed 's/.*/#include "&"/') >"$work/all.c"
"$cc" -E -P -I"$source/lib/include" -I"$work/shared/lib/include" "$work/all.c" >"$work/all.i"
{
    grep -v '^ \|static inline' "$work/all.i" | sed 's/[a-z_]* (\*.*//' |
        grep -o '\bgrrl_[a-zA-Z0-9_]* *[([]' | tr -d ' (['
    grep -o 'grrl_policy_type grrl_policy_[a-z]*;' "$work/all.i" | sed 's/.* //; s/;//'
} | sort -u >"$work/declared"
nm -D --defined-only "$library" | awk '{print $3}' | sort -u >"$work/exported"
[ "$(wc -l <"$work/declared")" -gt 50 ] || wrong "no functions found in the public headers"
diff "$work/declared" "$work/exported" >"$work/log" || {
    cat "$work/log"
    wrong "lib/include declares what stands after <, $library exports what stands after >"
}
sh "$here/installed.sh" "$work/shared" "$cc" "$cxx" "$version"
