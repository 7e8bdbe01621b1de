#!/bin/sh
# The sources as a plain glob with two -I, for five kinds of processor and every profile.
set -eu
# shellcheck source=tests/packaging/common.sh
. "$(dirname "$0")/common.sh"
need arm-none-eabi-gcc gcc-arm-none-eabi
need riscv64-unknown-elf-gcc gcc-riscv64-unknown-elf

# build NAME PROFILE COMPILER OPTION..
build() {
    name=$1 profile=$2 compiler=$3
    shift 3
    compile_glob "$name" "$source/lib/src" "$compiler" "$@" -DGRRL_PROFILE="$profile" \
        -I"$source/lib/include" -I"$source/lib/src"
    echo "$name, $profile: $("${compiler%gcc}size" -t "$work/$name"/*.o | awk 'END { print $1, "bytes" }')"
}

build m0plus tiny arm-none-eabi-gcc -mcpu=cortex-m0plus -mthumb
build m4f small arm-none-eabi-gcc -mcpu=cortex-m4 -mthumb -mfloat-abi=hard -mfpu=fpv4-sp-d16
build m7 default arm-none-eabi-gcc -mcpu=cortex-m7 -mthumb -mfloat-abi=hard -mfpu=fpv5-d16
build rv32imc tiny riscv64-unknown-elf-gcc --specs=picolibc.specs -march=rv32imc -mabi=ilp32
build rv64 large riscv64-unknown-elf-gcc --specs=picolibc.specs -march=rv64imac -mabi=lp64
