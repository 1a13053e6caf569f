#!/bin/sh
# Cross-compiles the portable build for Windows on Debian, into build/windows. Not part of CI; docs/windows.md says what was seen to work.
#   third_party/windows.sh [targets...]     (without any: binosplat)
#   third_party/windows.sh --try            (and runs it under Wine, if that is installed: Debian's wine64 and wine)
# Debian packages, beside those of third_party/install.sh: g++-mingw-w64-x86-64-posix libz-mingw-w64-dev dpkg-dev xz-utils. Its sources give zstd.
set -eu
cd "$(dirname "$0")/.."
is_tried=
if [ "${1:-}" = --try ]; then
    is_tried=yes
    shift
    [ $# -eq 0 ] || { echo "third_party/windows.sh: --try stands alone" >&2; exit 2; }
fi
folder=$PWD/build/windows
needed=$folder/needed
compiler=x86_64-w64-mingw32-g++-posix
for program in "$compiler" cmake ninja glslangValidator spirv-val apt-get tar xz; do
    command -v "$program" >/dev/null || { echo "third_party/windows.sh: $program is missing; the first lines of this file name the packages" >&2; exit 1; }
done
mkdir -p "$needed/include" "$needed/lib" "$needed/cmake"

# Libraries that are headers alone are Debian's; /usr/include itself holds those of another C library.
for name in vulkan vk_video glm fmt CLI toml++ nlohmann; do
    rm -rf "$needed/include/$name"
    cp -RLp "/usr/include/$name" "$needed/include/$name"
done
interface() { # PACKAGE TARGET
    cat >"$needed/cmake/$1Config.cmake" <<END
if(NOT TARGET $2)
    add_library($2 INTERFACE IMPORTED)
    set_target_properties($2 PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "$needed/include" $3)
endif()
END
}
interface glm glm::glm ""
interface fmt fmt::fmt-header-only "INTERFACE_COMPILE_DEFINITIONS FMT_HEADER_ONLY=1"
interface CLI11 CLI11::CLI11 ""
interface nlohmann_json nlohmann_json::nlohmann_json ""
interface tomlplusplus tomlplusplus::tomlplusplus ""

# Nothing of Vulkan is linked: the program loads vulkan-1.dll when it needs it. CMake wants a file nevertheless.
vulkan=$needed/lib/libvulkan-1.a
[ -f "$vulkan" ] || x86_64-w64-mingw32-ar rcs "$vulkan"

# zstd, which Debian has for Linux only: its source package, checked by apt as any package is.
if [ ! -f "$needed/lib/libzstd.a" ]; then
    mkdir -p "$needed/zstd/lists/partial"
    . /etc/os-release
    echo "deb-src [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] http://deb.debian.org/debian $VERSION_CODENAME main" >"$needed/zstd/sources.list"
    (
        cd "$needed/zstd"
        set -- -q -o Dir::Etc::SourceList="$PWD/sources.list" -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$PWD/lists" \
            -o APT::Sandbox::User="$(id -un)" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache=
        apt-get "$@" update
        apt-get "$@" source --download-only libzstd
        mkdir -p source objects
        tar -xf libzstd_*.orig.tar.xz -C source --strip-components=1
        for file in source/lib/common/*.c source/lib/compress/*.c source/lib/decompress/*.c; do
            x86_64-w64-mingw32-gcc-posix -O2 -DZSTD_DISABLE_ASM=1 -c "$file" -o "objects/$(basename "$file" .c).o"
        done
        x86_64-w64-mingw32-ar rcs "$needed/lib/libzstd.a" objects/*.o
        cp source/lib/zstd.h source/lib/zstd_errors.h "$needed/include"
    )
fi

cmake --preset portable -B "$folder" -DCMAKE_SYSTEM_NAME=Windows -DCMAKE_SYSTEM_PROCESSOR=x86_64 -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_UNITY_BUILD=ON -DBINOSPLAT_TESTS=OFF -DCMAKE_PREFIX_PATH="$needed/cmake" \
    -DCMAKE_FIND_ROOT_PATH="$needed;/usr/x86_64-w64-mingw32" -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER \
    -DCMAKE_FIND_ROOT_PATH_MODE_LIBRARY=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_INCLUDE=ONLY -DCMAKE_FIND_ROOT_PATH_MODE_PACKAGE=ONLY \
    -Dglm_DIR="$needed/cmake" -Dfmt_DIR="$needed/cmake" -DCLI11_DIR="$needed/cmake" -Dnlohmann_json_DIR="$needed/cmake" \
    -Dtomlplusplus_DIR="$needed/cmake" -DVulkan_INCLUDE_DIR="$needed/include" -DVulkan_LIBRARY="$vulkan" \
    -DZLIB_INCLUDE_DIR=/usr/x86_64-w64-mingw32/include -DZLIB_LIBRARY=/usr/x86_64-w64-mingw32/lib/libz.a \
    -DZSTD_INCLUDE_DIR="$needed/include" -DZSTD_LIBRARY="$needed/lib/libzstd.a"
[ $# -gt 0 ] || set -- binosplat
cmake --build "$folder" --target "$@"

[ -n "$is_tried" ] || exit 0
wine=$(command -v wine || command -v wine64 || true)
if [ -z "$wine" ]; then
    echo "third_party/windows.sh: built, but not tried: Wine is not installed (apt-get install wine64 wine)"
    exit 0
fi
# A Windows of its own, and nothing that asks for more of it.
tried=$folder/tried
mkdir -p "$tried"
export WINEPREFIX="$tried/wine" WINEDEBUG=-all WINEDLLOVERRIDES=mscoree,mshtml=
run_exe() { (cd "$tried" && "$wine" "$folder/bin/binosplat.exe" "$@"); }
fail() { echo "third_party/windows.sh: under Wine $1" >&2; exit 1; }

rm -f "$tried/one-splat.ply"
run_exe info builtin:fence || fail "info did not end well"
run_exe scene one-splat --out one-splat.ply || fail "scene did not end well"
run_exe info one-splat.ply || fail "info did not read what scene wrote"
status=0
run_exe info nowhere.ply || status=$?
[ "$status" -eq 1 ] || fail "info of a file that is not there ended with $status, not 1"
same="info and scene do what they should"
if [ -x build/release/bin/binosplat ]; then
    build/release/bin/binosplat scene one-splat --out "$tried/linux.ply"
    cmp "$tried/one-splat.ply" "$tried/linux.ply" || fail "scene wrote other bytes than on Linux"
    same="$same, and scene writes the same bytes as on Linux"
fi
echo "third_party/windows.sh: under Wine $same"
