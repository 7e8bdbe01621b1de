#!/bin/bash
# no_generated_decoder.sh GENERATED CALLER OBJECT..: none of the objects refers to a decoder in the
# library of generated code, nor to its subscriptions, which decode before anybody has checked.
# CALLER is an object that does refer to one: without it this test could not fail.
set -euo pipefail
command -v nm >/dev/null || exit 77
unchecked='^_*grrl_[a-z_]*_t_(decode[a-z_]*|subscribe)$'

# undefined OBJECT..: the symbols that it wants from others
undefined() {
    nm -u "$@" | awk '$1 == "U" { print $2 }' | sort -u
}

generated=$1
caller=$2
shift 2
IFS=';' read -r -a objects <<<"$(
    IFS=';'
    printf '%s' "$*"
)"
defined=$(nm "$generated" | awk '$2 == "T" { print $3 }' | grep -cE "$unchecked") || defined=0
[ "$defined" -ge 14 ] || {
    echo "FAILED: $generated has $defined decoders: are they called otherwise now?"
    exit 1
}
undefined "$caller" | grep -qE "$unchecked" || {
    echo "FAILED: $caller refers to no decoder: this test sees nothing"
    exit 1
}
if undefined "${objects[@]}" | grep -E "$unchecked"; then
    echo "FAILED: decoders that trust the wire are called"
    exit 1
fi
echo "$defined generated decoders, none of them called"
