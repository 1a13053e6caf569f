// Facts about the passes over tiles, 4_project and 5_bin to 7_rasterize, each started from what the twin's pass before it left.
#include "engine/passes/scan.h"
#include "engine/passes/sort.h"
#include "engine/picture/metrics.h"
#include "engine/reference/splat.h"
#include "tests/pass_stages.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <iterator>

using namespace binosplat;
using reference::TilePair;
using test::Gpu;
using test::SceneOnDevice;
using test::TwinStages;
using test::ViewedScene;

namespace {

const reference::Settings kSettings{};

std::vector<ViewedScene> allScenes() {
    return {test::viewBuiltin("builtin:atelier", {256, 256}, 20000), test::viewBuiltin("builtin:fence", {250, 190}),
            test::viewBuiltin("builtin:slanted-wall", {256, 256}), test::viewCloud({200, 150})};
}

bool inOrder(const TilePair& a, const TilePair& b) { return a.splat != b.splat ? a.splat < b.splat : a.tile < b.tile; }

// Passes 4 and 5 from the twin's order: the pairs as 5_bin writes them.
std::vector<TilePair> binOnDevice(Gpu& gpu, const ViewedScene& view, const TwinStages& twin) {
    const SceneOnDevice device(gpu, view.scene, {view.eye}, kSettings.near);
    const test::ProjectedOnDevice projected = test::projectOnDevice(gpu, device, twin.order);
    const Scan scan(gpu.context());
    const Kernel kernel(gpu.context(), "5_bin", sizeof(gpu::BinPass)), large_kernel(gpu.context(), "5_bin_large", sizeof(gpu::BinPass));
    const auto capacity = static_cast<std::uint32_t>(4 * twin.pairs.size() + 1000);
    const Buffer pairs = gpu.allocate<gpu::ListState>("pairs", 1), tiles = gpu.allocate<gpu::uint>("tiles", capacity);
    const Buffer ranks = gpu.allocate<gpu::uint>("ranks", capacity), large = gpu.allocate<gpu::uint>("large splats", capacity),
                 block_sums(gpu.context(), "block sums", Scan::blockSumBytes(projected.count + 1));
    gpu::BinPass pass{};
    pass.splats = projected.splats.address<gpu::ProjectedSplat>();
    pass.tile_sets = projected.tile_sets.address<gpu::uvec2>();
    pass.pair_offsets = projected.tile_counts.address<gpu::uint>();
    pass.visible = projected.list.address<gpu::ListState>();
    pass.pairs = pairs.address<gpu::ListState>();
    pass.tiles = tiles.address<gpu::uint>();
    pass.ranks = ranks.address<gpu::uint>();
    pass.large_splats = large.address<gpu::uint>();
    pass.counters = projected.counters.address<gpu::EyeCounters>();
    pass.size_tiles = (view.eye.size_px + 15u) / 16u;
    gpu.run([&](Commands& commands) {
        scan.overList(commands, pass.pair_offsets, block_sums.address<gpu::uint>(), projected.list, 0, pass.pairs, capacity);
        commands.dispatchIndirect(kernel, pass, projected.list, offsetof(gpu::ListState, per_item));
        commands.dispatch(large_kernel, pass, gpu::kBinLargeGroups);
    });
    const std::uint32_t count = gpu.readBack<gpu::ListState>(pairs, 1)[0].count;
    const auto tile_values = gpu.readBack<gpu::uint>(tiles, count), rank_values = gpu.readBack<gpu::uint>(ranks, count);
    std::vector<TilePair> result(count);
    for (std::size_t i = 0; i < count; ++i) { result[i] = {tile_values[i], rank_values[i]}; }
    return result;
}

// The greatest alpha that a splat has in a tile.
double greatestAlpha(const reference::ProjectedSplat& splat, std::uint32_t tile, glm::uvec2 size_px) {
    const std::uint32_t columns = (size_px.x + 15) / 16;
    const reference::RayPlane plane = reference::rayPlane(splat, size_px, kSettings.near);
    double greatest = 0.0;
    for (std::uint32_t i = 0; i < 256; ++i) {
        const glm::uvec2 pixel(tile % columns * 16 + i % 16, tile / columns * 16 + i / 16);
        reference::Hit hit;
        if (pixel.x >= size_px.x || pixel.y >= size_px.y || !reference::meet(plane, glm::dvec2(pixel) + 0.5, hit)) { continue; }
        greatest = std::max(greatest, splat.opacity * std::exp(-0.5 * hit.rho));
    }
    return greatest;
}

std::vector<glm::uvec2> rangesOnDevice(Gpu& gpu, const std::vector<std::uint32_t>& sorted_tiles, std::size_t tile_count) {
    const Kernel kernel(gpu.context(), "6_tile_ranges", sizeof(gpu::TileRangesPass));
    const Buffer tiles = gpu.upload("tiles", sorted_tiles), pairs = gpu.upload("pairs", std::vector{test::makeList(sorted_tiles.size())});
    const Buffer ranges = gpu.upload("ranges", std::vector(tile_count, glm::uvec2(0)));
    gpu::TileRangesPass pass{};
    pass.tiles = tiles.address<gpu::uint>();
    pass.pairs = pairs.address<gpu::ListState>();
    pass.ranges = ranges.address<gpu::uvec2>();
    gpu.run([&](Commands& commands) { commands.dispatchIndirect(kernel, pass, pairs, offsetof(gpu::ListState, per_item)); });
    return gpu.readBack<glm::uvec2>(ranges, tile_count);
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "4_project and 5_bin make every pair of the twin and few more, front to back") {
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const TwinStages twin(view, kSettings);
        const std::vector<TilePair> pairs = binOnDevice(*this, view, twin);
        // Each once, depth order kept, tiles ascending within a splat; none in no tile.
        CHECK(std::adjacent_find(pairs.begin(), pairs.end(), [](const TilePair& a, const TilePair& b) { return !inOrder(a, b); }) ==
              pairs.end());
        const bool all_in_tiles =
            std::all_of(pairs.begin(), pairs.end(), [&](const TilePair& pair) { return pair.tile < twin.ranges.size(); });
        CHECK(all_in_tiles);
        std::vector<TilePair> missing;
        std::set_difference(twin.pairs.begin(), twin.pairs.end(), pairs.begin(), pairs.end(), std::back_inserter(missing), inOrder);
        // A pair may be missing only where its every pixel is within rounding of the cut.
        CHECK(static_cast<double>(missing.size()) <= 1e-5 * static_cast<double>(twin.pairs.size()));
        for (const TilePair& pair : missing) {
            CHECK(greatestAlpha(twin.splats[pair.splat], pair.tile, view.eye.size_px) <= 1.0001 / 255.0);
        }
        // Discs that reach the eye's plane get every tile of their box, and the cloud is full of them (measured: 1.72).
        CHECK(static_cast<double>(pairs.size()) <= (view.name == "cloud" ? 2.0 : 1.05) * static_cast<double>(twin.pairs.size()));
    }
}

TEST_CASE_FIXTURE(Gpu, "sorting by tile keeps the depth order within each") {
    const ViewedScene view = test::viewBuiltin("builtin:atelier", {256, 256}, 20000);
    const TwinStages twin(view, kSettings);
    const std::size_t count = twin.pairs.size();
    std::vector<std::uint32_t> tiles, ranks;
    for (const TilePair& pair : twin.pairs) {
        tiles.push_back(pair.tile);
        ranks.push_back(pair.splat);
    }
    const Sort sort(context());
    const Buffer keys = upload("tiles", tiles), values = upload("ranks", ranks), list = upload("list", std::vector{test::makeList(count)});
    const Buffer spare_keys = allocate<gpu::uint>("spare tiles", count), spare_values = allocate<gpu::uint>("spare ranks", count);
    const Buffer histograms(context(), "histograms", Sort::histogramBytes(count));
    KeyValues sorted;
    run([&](Commands& commands) {
        // 256 tiles and the one that is none: 9 bits, two rounds.
        sorted =
            sort.record(commands, {keys.address<gpu::uint>(), values.address<gpu::uint>()},
                        {spare_keys.address<gpu::uint>(), spare_values.address<gpu::uint>()}, histograms.address<gpu::uint>(), list, 0, 9);
    });
    REQUIRE(sorted.keys.value == keys.address<gpu::uint>().value);
    tiles = readBack<gpu::uint>(keys, count);
    ranks = readBack<gpu::uint>(values, count);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) { wrong += TilePair{tiles[i], ranks[i]} == twin.sorted_pairs[i] ? 0 : 1; }
    CHECK(wrong == 0);
}

TEST_CASE_FIXTURE(Gpu, "6_tile_ranges finds the twin's ranges, and leaves tiles without pairs at zero") {
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const TwinStages twin(view, kSettings);
        std::vector<std::uint32_t> tiles;
        for (const TilePair& pair : twin.sorted_pairs) { tiles.push_back(pair.tile); }
        const std::vector<glm::uvec2> ranges = rangesOnDevice(*this, tiles, twin.ranges.size());
        std::size_t wrong = 0;
        for (std::size_t t = 0; t < ranges.size(); ++t) {
            const auto [begin, end] = twin.ranges[t];
            wrong += ranges[t] == (begin == end ? glm::uvec2(0) : glm::uvec2(begin, end)) ? 0 : 1;
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "6_tile_ranges reaches pairs beyond the groups of one row of a dispatch") {
    const std::uint32_t count = gpu::kMaxGroupsX * gpu::kGroupSize + 300;
    std::vector<std::uint32_t> tiles(count, 1);
    tiles[count - 1] = 2;
    const std::vector<glm::uvec2> ranges = rangesOnDevice(*this, tiles, 3);
    CHECK(ranges == std::vector{glm::uvec2(0), glm::uvec2(0, count - 1), glm::uvec2(count - 1, count)});
}

TEST_CASE_FIXTURE(Gpu, "7_rasterize blends the twin's splats, pairs and ranges to the twin's picture") {
    const std::uint32_t threads_per_cell = 32;
    const Kernel kernel(
        context(), "7_rasterize", sizeof(gpu::RasterizePass),
        {threads_per_cell, /*depth=*/1, /*stereo_pixels=*/1, /*moments=*/1, /*masked=*/0, gpu::kCellsPerTile * threads_per_cell});
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        reference::Settings settings = kSettings;
        settings.background = {0.2, 0.4, 0.1};
        settings.inverse_depth_moments = true;
        const TwinStages twin(view, settings);
        std::vector<gpu::ProjectedSplat> device_splats;
        for (const reference::ProjectedSplat& splat : twin.splats) { device_splats.push_back(test::toDevice(splat)); }
        std::vector<std::uint32_t> pair_ranks;
        for (const TilePair& pair : twin.sorted_pairs) { pair_ranks.push_back(pair.splat); }
        const std::size_t pixels = std::size_t{view.eye.size_px.x} * view.eye.size_px.y;
        const gpu::EyeView eye_view = test::viewOf(view.eye, settings.near);
        const Buffer eyes = upload("eyes", std::vector{eye_view}), splats = upload("splats", device_splats);
        const Buffer ranks = upload("ranks", pair_ranks), ranges = upload("ranges", twin.ranges);
        const Buffer colours = allocate<glm::vec4>("colours", pixels), depths = allocate<float>("depths", pixels),
                     moments = allocate<gpu::StereoPixel>("moments", pixels);
        gpu::RasterizePass pass{};
        pass.eyes = eyes.address<gpu::EyeView>();
        pass.splats = splats.address<gpu::ProjectedSplat>();
        pass.ranks = ranks.address<gpu::uint>();
        pass.ranges = ranges.address<gpu::uvec2>();
        pass.colours = colours.address<glm::vec4>();
        pass.depths = depths.address<float>();
        pass.moments = moments.address<gpu::StereoPixel>();
        pass.background = settings.background;
        run([&](Commands& commands) { commands.dispatch(kernel, pass, eye_view.size_tiles.x, eye_view.size_tiles.y); });
        const reference::Picture truth = reference::rasterize(twin.splats, twin.sorted_pairs, twin.ranges, view.eye, settings);
        const auto check = [&](const std::string& what, int channels, std::vector<float> values, const Image& expected, double least_db) {
            const Difference difference = compare(Image{view.eye.size_px, channels, std::move(values)}, expected, channels);
            // Depths and moments are not within 0 to 1: relative to the root of their mean square.
            double mean_square = 0.0;
            for (const float value : expected.values) { mean_square += static_cast<double>(value) * static_cast<double>(value); }
            mean_square /= static_cast<double>(expected.values.size());
            const double db = difference.psnrDb() + (channels == 4 ? 0.0 : 10.0 * std::log10(mean_square));
            CAPTURE(what);
            CHECK(difference.not_finite == 0);
            CHECK(db >= least_db);
        };
        // Measured: 85.9, 103 and 107 dB. Colours are half floats here.
        check("colour and alpha", 4, readBack<float>(colours, 4 * pixels), test::toImage(truth), 70.0);
        check("depth", 1, readBack<float>(depths, pixels), test::toImage(truth.size_px, truth.depth), 90.0);
        std::vector<float> moment_values;
        for (const gpu::StereoPixel& pixel : readBack<gpu::StereoPixel>(moments, pixels)) {
            moment_values.insert(moment_values.end(), {pixel.inverse_depth_sum, pixel.inverse_depth_square_sum});
        }
        check("moments", 2, std::move(moment_values), test::toImage(truth.size_px, truth.inverse_depth, truth.inverse_depth_squared), 90.0);
    }
}
