// SUITE(name) { facts }: the facts of NAME_test.cpp, which are a line of ctest. Within, all of binosplat and of binosplat::test is seen.
#pragma once

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <vector>

#define SUITE(name)          \
    TEST_SUITE_BEGIN(#name); \
    namespace binosplat::test::name##_suite

namespace binosplat::test {

// Facts that take long, and seldom break: TEST_CASE("..." * nightly()). .ci/nightly checks them, .ci/run leaves them out.
struct nightly : doctest::skip {};

}  // namespace binosplat::test
