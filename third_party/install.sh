#!/usr/bin/env bash
# Installs the Debian packages that the build needs and that are missing, and nothing else; with --ci also
# those of the checks of .ci/run, with --windows those of the build for Windows, with --arm64 those of the
# build for aarch64, whose libraries it unpacks into build/arm64-root.
set -euo pipefail

packages=(
    g++ cmake ninja-build ccache pkg-config
    libvulkan-dev mesa-vulkan-drivers vulkan-validationlayers
    glslang-tools spirv-tools
    libglm-dev libfmt-dev libcli11-dev libtomlplusplus-dev nlohmann-json3-dev
    libopenimageio-dev libwebp-dev libzip-dev libpng-dev zlib1g-dev libzstd-dev libcurl4-openssl-dev ca-certificates
    libopenxr-dev libopenxr-utils openxr-layer-corevalidation libimgui-dev libfribidi-dev libfontconfig-dev libharfbuzz-dev libfreetype-dev libglfw3-dev
    fonts-dejavu-core fonts-droid-fallback fonts-lohit-deva
    doctest-dev python3 xvfb xdotool openssl nghttp2-server
    dpkg-dev file
)
# For continuous integration besides: the check of the format, the library from Python, shells and desktops
# that completions, entries and file dialogs are for, the encoder of films, what shows man pages, and an X
# server with a touchpad.
[[ ${1:-} != --ci ]] || packages+=(clang-format python3-numpy zsh fish desktop-file-utils appstream shared-mime-info libglib2.0-bin ffmpeg dbus groff-base xserver-xorg-core xserver-xorg-video-dummy)
# For Windows: the compiler, and what unpacks and compiles Debian's source packages.
[[ ${1:-} != --windows ]] || packages+=(g++-mingw-w64-x86-64-posix libz-mingw-w64-dev xz-utils patch make python3-jinja2)
# For aarch64: the compiler, and what runs its programs here.
[[ ${1:-} != --arm64 ]] || packages+=(g++-aarch64-linux-gnu qemu-user-static)

if ! command -v dpkg-query >/dev/null; then
    echo "third_party/install.sh: this is not a Debian system; install by hand: ${packages[*]}" >&2
    exit 1
fi

missing=()
for package in "${packages[@]}"; do
    status=$(dpkg-query --show --showformat='${Status}' "$package" 2>/dev/null || true)
    [[ $status == "install ok installed" ]] || missing+=("$package")
done
if ((${#missing[@]} == 0)); then
    echo "packages: all ${#packages[@]} are installed"
else
    echo "packages: installing ${missing[*]}"
    as_root=()
    if ((EUID != 0)); then
        if ! command -v sudo >/dev/null; then
            echo "third_party/install.sh: not root and no sudo; as root, run: apt-get install --no-install-recommends ${missing[*]}" >&2
            exit 1
        fi
        as_root=(sudo)
    fi
    export DEBIAN_FRONTEND=noninteractive
    "${as_root[@]}" apt-get update -q
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends "${missing[@]}"
fi

if [[ ${1:-} == --arm64 ]]; then
    # The libraries above of that machine: OpenEXR in place of OpenImageIO, which has a hundred packages
    # behind it.
    libraries=("libstdc++-$(aarch64-linux-gnu-g++ -dumpversion)-dev" libopenexr-dev)
    for package in "${packages[@]}"; do
        [[ $package != *-dev || $package =~ ^(libopenimageio|dpkg)-dev$ ]] || libraries+=("$package")
    done
    # shellcheck source=/dev/null
    . /etc/os-release
    here=$(dirname "${BASH_SOURCE[0]}")
    "$here/arm64/root.sh" "$here/../build/arm64-root" "$VERSION_CODENAME" "${libraries[@]}"
fi
