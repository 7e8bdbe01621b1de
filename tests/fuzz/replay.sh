#!/bin/sh
# replay.sh TARGET CORPUS: runs the kept corpus of a fuzz target through it.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
tar xzf "$2/$(basename "$1").tar.gz" -C "$folder"
find "$folder" -type f -exec "$1" {} +
