# Sourced by the scripts of this folder: the packed program in build/arm64-tried, with Debian 13's libraries
# and Mesa 25 for it.
# shellcheck shell=bash
tarball=$(find build/arm64 -maxdepth 1 -name 'binosplat-*-linux-arm64.tar.gz' -printf '%T@ %p\n' 2>/dev/null | sort -n | tail -n 1 | cut -d' ' -f2-)
[[ -n $tarball ]] || {
    echo "$0: no tarball in build/arm64; run ./run arm64" >&2
    exit 1
}
third_party/arm64/root.sh build/arm64-mesa trixie mesa-vulkan-drivers mesa-drm-shim libvulkan1 libstdc++6 libcurl4t64 libfontconfig1 libfreetype6 \
    libfribidi0 libharfbuzz0b libpng16-16t64 libssl3t64 libx11-6 zlib1g libzstd1 fonts-dejavu-core
rm -rf build/arm64-tried
mkdir -p build/arm64-tried
tar -xzf "$tarball" -C build/arm64-tried --strip-components=1
export BINOSPLAT_PIPELINE_CACHE=0 MESA_SHADER_CACHE_DISABLE=true XDG_RUNTIME_DIR=/tmp
arm64() { qemu-aarch64-static -L "${system:-build/arm64-mesa}" "$@"; }
