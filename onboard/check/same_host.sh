#!/bin/bash
# same_host.sh FOLDER COMPILER LEVEL: the recorded run on this machine, compiled like this.
# shellcheck source=onboard/check/common.sh
. "$(dirname "${BASH_SOURCE[0]}")/common.sh"
folder=$1 compiler=$2 level=$3
need "$compiler" "$compiler"
name=$compiler$level
build_in "$folder/$name" replay -DCMAKE_C_COMPILER="$compiler" -DCMAKE_C_FLAGS="$level" \
    -DGRRL_BUILD_PROCESSES=OFF
"$folder/$name/onboard/grrl-replay" "$folder/run.rec" | tee "$folder/$name.txt"
same "$folder/expected.txt" "$folder/$name.txt"
