#!/usr/bin/env bash
# Makes both Debian packages, installs them in a bare Debian tree, and runs what they hold from a folder of its own there. As root, with
# debootstrap and a network; about ten minutes. The tree in build/bare-debian is kept for the next run.
# usage: tests/packages/run.sh [BUILD]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
build=${1:-build/release}
tree=$PWD/build/bare-debian

[[ -e $tree/etc/debian_version ]] || debootstrap --variant=minbase bookworm "$tree"
rm -rf build/packages
cpack --config "$build/CPackConfig.cmake" -G DEB -B "$PWD/build/packages"
cp build/packages/*.deb "$tree/tmp/"
cp /etc/resolv.conf "$tree/etc/"
mount -t proc proc "$tree/proc"
trap 'umount "$tree/proc"' EXIT

chroot "$tree" bash -euc '
    export DEBIAN_FRONTEND=noninteractive
    apt-get update -q
    apt-get install -y -q --no-install-recommends --allow-downgrades /tmp/binosplat*.deb mesa-vulkan-drivers
    work=$(mktemp -d)
    cd "$work"
    binosplat --version
    binosplat info builtin:fence
    binosplat render builtin:fence --headset index --size 64x64 --out pictures
    binosplat view builtin:fence --simulate --frames 30 --load-first --out seen
    test -s pictures/report.json
    test -s seen/frame_000030.png
    rm -r "$work"
'
echo "packages: installed, and run from a folder of their own"
