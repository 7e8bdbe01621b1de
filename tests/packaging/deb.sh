#!/bin/bash
# Makes the Debian packages, and on a small Debian of its own installs, uses and removes them: apt takes
# them, grrl-sim finds an object by name beside grrl-agent, a program of someone else builds on
# libgrrl-dev, and nothing stays behind. lintian must find no error.
set -euo pipefail
source=$(cd "$(dirname "$0")/../.." && pwd -P)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

fail() {
    printf '%s\n' "$*"
    exit 1
}

skip() {
    printf 'skipped: %s\n' "$*"
    exit 77
}

# in_root COMMAND..: in the small Debian
in_root() {
    DEBIAN_FRONTEND=noninteractive LC_ALL=C PATH=/usr/sbin:/usr/bin:/sbin:/bin \
        chroot "$work/root" "$@" >"$work/log" 2>&1 || {
        tail -n 30 "$work/log"
        fail "failed in the small Debian: $*"
    }
}

files() {
    find "$work/root" -xdev \( -path "$work/root/var" -o -path "$work/root/proc" -o \
        -path "$work/root/tmp" -o -name ld.so.cache -o -name aux-cache \) -prune -o -print | sort
}

for tool in dpkg-shlibdeps lintian mmdebstrap; do
    command -v $tool >/dev/null || skip "there is no $tool: tools/setup packages"
done
[ "$(id -u)" -eq 0 ] || skip "chroot needs root"
[ -f "$source/build/deb/root.tar" ] || "$source/packaging/root" || skip "no small Debian"

export DEBEMAIL=${DEBEMAIL:-builder@debian.org}
"$source/packaging/deb" "$work/packages" >"$work/log" 2>&1 || {
    cat "$work/log"
    fail "packaging/deb"
}
[ "$(find "$work/packages" -name '*.deb' | wc -l)" -eq 3 ] || fail "there must be three packages"
lintian --allow-root --fail-on error "$work"/packages/*.deb || fail "lintian found an error"

mkdir "$work/root"
tar xf "$source/build/deb/root.tar" -C "$work/root" --exclude './dev/*'
mknod -m 666 "$work/root/dev/null" c 1 3
mknod -m 444 "$work/root/dev/urandom" c 1 9
cp "$work"/packages/*.deb "$work/root/tmp"
files >"$work/before"
in_root sh -c 'apt-get install -y --no-install-recommends /tmp/*.deb'

# Used: as a user would, on LCM.
# (It finds its objects by /proc, which goes away with the mount namespace.)
"$source/tools/network" unshare -m sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" sh -c "$1"' \
    "$work/root" '
    grrl-sim --object wooden-toy --trials 2 --seed 1 --agent-timeout 60 --results /tmp/trials.csv --quiet &
    timeout 200 grrl-agent --seed 1 --quiet && wait $!' >"$work/log" 2>&1 || {
    cat "$work/log"
    fail "grrl-sim beside grrl-agent"
}
[ "$(grep -c discovered "$work/root/tmp/trials.csv")" -eq 2 ] || fail "$(cat "$work/root/tmp/trials.csv")"
in_root grrl-term match "P(l1, l2)" "P(l3, l4)"
version=$(sed -n 's/^project(grrl VERSION \([0-9.]*\) .*/\1/p' "$source/CMakeLists.txt")
for program in "$work"/root/usr/bin/grrl-*; do
    in_root "/usr/bin/${program##*/}" --version
    grep -q "${program##*/} $version" "$work/log" || fail "${program##*/}: $(cat "$work/log")"
done

# Built on: with the headers and the library of the packages, not of this tree.
library=$(echo "$work"/root/usr/lib/*-linux-gnu)
export PKG_CONFIG_SYSROOT_DIR=$work/root PKG_CONFIG_LIBDIR=$library/pkgconfig
read -ra flags <<<"$(pkg-config --cflags --libs grrl)"
cc "$source/tests/consumer/consumer.c" "${flags[@]}" -o "$work/root/tmp/consumer" ||
    fail "a program does not build on libgrrl-dev"
in_root /tmp/consumer
grep -qx '16 links' "$work/log" || fail "$(cat "$work/log")"

in_root apt-get purge -y --autoremove grrl-tools libgrrl-dev 'libgrrl0*'
files >"$work/after"
diff "$work/before" "$work/after" || fail "these stay behind"
echo "installed, used and removed"
