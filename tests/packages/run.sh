#!/usr/bin/env bash
# Tries what people install, in bare Debian trees. Run as root, with debootstrap and a network.
#   tests/packages/run.sh [BUILD]
#       Makes the Debian packages and the tarball of a finished build, and tries each: some ten minutes.
#   tests/packages/run.sh --whole [options of ctest]
#       Starts from a clean clone of the last commit in a fresh tree: tries `./run demo`, `./run test` and
#       `cmake --install`, then the packages made there. Takes hours the first time; the compiler's cache is
#       kept.
# Leaves in build/: bare-debian, where packages are tried; bare-whole, the other tree; and bare-ccache.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

mounted=()
unmountAll() {
    local at
    for ((at = ${#mounted[@]} - 1; at >= 0; --at)); do umount "${mounted[at]}"; done
}
trap unmountAll EXIT

openTree() { # TREE
    [[ -e $1/etc/debian_version ]] || debootstrap --variant=minbase bookworm "$1"
    cp /etc/resolv.conf "$1/etc/"
    mount -t proc proc "$1/proc"
    mounted+=("$1/proc")
    mount -t devpts -o ptmxmode=0666 devpts "$1/dev/pts"  # for the tests of windows, which open a terminal
    mounted+=("$1/dev/pts")
}

# Runs standard input as a script in the tree; prints the time it took.
enter() { # TREE
    {
        cat <<'END'
set -euo pipefail
step() {
    local begin=$SECONDS
    "$@"
    echo "packages: $1 ${2:-}: $((SECONDS - begin)) s"
}
# Runs the program on the PATH, from an unrelated folder.
tryProgram() {
    local work
    work=$(mktemp -d)
    (
        cd "$work"
        binosplat --version
        binosplat info builtin:fence
        binosplat render builtin:fence --headset index --size 64x64 --out pictures
        binosplat view builtin:fence --simulate --frames 30 --load-first --out seen
        test -s pictures/report.json
        test -s seen/frame_000030.png
    )
    rm -r "$work"
}
END
        cat
    } >"$1/tmp/steps.sh"
    chroot "$1" env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin DEBIAN_FRONTEND=noninteractive \
        ${http_proxy:+http_proxy="$http_proxy"} bash /tmp/steps.sh </dev/null
}

# Leaves build/packages as cpack does.
makePackagesFromClone() { # [options of ctest]
    local tree=$PWD/build/bare-whole
    if mountpoint -q "$tree/proc" || mountpoint -q "$tree/root/.cache/ccache"; then
        echo "tests/packages/run.sh: something is mounted in $tree, must be unmounted first" >&2
        exit 1
    fi
    rm -rf --one-file-system "$tree"
    openTree "$tree"
    mkdir -p build/bare-ccache "$tree/root/.cache/ccache"
    mount --bind build/bare-ccache "$tree/root/.cache/ccache"
    mounted+=("$tree/root/.cache/ccache")
    git bundle create -q "$tree/tmp/binosplat.bundle" HEAD
    {
        echo "test_options=(${*@Q})"
        cat <<'END'
apt-get update -q
apt-get install -y -q --no-install-recommends git
cd
git clone -q /tmp/binosplat.bundle binosplat
cd binosplat
step ./run demo
test -s out/demo/report.json
step ./run test "${test_options[@]}"
step cmake --install build/release
step tryProgram
xargs rm <build/release/install_manifest.txt
step cpack --config build/release/CPackConfig.cmake -B "$PWD/build/packages"
END
    } | enter "$tree"
    rm -rf build/packages
    mkdir -p build/packages
    cp "$tree"/root/binosplat/build/packages/*.{deb,tar.gz} build/packages/
}

tryPackages() {
    local tree=$PWD/build/bare-debian
    openTree "$tree"
    rm -rf "$tree/tmp/packages"
    mkdir "$tree/tmp/packages"
    cp build/packages/*.{deb,tar.gz} "$tree/tmp/packages/"
    rm -rf "$tree/tmp/examples"
    cp -r docs/examples "$tree/tmp/examples"
    enter "$tree" <<'END'
# Packages from an earlier run may be newer, or have the same version.
dpkg --remove python3-binosplat libbinosplat-dev libbinosplat0 binosplat binosplat-simulated-runtime
apt-get update -q
step apt-get install -y -q --no-install-recommends /tmp/packages/*.deb mesa-vulkan-drivers
step tryProgram
python3 -c 'import binosplat; scene = binosplat.Scene.from_file("builtin:fence"); assert scene.render(scene.start_view(64, 64))[0].max() > 0'

# A foreign program built against libbinosplat-dev, with pkg-config and with CMake.
tryLibrary() {
    local work
    work=$(mktemp -d)
    (
        cd "$work"
        c++ -std=c++17 /tmp/examples/stereo.cpp $(pkg-config --cflags --libs binosplat) -o stereo
        ./stereo builtin:fence
        test -s left.png
        rm left.png
        cmake -S /tmp/examples -B build
        cmake --build build
        build/stereo builtin:fence
        test -s left.png
    )
    rm -r "$work"
}
apt-get install -y -q --no-install-recommends g++ pkg-config cmake make
step tryLibrary

# The tarball, in a folder of its own; the libraries it links come from the packages.
dpkg --remove binosplat binosplat-simulated-runtime
if command -v binosplat; then exit 1; fi
rm -rf /opt/binosplat
mkdir /opt/binosplat
tar -xzf /tmp/packages/binosplat-*.tar.gz -C /opt/binosplat --strip-components=1
PATH=/opt/binosplat/bin:$PATH
step tryProgram
END
}

if [[ ${1:-} == --whole ]]; then
    makePackagesFromClone "${@:2}"
else
    build=${1:-build/release}
    rm -rf build/packages
    cpack --config "$build/CPackConfig.cmake" -B "$PWD/build/packages"
fi
tryPackages
echo "packages: installed, and run from a folder of their own"
