#!/bin/bash
# same_host.sh FOLDER COMPILER LEVEL: replays the recorded runs on this machine, compiled this way.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
folder=$1 compiler=$2 level=$3
need "$compiler" "$compiler"
name=$compiler$level
build_in "$folder/$name" replay -DCMAKE_C_COMPILER="$compiler" -DCMAKE_C_FLAGS="$level" \
    -DGRRL_BUILD_PROCESSES=OFF
for policy in $POLICIES; do
    "$folder/$name/onboard/grrl-replay" "$folder/$policy.rec" | tee "$folder/$name-$policy.txt"
    same "$folder/$policy.expected" "$folder/$name-$policy.txt"
done
