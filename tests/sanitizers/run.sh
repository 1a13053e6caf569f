#!/usr/bin/env bash
# Tests on a device under the address and undefined-behaviour sanitizers; .ci/run has those that need none. By hand, since it takes several
# minutes: tests/sanitizers/run.sh [ROOM...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
(($# > 0)) || set -- layout scan sort present passes simulated_session view_trouble read_ahead changing_file

cmake --preset sanitize
targets=(binosplat_keep_libraries)
for room in "$@"; do targets+=("${room}_test"); done
cmake --build build/sanitize --target "${targets[@]}"
# Drivers are not sanitized and keep some memory to the end: they stay loaded, so that suppressions know them by their names.
preload=$(readlink -f "$(c++ -print-file-name=libasan.so)"):$PWD/build/sanitize/bin/libbinosplat_keep_libraries.so
export LSAN_OPTIONS=suppressions=$PWD/tests/sanitizers/leaks.supp:print_suppressions=0
for room in "$@"; do
    echo "sanitize: $room"
    LD_PRELOAD=$preload timeout 600 "build/sanitize/bin/${room}_test"
done
