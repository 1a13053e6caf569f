#!/usr/bin/env bash
# Cross-compiles the test programs that do not need POSIX and runs them under Wine, on Mesa's lavapipe:
# `tests/windows/suites.sh [options of ctest]`. tests/CMakeLists.txt says which suites these are;
# BINOSPLAT_JOBS is the number of compilers that run at a time.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
third_party/windows.sh all
# shellcheck source=tests/windows/wine.sh
. tests/windows/wine.sh
ctest --test-dir build/windows --output-on-failure --no-tests=error "$@"
