// What memory holds that serves one purpose after another.
#include "engine/gpu/contents.h"
#include "tests/suite.h"

SUITE(contents) {

TEST_CASE("parts over any others take their place there and leave the rest, as a byte-wise account has it") {
    std::mt19937 random(7);
    for (int walk = 0; walk < 50; ++walk) {
        Contents contents;
        std::array<int, 64> bytes{};
        bytes.fill(-1);  // nobody said anything of them
        const auto isContent = [&](std::uint64_t begin, std::uint64_t count, int content) {
            return std::all_of(bytes.begin() + begin, bytes.begin() + begin + count, [&](int byte) { return byte < 0 || byte == content; });
        };
        for (int step = 0; step < 40; ++step) {
            const std::uint64_t begin = random() % 60, count = random() % (64 - begin);
            const int content = static_cast<int>(random() % 3);
            contents.fill(begin, count, static_cast<Content>(content));
            std::fill_n(bytes.begin() + begin, count, content);
            bool is_same = true;
            for (std::uint64_t i = 0; i < bytes.size(); ++i) {
                for (int kind = 0; kind < 3; ++kind) {
                    is_same = is_same && contents.hold(i, 1, static_cast<Content>(kind)) == isContent(i, 1, kind);
                    is_same = is_same && contents.hold(i / 2, i % 32, static_cast<Content>(kind)) == isContent(i / 2, i % 32, kind);
                }
            }
            REQUIRE(is_same);
        }
        contents.forget();
        CHECK(contents.hold(0, 64, Content::kDepthKeys));
    }
}

}  // SUITE(contents)
