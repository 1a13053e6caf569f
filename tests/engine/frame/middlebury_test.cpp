// Real stereo pairs with true disparity through the reprojection alone: teddy and cones (Scharstein and Szeliski 2003).
#include "engine/picture/image_io.h"
#include "engine/picture/metrics.h"
#include "tests/engine/passes/stereo_stages.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

TEST_SUITE_BEGIN("middlebury");

namespace middlebury_test {

using namespace binosplat;
using test::Gpu;

namespace {

struct StereoPair {
    Image left, right;
    std::vector<double> left_disparity_px;  // 0: unknown
};

StereoPair loadPair(const std::filesystem::path& folder) {
    StereoPair pair{readPicture(folder / "im2.png"), readPicture(folder / "im6.png"), {}};
    const Image disparity = readPicture(folder / "disp2.pgm");
    for (std::size_t i = 0; i < disparity.pixelCount(); ++i) {
        pair.left_disparity_px.push_back(static_cast<double>(disparity.values[i * static_cast<std::size_t>(disparity.channels)]) * 255.0 /
                                         4.0);
    }
    return pair;
}

// Eyes side by side with fx b = 1 px, so that the inverse depth is the disparity in pixels.
gpu::WarpView makeView(glm::uvec2 size_px, gpu::uint gap_px) {
    gpu::WarpView view{};
    view.rows_apart = 1;
    view.target_from_source.shift = {-1.0f, 0.0f, 0.0f};
    view.source_from_target.shift = {1.0f, 0.0f, 0.0f};
    view.size_px = size_px;
    view.size_tiles = tilesOf(size_px);
    view.gap_px = gap_px;
    return view;
}

struct Reprojected {
    Image picture;
    std::vector<std::uint8_t> classes;
};

Reprojected reprojectLeft(Gpu& gpu, const StereoPair& pair, gpu::uint gap_px) {
    const auto channels = static_cast<std::size_t>(pair.left.channels);
    std::vector<gpu::vec4> colours;
    std::vector<gpu::uint> moving;
    for (std::size_t i = 0; i < pair.left.pixelCount(); ++i) {
        const float* rgb = &pair.left.values[i * channels];
        colours.emplace_back(rgb[0], rgb[1], rgb[2], 1.0f);
        // A pixel whose disparity is not known goes nowhere.
        const double disparity = pair.left_disparity_px[i];
        moving.push_back(disparity > 0.0 ? test::packMoving(disparity, /*landed=*/true, /*spread=*/0) : 0);
    }
    test::StereoOnDevice device(gpu, makeView(pair.left.size_px, gap_px), colours, moving, test::Rows::kShared);
    device.reproject();
    device.resample({.classes = true});
    Reprojected result{{pair.left.size_px, 4, {}}, device.readClasses()};
    for (const gpu::vec4& value : device.readAffiliated()) {
        result.picture.values.insert(result.picture.values.end(), {value.x, value.y, value.z, value.w});
    }
    return result;
}

struct Verdict {
    double coverage, psnr_db;  // over the covered pixels
    double psnr_everywhere_db;
    std::size_t not_finite;
};

Verdict judge(const Reprojected& reprojected, const Image& truth) {
    const auto channels = static_cast<std::size_t>(truth.channels);
    double covered = 0.0, square = 0.0, square_everywhere = 0.0;
    std::size_t not_finite = 0;
    for (std::size_t i = 0; i < truth.pixelCount(); ++i) {
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const double difference = static_cast<double>(reprojected.picture.values[4 * i + channel]) -
                                      static_cast<double>(truth.values[i * channels + channel]);
            not_finite += std::isfinite(difference) ? 0 : 1;
            square_everywhere += difference * difference;
            if (reprojected.classes[i] == gpu::kCovered) { square += difference * difference; }
        }
        covered += reprojected.classes[i] == gpu::kCovered ? 1.0 : 0.0;
    }
    const auto pixels = static_cast<double>(truth.pixelCount());
    return {covered / pixels, -10.0 * std::log10(square / (3.0 * covered)), -10.0 * std::log10(square_everywhere / (3.0 * pixels)),
            not_finite};
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "a real left picture moved by its true disparity is the right one, better than by whole pixels" *
                           test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    // Moving to the nearest pixel gives 27.8 dB (teddy) and 26.7 dB (cones) on 77 % of the pixels.
    struct Case {
        std::string name;
        double psnr_db;
    };
    for (const Case& known : {Case{"teddy", 28.3}, Case{"cones", 27.2}}) {
        CAPTURE(known.name);
        const StereoPair pair = loadPair(*data / "middlebury" / known.name);
        REQUIRE(pair.left.size_px == glm::uvec2(450, 375));
        const Verdict landed = judge(reprojectLeft(*this, pair, 0), pair.right);
        const Verdict filled = judge(reprojectLeft(*this, pair, 2), pair.right);
        MESSAGE(known.name << ": " << landed.psnr_db << " dB on " << 100.0 * landed.coverage << " %, everywhere "
                           << landed.psnr_everywhere_db << " dB; with gaps of 2 px: " << filled.psnr_db << " dB on "
                           << 100.0 * filled.coverage << " %, everywhere " << filled.psnr_everywhere_db << " dB");
        for (const Verdict& verdict : {landed, filled}) {
            CHECK(verdict.psnr_db >= known.psnr_db);
            CHECK(verdict.coverage >= 0.77);
            CHECK(verdict.not_finite == 0);
        }
        CHECK(filled.psnr_everywhere_db >= landed.psnr_everywhere_db);
    }
}

TEST_CASE_FIXTURE(Gpu, "a real picture that is infinitely far keeps its bytes, and one moved the wrong way is no likeness" *
                           test::needsSharedData()) {
    const auto data = test::sharedData();
    if (!data) { return; }
    StereoPair pair = loadPair(*data / "middlebury" / "teddy");
    CHECK(judge(reprojectLeft(*this, pair, 0), pair.left).psnr_db < 15.0);
    std::swap(pair.left, pair.right);
    CHECK(judge(reprojectLeft(*this, pair, 0), pair.left).psnr_db < 15.0);
    // Any disparity below half of a float32's last place in the column: nothing moves.
    std::fill(pair.left_disparity_px.begin(), pair.left_disparity_px.end(), 1e-30);
    const Verdict still = judge(reprojectLeft(*this, pair, 2), pair.left);
    CHECK(still.coverage == 1.0);
    CHECK(still.psnr_everywhere_db == std::numeric_limits<double>::infinity());
}

}  // namespace middlebury_test
