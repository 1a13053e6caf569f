// What memory holds that serves one purpose after another.
#include "engine/gpu/contents.h"

#include <doctest/doctest.h>

#include <array>
#include <random>

namespace contents_test {

using namespace binosplat;

TEST_SUITE_BEGIN("contents");

TEST_CASE("whatever comes to lie over a part takes its place there, and leaves the rest") {
    Contents contents;
    contents.fill(100, 100, Content::kDepthKeys);
    CHECK(contents.hold(100, 100, Content::kDepthKeys));
    CHECK_FALSE(contents.hold(100, 1, Content::kTileCounts));
    CHECK(contents.hold(0, 100, Content::kTileCounts));  // nobody said anything of it
    contents.fill(120, 10, Content::kTileCounts);
    CHECK(contents.hold(100, 20, Content::kDepthKeys));
    CHECK(contents.hold(120, 10, Content::kTileCounts));
    CHECK(contents.hold(130, 70, Content::kDepthKeys));
    CHECK_FALSE(contents.hold(100, 100, Content::kDepthKeys));
    CHECK(contents.hold(125, 0, Content::kDepthKeys));
    contents.forget();
    CHECK(contents.hold(120, 10, Content::kDepthKeys));
}

TEST_CASE("any parts over any others end as a byte-wise account has it") {
    std::mt19937 random(7);
    for (int walk = 0; walk < 50; ++walk) {
        Contents contents;
        std::array<int, 64> bytes{};
        bytes.fill(-1);
        for (int step = 0; step < 40; ++step) {
            const std::uint64_t begin = random() % 60, count = random() % (64 - begin);
            const auto content = static_cast<Content>(random() % 3);
            contents.fill(begin, count, content);
            for (std::uint64_t i = begin; i < begin + count; ++i) { bytes[i] = static_cast<int>(content); }
            for (std::uint64_t i = 0; i < bytes.size(); ++i) {
                for (int kind = 0; kind < 3; ++kind) {
                    REQUIRE(contents.hold(i, 1, static_cast<Content>(kind)) == (bytes[i] < 0 || bytes[i] == kind));
                }
            }
        }
    }
}

TEST_SUITE_END();

}  // namespace contents_test
