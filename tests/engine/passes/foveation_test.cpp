// Facts about foveation: what price counts of an error where it is known where an eye looks, against the twin, and the frames that follow.
#include "engine/picture/metrics.h"
#include "tests/engine/frame/affiliated_frames.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_stages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

TEST_SUITE_BEGIN("foveation");

namespace foveation_test {

using namespace binosplat;
using reference::TileKind;
using test::AffiliatedFrame;
using test::Gpu;
using test::StereoOnDevice;

namespace {

// From where an eye looks to the middle of a tile.
double angleOf(const Eye& eye, std::size_t tile, const Gaze& gaze) {
    const Intrinsics& lens = eye.intrinsics;
    const std::size_t columns = (eye.size_px.x + 15) / 16;
    const glm::dvec2 middle_px = 16.0 * glm::dvec2(tile % columns, tile / columns) + 8.0;
    const glm::dvec3 ray((middle_px.x - lens.cx) / lens.fx, (middle_px.y - lens.cy) / lens.fy, 1.0);
    return std::acos(std::clamp(glm::dot(glm::normalize(ray), glm::normalize(gaze.direction)), -1.0, 1.0));
}

// Tiles and the errors that moving would leave, over nine decades.
struct Errors {
    std::vector<gpu::uint> kinds, errors, costs;

    explicit Errors(std::size_t tiles) {
        std::mt19937 random(11);
        for (std::size_t t = 0; t < tiles; ++t) {
            kinds.push_back(random() % 10 == 0 ? gpu::kTileEdge : 0);
            errors.push_back(random() % 8 == 0 ? 0 : static_cast<gpu::uint>(random()) >> (1 + random() % 28));
            costs.push_back(16 + static_cast<gpu::uint>(random() % 3000));
        }
    }
};

// A room seen by a headset's eyes: the affiliated one in full, and made from the other by predicted errors.
class Room {
public:
    Room(Gpu& gpu, double canting_rad) : Room(gpu, test::viewBuiltin("builtin:atelier", {384, 320}, 40000), canting_rad) {}

    AffiliatedFrame render(const std::optional<Gaze>& gaze, double budget = 0.22) {
        FrameSettings settings;
        settings.stereo.budget = budget;
        settings.gazes[kRight] = gaze;
        return test::makeAffiliated(frame_, eyes, settings);
    }
    // Of the right eye's tiles up to `most_rad` from where it looks.
    double psnrNear(const AffiliatedFrame& made, const Gaze& gaze, double most_rad) const {
        std::vector<std::uint32_t> near;
        for (std::size_t t = 0; t < made.tile_kinds.size(); ++t) { near.push_back(angleOf(eyes[kRight], t, gaze) <= most_rad ? 1 : 0); }
        return compare(test::keepTiles(made.pictures[kRight], near), test::keepTiles(full_, near)).psnrDb();
    }

    std::array<Eye, 2> eyes;

private:
    Room(Gpu& gpu, const test::ViewedScene& view, double canting_rad)
        : eyes(test::headsetEyes(view.eye, canting_rad)), scene_(gpu.context(), view.scene), frame_(gpu.context(), scene_) {
        FrameSettings settings;
        settings.mode = Mode::kShared;
        frame_.render(eyes, settings);
        full_ = frame_.readPicture(kRight);
    }

    GpuScene scene_;
    StereoFrame frame_;
    Image full_;
};

bool isChosen(const AffiliatedFrame& made, std::size_t tile) { return made.tile_kinds[tile] == gpu::kTilePredicted; }

}  // namespace

TEST_CASE_FIXTURE(Gpu, "price counts of an error what the twin's eye sees, wherever it looks") {
    const Eye eye{Pose{}, intrinsicsFromAngles({-0.9, 0.7, 0.8, -0.85}, {531, 777}), {531, 777}};
    gpu::WarpView view{};
    view.size_px = eye.size_px;
    view.size_tiles = tilesOf(eye.size_px);
    const Errors tiles(std::size_t{view.size_tiles.x} * view.size_tiles.y);
    std::vector<double> twin_errors;
    for (const gpu::uint error : tiles.errors) { twin_errors.push_back(error / static_cast<double>(gpu::kErrorSteps)); }
    const std::vector<std::uint64_t> twin_costs(tiles.costs.begin(), tiles.costs.end());
    for (const Gaze& gaze : {Gaze{{0.0, 0.0, 1.0}, 0.0}, Gaze{{0.0, 0.0, 1.0}, 0.3}, Gaze{{-3.0, 1.0, 4.0}, 0.1},
                             Gaze{{1.0, 0.0, 0.0}, 0.0}, Gaze{{0.0, 0.1, -1.0}, 0.0}}) {
        CAPTURE(gaze.direction.x);
        CAPTURE(gaze.clear_rad);
        StereoOnDevice device(*this, view, {}, {});
        device.writeTileKinds(tiles.kinds);
        device.writeTileErrors(tiles.errors);
        device.writeTileCosts(tiles.costs);
        device.price(eye, gaze);
        const std::vector<gpu::uint> prices = device.readTilePrices(), bins = device.readBins();
        const auto shares = reference::findSeenShares(eye, {gaze.direction, gaze.clear_rad});
        const auto expected = reference::price(test::kindsOf(tiles.kinds), twin_errors, twin_costs, shares);
        const auto whole = reference::price(test::kindsOf(tiles.kinds), twin_errors, twin_costs);
        const std::vector<gpu::uint> left = device.readTileErrors();
        std::size_t priced = 0, other_bins = 0, unnoticed = 0, coarse = 0;
        std::vector<gpu::uint> expected_bins(gpu::kPriceBins, 0);
        for (std::size_t t = 0; t < prices.size(); ++t) {
            CHECK((prices[t] != 0) == expected[t].has_value());
            if (whole[t]) { expected_bins[*whole[t]] += tiles.costs[t]; }
            const bool is_coarse = left[t] == gpu::kSeenCoarsely;
            CHECK((is_coarse || left[t] == tiles.errors[t]));
            CHECK((is_coarse == (shares[t] <= 0.25) || std::abs(shares[t] - 0.25) < 1e-4));
            coarse += is_coarse ? 1 : 0;
            unnoticed += tiles.kinds[t] == 0 && tiles.errors[t] != 0 && prices[t] == 0 ? 1 : 0;
            if (prices[t] == 0) { continue; }
            ++priced;
            const int off = static_cast<int>(prices[t] >> 22) - static_cast<int>(expected[t].value_or(0));
            CHECK(std::abs(off) <= 1);
            other_bins += off != 0 ? 1 : 0;
        }
        // Division may be off by a few roundings.
        std::size_t off_bins = 0;
        for (std::size_t b = 0; b < bins.size(); ++b) { off_bins += bins[b] != expected_bins[b] ? 1 : 0; }
        CHECK(off_bins <= 2);
        CHECK(priced > 100);
        CHECK(unnoticed > 100);
        CHECK(coarse > 5);
        CHECK(other_bins <= 3);  // a place that rounds to the next bin
    }
}

TEST_CASE_FIXTURE(
    Gpu, "where it is known where the eye looks fewer tiles are rendered again, none less about that place, and it is as good there") {
    for (const double canting_rad : {0.0, glm::radians(5.0)}) {
        Room room(*this, canting_rad);
        const AffiliatedFrame everywhere = room.render(std::nullopt);
        for (const glm::dvec3 direction : {glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(-0.35, 0.2, 1.0)}) {
            CAPTURE(canting_rad);
            CAPTURE(direction.x);
            const Gaze gaze{direction, glm::radians(10.0)};
            const AffiliatedFrame there = room.render(gaze);
            std::size_t lost_near = 0, gained_far = 0;
            for (std::size_t t = 0; t < there.tile_kinds.size(); ++t) {
                const bool near = angleOf(room.eyes[kRight], t, gaze) <= gaze.clear_rad;
                lost_near += near && isChosen(everywhere, t) && !isChosen(there, t) ? 1 : 0;
                gained_far += !near && isChosen(there, t) && !isChosen(everywhere, t) ? 1 : 0;
            }
            CHECK(lost_near == 0);
            CHECK(gained_far == 0);
            MESSAGE(everywhere.result.counters.named().at("tiles_predicted")
                    << " and " << there.result.counters.named().at("tiles_predicted") << " tiles, "
                    << everywhere.result.counters.named().at("work_patched") << " and " << there.result.counters.named().at("work_patched")
                    << " pairs, " << gained_far << " gained far; " << room.psnrNear(everywhere, gaze, gaze.clear_rad) << " and "
                    << room.psnrNear(there, gaze, gaze.clear_rad) << " dB near, " << room.psnrNear(everywhere, gaze, 4.0) << " and "
                    << room.psnrNear(there, gaze, 4.0) << " dB in all");
            CHECK(there.result.counters.named().at("tiles_predicted") < everywhere.result.counters.named().at("tiles_predicted"));
            CHECK(there.result.counters.named().at("work_patched") < everywhere.result.counters.named().at("work_patched"));
            CHECK(room.psnrNear(there, gaze, gaze.clear_rad) >= room.psnrNear(everywhere, gaze, gaze.clear_rad));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "the device's choice for a gaze is the twin's") {
    auto room = test::viewBuiltin("builtin:atelier", {256, 192}, 20000);
    const auto eyes = test::headsetEyes(room.eye, glm::radians(5.0));
    test::hideWhatMeetsTheNearPlane(room.scene, eyes);
    const GpuScene scene(context(), room.scene);
    StereoFrame frame(context(), scene);
    const test::KeptKernels kept(context(), frame);
    std::size_t chosen = 0, chosen_everywhere = 0, means = 0;
    for (const Side dominant : {kLeft, kRight}) {
        CAPTURE(static_cast<int>(dominant));
        // So few pixels show less than an eye resolves but far from where it looks.
        const Gaze gaze{{dominant == kLeft ? -3.0 : 3.0, 0.5, 1.0}, 0.0};
        reference::StereoSettings twin_settings{.budget = 0.2};
        twin_settings.target_gaze = reference::Gaze{gaze.direction, gaze.clear_rad};
        const auto twin = reference::renderStereo(room.scene, {eyes[dominant], eyes[1 - dominant]}, twin_settings, {});
        FrameSettings settings;
        settings.dominant = dominant;
        settings.stereo = test::settingsOf(twin_settings);
        const AffiliatedFrame everywhere = test::makeAffiliated(frame, eyes, settings);
        settings.gazes[static_cast<std::size_t>(1 - dominant)] = gaze;
        const AffiliatedFrame made = test::makeAffiliated(frame, eyes, settings);
        std::vector<std::uint32_t> same_kind;
        for (std::size_t t = 0; t < twin.tile_kinds.size(); ++t) {
            same_kind.push_back(made.tile_kinds[t] == static_cast<std::uint32_t>(twin.tile_kinds[t]) ? 1 : 0);
        }
        CHECK(std::ranges::count(same_kind, 0u) <= 1);
        // Where the eye does not resolve them, rows are means of their neighbours, in both.
        const Image& picture = made.pictures[static_cast<std::size_t>(1 - dominant)];
        const glm::uvec2 size_px = room.eye.size_px;
        const Image kept_tiles = test::keepTiles(picture, same_kind);
        CHECK(compare(kept_tiles, test::keepTiles(test::toImage(size_px, twin.affiliated), same_kind), 4).psnrDb() >= 80.0);
        const auto valueAt = [&](std::size_t x, std::size_t y) { return static_cast<double>(picture.values[4 * (y * size_px.x + x)]); };
        std::size_t mean_tiles = 0;
        for (std::size_t t = 0; t < twin.tile_kinds.size(); ++t) {
            const std::size_t x = 16 * (t % (size_px.x / 16)), y = 16 * (t / (size_px.x / 16));
            double most = 0.0;
            for (std::size_t i = 0; i < 16 * 7; ++i) {
                const std::size_t column = x + i % 16, row = y + 1 + 2 * (i / 16);
                most = std::max(most, std::abs(2.0 * valueAt(column, row) - valueAt(column, row - 1) - valueAt(column, row + 1)));
            }
            mean_tiles += made.tile_kinds[t] == 0 && most < 1e-6 ? 1 : 0;
        }
        means += mean_tiles;
        chosen += made.result.counters.named().at("tiles_predicted");
        chosen_everywhere += everywhere.result.counters.named().at("tiles_predicted");
        // The dominant eye's gaze says nothing of the affiliated eye's tiles.
        settings.gazes = {};
        settings.gazes[static_cast<std::size_t>(dominant)] = gaze;
        CHECK(test::makeAffiliated(frame, eyes, settings).tile_kinds == everywhere.tile_kinds);
    }
    MESSAGE(chosen << " tiles of " << chosen_everywhere);
    CHECK(chosen > 0);
    CHECK(chosen < chosen_everywhere);
    MESSAGE(means << " tiles of means");
    CHECK(means > 30);  // measured: 51
}

TEST_CASE_FIXTURE(Gpu, "an eye that may look everywhere gets the picture of one of which nothing is known") {
    Room room(*this, 0.0);
    const AffiliatedFrame everywhere = room.render(std::nullopt), clear = room.render(Gaze{{0.0, 0.0, 1.0}, 1.6});
    CHECK(clear.tile_kinds == everywhere.tile_kinds);
    CHECK(clear.pictures[kRight].values == everywhere.pictures[kRight].values);
}

}  // namespace foveation_test
