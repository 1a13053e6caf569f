#!/usr/bin/env bash
# Compiles what Debian has for Linux only, from Debian's source packages, into build/windows-prefix/installed:
# static libraries for mingw-w64, and FriBidi, whose licence wants it to be replaceable, as a DLL.
# A library that is there in the same version, made by the same recipe and compiler, is left alone.
#   third_party/windows/libraries.sh          those of the program
#   third_party/windows/libraries.sh hello    and hello_xr.exe, which tests the simulated runtime
# What is installed beside third_party/install.sh: third_party/windows.sh says it.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
prefix=$here/../../build/windows-prefix
mkdir -p "$prefix"
prefix=$(cd "$prefix" && pwd)
installed=$prefix/installed
sources=$prefix/sources
host=x86_64-w64-mingw32
log=$prefix/log
jobs=${BINOSPLAT_JOBS:-$(nproc)}
mkdir -p "$installed"/{include,lib/cmake,lib/pkgconfig,licences,stamps} "$sources/lists/partial"
: >"$log"
trap 'status=$?; [ $status -eq 0 ] || { tail -n 20 "$log"; echo "third_party/windows/libraries.sh: failed; all of it is in $log"; } >&2' EXIT

apt() { # of source packages alone, and with lists of its own
    local program=$1
    shift
    "$program" -q -o Dir::Etc::SourceList="$sources/sources.list" -o Dir::Etc::SourceParts=/dev/null -o Dir::State::Lists="$sources/lists" \
        -o APT::Sandbox::User="$(id -un)" -o Dir::Cache::pkgcache= -o Dir::Cache::srcpkgcache= "$@"
}

# The source package NAME with Debian's patches in $sources/NAME. apt compares it with the checksums that
# Debian has signed.
are_lists_new=
fetch() {
    local name=$1
    if [ -z "$are_lists_new" ]; then
        # shellcheck source=/dev/null
        . /etc/os-release
        local key=/usr/share/keyrings/debian-archive-keyring.gpg
        printf 'deb-src [signed-by=%s] http://deb.debian.org/%s main\n' "$key" "debian $VERSION_CODENAME" \
            "$key" "debian-security $VERSION_CODENAME-security" >"$sources/sources.list"
        apt apt-get update >>"$log" 2>&1
        are_lists_new=yes
    fi
    rm -rf "${sources:?}/$name" "$sources/unpacked"
    mkdir "$sources/unpacked"
    # The newest; a mirror may lack the package of a correction that its list names, and has the one before.
    (cd "$sources/unpacked" && { apt apt-get source "$name" || apt apt-get source -t "$VERSION_CODENAME" "$name"; }) >>"$log" 2>&1
    mv "$(find "$sources/unpacked" -mindepth 1 -maxdepth 1 -type d)" "$sources/$name"
    mkdir -p "$installed/licences/$name"
    cp "$sources/$name/debian/copyright" "$installed/licences/$name/"
    # The LGPL wants the source of a library to come with it: the archives that it was compiled from, with
    # Debian's patches.
    if [ "$name" = fribidi ]; then
        rm -rf "$installed/licences/$name/source"
        mkdir "$installed/licences/$name/source"
        find "$sources/unpacked" -mindepth 1 -maxdepth 1 -type f -exec cp {} "$installed/licences/$name/source/" \;
    fi
    rm -rf "$sources/unpacked"
}

with_cmake() { # NAME OPTIONS...: configures, compiles and installs
    local name=$1 build=$prefix/build/$1
    shift
    rm -rf "$build"
    cmake -S "$sources/$name" -B "$build" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$here/toolchain.cmake" -DCMAKE_BUILD_TYPE=Release \
        -DCMAKE_INSTALL_PREFIX="$installed" -DCMAKE_INSTALL_LIBDIR=lib -DBUILD_SHARED_LIBS=OFF "$@" >>"$log" 2>&1
    cmake --build "$build" -j "$jobs" >>"$log" 2>&1
    cmake --install "$build" >>"$log" 2>&1
}

describe() { # NAME FLAGS: a .pc file
    printf 'Name: %s\nDescription: %s\nVersion: 1\nCflags: -I%s/include %s\nLibs: -L%s/lib %s\n' "$1" "$1" "$installed" "$2" "$installed" "$3" \
        >"$installed/lib/pkgconfig/$1.pc"
}

# A library that is headers alone, Debian's: /usr/include itself holds those of another C library.
headers() { # PACKAGE TARGET FILES... [-- PROPERTIES]
    local package=$1 target=$2
    shift 2
    local folder=$installed/lib/cmake/$package
    while [ $# -gt 0 ] && [ "$1" != -- ]; do
        rm -rf "${installed:?}/include/$1"
        mkdir -p "$(dirname "$installed/include/$1")"
        cp -RLp "/usr/include/$1" "$installed/include/$1"
        shift
    done
    [ $# -eq 0 ] || shift
    mkdir -p "$folder"
    cat >"$folder/${package}Config.cmake" <<CONFIG
if(NOT TARGET $target)
    add_library($target INTERFACE IMPORTED)
    set_target_properties($target PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "\${CMAKE_CURRENT_LIST_DIR}/../../../include" $*)
endif()
CONFIG
}
add_headers() {
    headers glm glm::glm glm
    headers fmt fmt::fmt-header-only fmt -- INTERFACE_COMPILE_DEFINITIONS FMT_HEADER_ONLY=1
    headers CLI11 CLI11::CLI11 CLI
    headers nlohmann_json nlohmann_json::nlohmann_json nlohmann
    headers tomlplusplus tomlplusplus::tomlplusplus toml++
    headers doctest doctest::doctest doctest
    rm -rf "$installed/include/vulkan" "$installed/include/vk_video"
    cp -RLp /usr/include/vulkan /usr/include/vk_video "$installed/include"
    for package in libglm-dev libfmt-dev libcli11-dev nlohmann-json3-dev libtomlplusplus-dev libvulkan-dev libz-mingw-w64-dev \
        mingw-w64-x86-64-dev g++-mingw-w64-x86-64-posix; do
        mkdir -p "$installed/licences/$package"
        cp "/usr/share/doc/$package/copyright" "$installed/licences/$package/"
    done
    # Some of the licences refer to these.
    cp -L /usr/share/common-licenses/{Apache-2.0,GPL-2,GPL-3,LGPL-2.1} "$installed/licences"
    # Nothing of Vulkan is linked: the program loads vulkan-1.dll when it needs it. CMake wants a file
    # nevertheless.
    rm -f "$installed/lib/libvulkan-1.a"
    $host-ar rcs "$installed/lib/libvulkan-1.a"
}

make_libzstd() {
    mkdir -p "$prefix/build/libzstd"
    local file
    for file in "$sources"/libzstd/lib/{common,compress,decompress}/*.c; do
        $host-gcc-posix -O2 -DZSTD_DISABLE_ASM=1 -c "$file" -o "$prefix/build/libzstd/$(basename "$file" .c).o"
    done
    rm -f "$installed/lib/libzstd.a"
    $host-ar rcs "$installed/lib/libzstd.a" "$prefix"/build/libzstd/*.o
    cp "$sources"/libzstd/lib/{zstd,zstd_errors}.h "$installed/include"
}
make_libpng1.6() { with_cmake libpng1.6 -DPNG_SHARED=OFF -DPNG_TESTS=OFF; }
make_libwebp() {
    local tool options=()
    for tool in ANIM_UTILS CWEBP DWEBP GIF2WEBP IMG2WEBP VWEBP WEBPINFO WEBPMUX EXTRAS; do options+=("-DWEBP_BUILD_$tool=OFF"); done
    with_cmake libwebp "${options[@]}"
    describe libwebp "" -lwebp
}
make_libzip() {
    local part options=()
    for part in ENABLE_COMMONCRYPTO ENABLE_GNUTLS ENABLE_MBEDTLS ENABLE_OPENSSL ENABLE_WINDOWS_CRYPTO ENABLE_BZIP2 ENABLE_LZMA ENABLE_ZSTD \
        BUILD_TOOLS BUILD_REGRESS BUILD_EXAMPLES BUILD_DOC; do
        options+=("-D$part=OFF")
    done
    with_cmake libzip "${options[@]}"
    describe libzip -DZIP_STATIC -lzip
}
make_imath() { with_cmake imath -DBUILD_TESTING=OFF; }
make_openexr() { with_cmake openexr -DBUILD_TESTING=OFF -DOPENEXR_BUILD_TOOLS=OFF -DOPENEXR_INSTALL_EXAMPLES=OFF -DOPENEXR_FORCE_INTERNAL_IMATH=OFF; }
make_fribidi() {
    (
        cd "$sources/fribidi"
        ./configure --host=$host --prefix="$installed" --enable-shared --disable-static CC=$host-gcc-posix LDFLAGS=-static-libgcc
        make -C lib -j "$jobs" install
    ) >>"$log" 2>&1
    # Renamed, since this name is looked for when everything else is static.
    mv "$installed/lib/libfribidi.dll.a" "$installed/lib/libfribidi.a"
    describe fribidi "-I$installed/include/fribidi" -lfribidi
}
make_imgui() {
    local file
    mkdir -p "$prefix/build/imgui" "$installed/include/imgui/backends"
    for file in "$sources"/imgui/imgui{,_draw,_tables,_widgets}.cpp "$sources/imgui/backends/imgui_impl_vulkan.cpp"; do
        # Vulkan's functions are those that the program hands over.
        $host-g++-posix -O2 -std=c++17 -DIMGUI_IMPL_VULKAN_NO_PROTOTYPES -I"$sources/imgui" -I"$installed/include" -c "$file" \
            -o "$prefix/build/imgui/$(basename "$file" .cpp).o"
    done
    rm -f "$installed/lib/libimgui.a"
    $host-ar rcs "$installed/lib/libimgui.a" "$prefix"/build/imgui/*.o
    cp "$sources"/imgui/*.h "$installed/include/imgui"
    cp "$sources/imgui/backends/imgui_impl_vulkan.h" "$installed/include/imgui/backends"
    describe imgui "-I$installed/include/imgui -DIMGUI_IMPL_VULKAN_NO_PROTOTYPES" "-limgui -limm32"
}
make_glfw3() { with_cmake glfw3 -DGLFW_BUILD_EXAMPLES=OFF -DGLFW_BUILD_TESTS=OFF -DGLFW_BUILD_DOCS=OFF; }
make_openxr-sdk-source() {
    # Debian leaves out the copy of JsonCpp that the loader is compiled with.
    fetch libjsoncpp
    mkdir -p "$sources/openxr-sdk-source/src/external"
    ln -sfn "$sources/libjsoncpp" "$sources/openxr-sdk-source/src/external/jsoncpp"
    with_cmake openxr-sdk-source -DBUILD_TESTS=OFF -DBUILD_WITH_SYSTEM_JSONCPP=OFF -DBUILD_API_LAYERS=OFF -DBUILD_CONFORMANCE_TESTS=OFF -DDYNAMIC_LOADER=OFF -DBUILD_LOADER=ON
}
# Only Vulkan: mingw-w64 lacks headers of Direct3D that it wants.
make_hello_xr() {
    local build=$prefix/build/hello_xr source=$sources/openxr-sdk-source/src file
    mkdir -p "$build" "$installed/bin"
    {
        printf 'LIBRARY vulkan-1.dll\nEXPORTS\n'
        grep -ohP 'VKAPI_CALL \Kvk\w+(?=\()' "$installed"/include/vulkan/vulkan_{core,win32}.h | sort -u
    } >"$build/vulkan-1.def"
    $host-dlltool -d "$build/vulkan-1.def" -l "$build/libvulkan-1.dll.a"
    local files=()
    for file in main openxr_program logger platformplugin_{factory,win32} graphicsplugin_{factory,vulkan}; do files+=("$source/tests/hello_xr/$file.cpp"); done
    $host-g++-posix -O1 -std=c++17 -static -s -DXR_OS_WINDOWS -DXR_USE_PLATFORM_WIN32 -DXR_USE_GRAPHICS_API_VULKAN -DMISSING_DIRECTX_COLORS \
        -I"$source" -I"$source/common" -I"$source/tests/hello_xr/vulkan_shaders" -I"$installed/include" "${files[@]}" -L"$installed/lib" -lopenxr_loader \
        "$build/libvulkan-1.dll.a" -lole32 -lshlwapi -o "$installed/bin/hello_xr.exe" >>"$log" 2>&1
}

recipe=$(sha256sum "${BASH_SOURCE[0]}" "$here/toolchain.cmake" | cut -d' ' -f1 | tr '\n' ' '; $host-g++-posix -dumpfullversion)
libraries=(headers libzstd libpng1.6 libwebp libzip imath openexr fribidi imgui glfw3 openxr-sdk-source)
[ "${1:-}" != hello ] || libraries+=(hello_xr)
for library in "${libraries[@]}"; do
    stamp=$installed/stamps/$library
    if [ -f "$stamp" ] && [ "$(cat "$stamp")" = "$recipe" ]; then continue; fi
    echo "third_party/windows/libraries.sh: $library"
    if [ "$library" = headers ]; then
        add_headers
    elif [ "$library" = hello_xr ]; then
        [ -d "$sources/openxr-sdk-source" ] || fetch openxr-sdk-source
        make_hello_xr
    else
        fetch "$library"
        rm -rf "${prefix:?}/build/$library"
        "make_$library"
    fi
    echo "$recipe" >"$stamp"
done
