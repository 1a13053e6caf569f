#!/usr/bin/env bash
# Makes the program for Windows on Debian, with mingw-w64: installs what is missing, compiles the libraries
# once (third_party/windows/libraries.sh), then build/windows/bin/binosplat.exe with the simulated runtime
# beside it, and packs both: build/windows/binosplat-VERSION-windows-x64.zip.
#   third_party/windows.sh               everything
#   third_party/windows.sh TARGET...     these targets of the build, and no package
# BINOSPLAT_JOBS says how many compilers run at a time. docs/windows.md says what was seen to work.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
jobs=${BINOSPLAT_JOBS:-$(nproc)}
werror=OFF
[[ -z ${CI:-} ]] || werror=ON

third_party/install.sh --windows
third_party/windows/libraries.sh
cmake --preset windows -DCMAKE_UNITY_BUILD=ON -DBINOSPLAT_WERROR="$werror"
if (($# > 0)); then
    cmake --build --preset windows -j "$jobs" --target "$@"
    exit
fi
cmake --build --preset windows -j "$jobs" --target binosplat binosplat_simulated_runtime
(cd build/windows && cpack -G ZIP)
