// The viewer on a headset that takes foveated insets: four pictures a frame, sharp where the wearer looks.
#include "engine/picture/metrics.h"
#include "tests/app/view/view_runs.h"

TEST_SUITE_BEGIN("view_inset");

namespace view_inset_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr std::uint32_t kSize = 256;

// 45 degrees to each side in 256 pixels, and the middle half of them again: as many pixels as in the full picture, at the same places.
const std::string kScript = "rate 20\nsize 256 256\ninset 26.565051177 size 128 128\nframes from 9 to 9 every 1\n";

ViewRun look(const Workplace& work, const std::string& name, const std::string& script, const std::string& keys) {
    std::ofstream(work.path / (name + ".toml")) << keys;
    return runView(work, name, script,
                   fmt::format("builtin:fence --config {}.toml --frames 10 --load-first --hide-panel --hide-hands", name));
}

std::string settingsOf(const std::string& mode, double foveation, bool inset) {
    return fmt::format("[stereo]\nmode = \"{}\"\nfoveation = {}\n[view]\nfoveated-inset = {}\n", mode, foveation, inset);
}

Image partOf(const Image& picture, glm::uvec2 from, glm::uvec2 to) {
    Image part{to - from, picture.channels, {}};
    for (std::uint32_t y = from.y; y < to.y; ++y) {
        const auto channels = static_cast<std::size_t>(picture.channels);
        const auto row = picture.values.begin() + static_cast<std::ptrdiff_t>((std::size_t{y} * picture.size_px.x + from.x) * channels);
        part.values.insert(part.values.end(), row, row + static_cast<std::ptrdiff_t>((to.x - from.x) * channels));
    }
    return part;
}

std::size_t viewsOf(const ViewRun& run, std::size_t frame) { return run.layers(frame, "projection").at(0).at("views").size(); }

}  // namespace

TEST_CASE("with foveation a headset that takes insets has one for each eye, as good as the full picture within") {
    const Workplace work;
    const ViewRun full = look(work, "full", kScript, settingsOf("two-pass", 0.0, true));
    checkClean(full);
    CHECK(viewsOf(full, 9) == 2);
    const ViewRun inset = look(work, "inset", kScript, settingsOf("two-pass", 20.0, true));
    checkClean(inset);
    CHECK(viewsOf(inset, 9) == 4);
    constexpr std::uint32_t kQuarter = kSize / 4;
    for (const int side : {0, 1}) {
        const Image whole = full.eye(9, side), both = inset.eye(9, side);
        const auto psnrOf = [&](glm::uvec2 from, glm::uvec2 to) {
            return compare(partOf(whole, from, to), partOf(both, from, to)).psnrDb();
        };
        CHECK(psnrOf({kQuarter, kQuarter}, {3 * kQuarter, 3 * kQuarter}) >= 40.0);
        CHECK(psnrOf({0, 0}, {kSize, kQuarter}) < 36.0);  // of half the size
    }
}

TEST_CASE("insets go with the foveation that was asked for, and with the runtime") {
    const Workplace work;
    CHECK(viewsOf(look(work, "unwanted", kScript, settingsOf("two-pass", 20.0, false)), 9) == 2);
    const ViewRun without = look(work, "without", kScript + "extension XR_VARJO_quad_views off\n", settingsOf("two-pass", 20.0, true));
    checkClean(without);
    CHECK(viewsOf(without, 9) == 2);
}

TEST_CASE("every method draws insets, and the session after a lost one has them, too") {
    const Workplace work;
    for (const char* mode : {"mono", "predicted", "temporal"}) {
        CAPTURE(mode);
        const ViewRun run = look(work, mode, kScript + "at 0.2 lose-session\n", settingsOf(mode, 20.0, true));
        checkClean(run);
        std::size_t drawn = 0;
        for (std::size_t frame = 0; frame < run.frames.size(); ++frame) { drawn += !run.layers(frame, "projection").empty(); }
        CHECK(drawn > 5);
        for (std::size_t frame = 0; frame < run.frames.size(); ++frame) {
            if (!run.layers(frame, "projection").empty()) { CHECK(viewsOf(run, frame) == 4); }
        }
        CHECK(run.outcome.output.find("another one begins") != std::string::npos);
    }
}

}  // namespace view_inset_test
