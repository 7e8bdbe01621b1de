# shellcheck shell=bash
# Sourced by the checks in this folder. Exit status: 0 passed, 1 failed, 77 skipped.
set -euo pipefail
# shellcheck disable=SC2034
POLICIES="learn paper"
SOURCE=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd -P)

fail() {
    printf '%s: %s\n' "${0##*/}" "$*" >&2
    exit 1
}

# need COMMAND PACKAGE: the check is skipped without it
need() {
    command -v "$1" >/dev/null && return
    printf 'skipped: there is no %s (apt-get install %s)\n' "$1" "$2"
    exit 77
}

# build_in FOLDER PRESET ARGUMENT..: the arguments go to cmake
build_in() {
    local folder=$1 preset=$2
    shift 2
    mkdir -p "$folder"
    if ! (cmake -S "$SOURCE" --preset "$preset" -B "$folder" "$@" &&
        cmake --build "$folder" -j 2) >"$folder.log" 2>&1; then
        tail -n 30 "$folder.log"
        fail "the build failed: $folder.log"
    fi
}

# need_target TARGET: sets PRESET and CROSS
# shellcheck disable=SC2034
need_target() {
    case $1 in
    cortex-m4)
        PRESET=onboard CROSS=arm-none-eabi-
        need arm-none-eabi-gcc "gcc-arm-none-eabi libnewlib-arm-none-eabi"
        need qemu-system-arm qemu-system-arm
        ;;
    riscv64)
        PRESET=riscv CROSS=riscv64-unknown-elf-
        need riscv64-unknown-elf-gcc "gcc-riscv64-unknown-elf picolibc-riscv64-unknown-elf"
        need qemu-system-riscv64 qemu-system-misc
        ;;
    *) fail "$1: there is no such target" ;;
    esac
}

# emulate TARGET IMAGE ARGUMENT..: an instruction takes 64 ns of emulated time, so the emulated clock
# counts instructions; the result does not depend on this machine.
emulate() {
    local target=$1 image=$2 argument
    local options=enable=on,target=native,arg=grrl-image
    shift 2
    for argument in "$@"; do
        options+=,arg=$argument
    done
    local machine=(qemu-system-arm -M mps2-an386)
    [ "$target" = cortex-m4 ] || machine=(qemu-system-riscv64 -M virt -bios none)
    timeout 900 "${machine[@]}" -display none -monitor none -serial none \
        -icount shift=6,sleep=off -semihosting-config "$options" -kernel "$image" 2>&1
}

hashes() {
    grep -E '^(models|decisions|updates|store) [0-9a-f]{16}$' "$1"
}

# same EXPECTED OUTPUT: all four hashes are present and equal
same() {
    [ "$(hashes "$1" | wc -l)" -eq 4 ] || fail "$1 does not hold four hashes"
    diff <(hashes "$1") <(hashes "$2") || fail "the results differ from the recorded ones"
}
