// Facts that take long, and seldom break: TEST_CASE("..." * nightly()). .ci/nightly checks them, .ci/run leaves them out.
#pragma once

#include <doctest/doctest.h>

namespace binosplat::test {

struct nightly : doctest::skip {};

}  // namespace binosplat::test
