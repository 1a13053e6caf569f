// Facts about the passes over tiles, project and bin to rasterize, each started from what the twin's pass before it left.
#include "engine/passes/sort.h"
#include "engine/picture/metrics.h"
#include "engine/reference/splat.h"
#include "tests/engine/passes/pass_stages.h"
#include "tests/engine/passes/stereo_cases.h"

#include <doctest/doctest.h>
#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <iterator>
#include <random>

TEST_SUITE_BEGIN("tile_passes");

namespace tile_passes_test {

using namespace binosplat;
using reference::TilePair;
using test::Gpu;
using test::SceneOnDevice;
using test::TwinStages;
using test::ViewedScene;

namespace {

const reference::Settings kSettings{};

std::vector<ViewedScene> allScenes() {
    return {test::viewBuiltin("builtin:atelier", {256, 256}, 20000),
            test::viewBuiltin("builtin:fence", {250, 190}),
            test::viewBuiltin("builtin:slanted-wall", {256, 256}),
            test::viewCloud({200, 150}),
            test::viewGaussians({200, 150}, false),
            test::viewGaussians({200, 150}, true)};
}

bool inOrder(const TilePair& a, const TilePair& b) { return a.splat != b.splat ? a.splat < b.splat : a.tile < b.tile; }

// project and bin from the twin's order: the pairs as bin writes them; those in the tiles of a mask alone, if there is one.
std::vector<TilePair> binOnDevice(Gpu& gpu, const ViewedScene& view, const TwinStages& twin, const std::vector<gpu::uint>& mask = {}) {
    const SceneOnDevice device(gpu, view.scene, {view.eye}, kSettings.near);
    const Buffer mask_buffer = gpu.upload("tile mask", mask);
    const auto tile_mask = mask.empty() ? gpu::DeviceAddress<gpu::uint>{} : mask_buffer.address<gpu::uint>();
    const std::uint32_t masked = mask.empty() ? 0 : 1;
    const Kernel& kernel = gpu.kernel(BinKernel{});
    const Kernel& large_kernel = gpu.kernel(BinLargeKernel{.masked = masked, .splat_kind = device.scene.splatShape()});
    const auto capacity = static_cast<std::uint32_t>(4 * twin.pairs.size() + 1000);
    const test::ProjectedOnDevice projected = test::projectOnDevice(gpu, device, twin.order, capacity, tile_mask);
    const Buffer tiles = gpu.allocate<gpu::uint>("tiles", capacity), ranks = gpu.allocate<gpu::uint>("ranks", capacity);
    const Buffer large = gpu.allocate<gpu::uint>("large splats", capacity), begins = gpu.allocate<gpu::uint>("large begins", capacity);
    gpu::BinPass pass{};
    pass.splats = projected.splats.address<gpu::ProjectedSplat>();
    pass.tile_sets = projected.tile_sets.address<gpu::uvec2>();
    pass.tile_counts = projected.tile_counts.address<gpu::uint>();
    pass.group_sums = projected.group_sums.address<gpu::uint>();
    pass.visible = projected.list.address<gpu::ListState>();
    pass.pairs = projected.pairs.address<gpu::ListState>();
    pass.tiles = tiles.address<gpu::uint>();
    pass.ranks = ranks.address<gpu::uint>();
    pass.large_splats = large.address<gpu::uint>();
    pass.large_begins = begins.address<gpu::uint>();
    pass.counters = projected.counters.address<gpu::EyeCounters>();
    pass.tile_mask = tile_mask;
    pass.size_tiles = (view.eye.size_px + 15u) / 16u;
    pass.low_pass = viewOf(view.eye, 0.2).low_pass;
    gpu.run([&](Commands& commands) {
        commands.dispatchIndirect(kernel, pass, projected.list, offsetof(gpu::ListState, per_block));
        commands.dispatch(large_kernel, pass, gpu::kBinLargeGroups);
    });
    const std::uint32_t count = gpu.readBack<gpu::ListState>(projected.pairs, 1)[0].count;
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

std::vector<glm::uvec2> rangesOnDevice(Gpu& gpu, const std::vector<std::uint32_t>& sorted_tiles, glm::uvec2 size_px) {
    const Kernel& kernel = gpu.kernel(TileRangesKernel{});
    const Buffer tiles = gpu.upload("tiles", sorted_tiles), pairs = gpu.upload("pairs", std::vector{test::makeList(sorted_tiles.size())});
    const glm::uvec2 size_tiles = (size_px + 15u) / 16u;
    const std::size_t tile_count = std::size_t{size_tiles.x} * size_tiles.y;
    const Buffer ranges = gpu.upload("ranges", std::vector(tile_count, glm::uvec2(7)));
    gpu::TileRangesPass pass{};
    pass.tiles = tiles.address<gpu::uint>();
    pass.pairs = pairs.address<gpu::ListState>();
    pass.ranges = ranges.address<gpu::uvec2>();
    pass.size_px = size_px;
    gpu.run([&](Commands& commands) { commands.dispatchOver(kernel, pass, tile_count); });
    return gpu.readBack<glm::uvec2>(ranges, tile_count);
}

// tile_ranges under a mask, on pictures that hold 7 everywhere before.
struct MaskedRanges {
    std::vector<glm::uvec2> ranges;
    std::vector<std::uint32_t> full;  // ascending
    glm::uvec3 groups;                // of rasterize
    std::vector<glm::vec4> colours;   // unpacked, where they are half floats
    std::vector<float> depths;
    std::uint32_t groups_done;  // of the list of pairs, afterwards
};
MaskedRanges maskedRangesOnDevice(Gpu& gpu, const std::vector<std::uint32_t>& sorted_tiles, const std::vector<std::uint32_t>& listed,
                                  glm::uvec2 size_px, glm::vec3 background, bool half_floats) {
    const Kernel& kernel = gpu.kernel(TileRangesKernel{.masked = 1, .half_colours = half_floats});
    const std::size_t pixels = std::size_t{size_px.x} * size_px.y;
    const glm::uvec2 size_tiles = (size_px + 15u) / 16u;
    const std::size_t tile_count = std::size_t{size_tiles.x} * size_tiles.y;
    const Buffer tiles = gpu.upload("tiles", sorted_tiles), pairs = gpu.upload("pairs", std::vector{test::makeList(sorted_tiles.size())});
    const Buffer list = gpu.upload("tile list", listed), masked = gpu.upload("masked tiles", std::vector{test::makeList(listed.size())});
    const Buffer ranges = gpu.upload("ranges", std::vector(tile_count, glm::uvec2(7)));
    const Buffer full = gpu.upload("full tiles", std::vector<gpu::uint>(tile_count, 7));
    const Buffer counters = gpu.upload("counters", std::vector{gpu::EyeCounters{}});
    const Buffer colours = half_floats ? gpu.upload("colours", std::vector(pixels, glm::uvec2(0x47004700u)))
                                       : gpu.upload("colours", std::vector(pixels, glm::vec4(7.0f)));
    const Buffer depths = gpu.upload("depths", std::vector(pixels, 7.0f));
    gpu::TileRangesPass pass{};
    pass.tiles = tiles.address<gpu::uint>();
    pass.pairs = pairs.address<gpu::ListState>();
    pass.ranges = ranges.address<gpu::uvec2>();
    pass.tile_list = list.address<gpu::uint>();
    pass.masked_tiles = masked.address<gpu::ListState>();
    pass.full_tiles = full.address<gpu::uint>();
    pass.counters = counters.address<gpu::EyeCounters>();
    pass.colours = colours.address<gpu::vec4>();
    pass.half_colours = colours.address<gpu::uvec2>();
    pass.depths = depths.address<float>();
    pass.background = background;
    pass.size_px = size_px;
    gpu.run([&](Commands& commands) { commands.dispatchIndirect(kernel, pass, masked, offsetof(gpu::ListState, per_item)); });
    const gpu::EyeCounters counted = gpu.readBack<gpu::EyeCounters>(counters, 1)[0];
    MaskedRanges result{.ranges = gpu.readBack<glm::uvec2>(ranges, tile_count),
                        .full = gpu.readBack<gpu::uint>(full, tile_count),
                        .groups = {counted.per_full_tile.x, counted.per_full_tile.y, counted.per_full_tile.z},
                        .colours = {},
                        .depths = gpu.readBack<float>(depths, pixels),
                        .groups_done = gpu.readBack<gpu::ListState>(pairs, 1)[0].groups_done};
    result.full.resize(counted.full_tiles);
    std::ranges::sort(result.full);
    if (!half_floats) {
        result.colours = gpu.readBack<glm::vec4>(colours, pixels);
    } else {
        for (const glm::uvec2 words : gpu.readBack<glm::uvec2>(colours, pixels)) {
            result.colours.emplace_back(glm::unpackHalf2x16(words.x), glm::unpackHalf2x16(words.y));
        }
    }
    return result;
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "project and bin make every pair of the twin and few more, front to back") {
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

TEST_CASE_FIXTURE(Gpu, "under a mask project and bin make the same pairs but for the tiles outside, whatever the mask") {
    std::mt19937 random(1);
    // More columns of tiles than a word of the mask has bits, a scene of which many splats have large boxes, and boxes of all widths.
    std::vector<test::Splat> wide_splats;
    for (int i = 0; i < 400; ++i) {
        const auto draw = [&] { return static_cast<float>(random() % 10000) / 10000.0f; };
        wide_splats.push_back({{12.0f * draw() - 6.0f, 0.4f * draw() - 0.2f, 1.0f}, {1, 0, 0, 0}, {0.05f + 1.5f * draw(), 0.02f}});
    }
    const ViewedScene wide{"wide", test::makeScene(wide_splats), test::makeEye({1100, 40})};
    for (const ViewedScene& view : {test::viewBuiltin("builtin:atelier", {1100, 40}, 20000), test::viewCloud({530, 130}), wide}) {
        CAPTURE(view.name);
        const TwinStages twin(view, kSettings);
        const std::vector<TilePair> all = binOnDevice(*this, view, twin);
        const glm::uvec2 size_tiles = (view.eye.size_px + 15u) / 16u;
        std::vector<std::vector<std::uint8_t>> masks(5, std::vector<std::uint8_t>(std::size_t{size_tiles.x} * size_tiles.y, 0));
        for (std::size_t t = 0; t < masks[0].size(); ++t) {
            masks[1][t] = 1;
            masks[2][t] = random() % 2 == 0 ? 1 : 0;
            masks[3][t] = random() % 10 == 0 ? 1 : 0;
            masks[4][t] = t % size_tiles.x / 8 % 2 == 1 ? 1 : 0;
        }
        for (const auto& mask : masks) {
            std::vector<TilePair> expected = all;
            std::erase_if(expected, [&](const TilePair& pair) { return mask[pair.tile] == 0; });
            CHECK(binOnDevice(*this, view, twin, test::maskOf(mask, size_tiles)) == expected);
        }
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
        // 256 tiles and one number more for no tile: 9 bits, two rounds.
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

TEST_CASE_FIXTURE(Gpu, "tile_ranges finds the twin's ranges, and tiles without pairs have empty ones") {
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const TwinStages twin(view, kSettings);
        std::vector<std::uint32_t> tiles;
        for (const TilePair& pair : twin.sorted_pairs) { tiles.push_back(pair.tile); }
        const std::vector<glm::uvec2> ranges = rangesOnDevice(*this, tiles, view.eye.size_px);
        std::size_t wrong = 0;
        for (std::size_t t = 0; t < ranges.size(); ++t) {
            const auto [begin, end] = twin.ranges[t];
            wrong += begin == end ? ranges[t].x != ranges[t].y : ranges[t] != glm::uvec2(begin, end);
        }
        CHECK(wrong == 0);
    }
}

TEST_CASE_FIXTURE(Gpu, "tile_ranges looks through any number of pairs, and past those of no tile") {
    const std::uint32_t count = 5000000;
    std::vector<std::uint32_t> tiles(count, 1);
    tiles[count - 2] = 2;
    tiles[count - 1] = 4;
    const std::vector<glm::uvec2> ranges = rangesOnDevice(*this, tiles, {64, 16});
    CHECK(ranges == std::vector{glm::uvec2(0), glm::uvec2(0, count - 2), glm::uvec2(count - 2, count - 1), glm::uvec2(count - 1)});
    CHECK(rangesOnDevice(*this, {}, {32, 16}) == std::vector(2, glm::uvec2(0)));
}

TEST_CASE_FIXTURE(Gpu, "under a mask tile_ranges lists the tiles with pairs, and clears those without and no others") {
    std::mt19937 random(3);
    for (const glm::uvec2 size_px : {glm::uvec2(300, 170), glm::uvec2(16, 16), glm::uvec2(1001, 7)}) {
        const glm::uvec2 size_tiles = (size_px + 15u) / 16u;
        const std::uint32_t tile_count = size_tiles.x * size_tiles.y;
        for (const std::uint32_t one_in : {1u, 3u, 10000u}) {
            for (const bool half_floats : {false, true}) {
                CAPTURE(size_px.x);
                CAPTURE(one_in);
                CAPTURE(half_floats);
                std::vector<std::uint32_t> tiles, listed, full;
                std::vector<glm::uvec2> expected(tile_count, glm::uvec2(7));
                for (std::uint32_t t = 0; t < tile_count; ++t) {
                    if (random() % 3 == 0) { continue; }
                    listed.push_back(t);
                    const auto begin = static_cast<std::uint32_t>(tiles.size());
                    if (random() % one_in == 0) {
                        full.push_back(t);
                        tiles.resize(tiles.size() + 1 + random() % 5, t);
                    }
                    expected[t] = {begin, tiles.size()};
                }
                std::ranges::shuffle(listed, random);
                const glm::vec3 background(0.25f, 0.5f, 0.75f);
                const MaskedRanges found = maskedRangesOnDevice(*this, tiles, listed, size_px, background, half_floats);
                CHECK(found.ranges == expected);
                CHECK(found.full == full);
                CHECK(found.groups_done == 0);
                const auto groups = static_cast<std::uint32_t>(full.size());
                CHECK((listed.empty() || found.groups == glm::uvec3(groups, groups > 0 ? 1 : 0, 1)));
                std::size_t wrong = 0;
                for (std::size_t i = 0; i < found.colours.size(); ++i) {
                    const std::size_t t = i / size_px.x / 16 * size_tiles.x + i % size_px.x / 16;
                    const bool cleared = std::ranges::find(listed, t) != listed.end() && expected[t].x == expected[t].y;
                    wrong += found.colours[i] == (cleared ? glm::vec4(background, 0.0f) : glm::vec4(7.0f)) ? 0 : 1;
                    wrong += found.depths[i] == (cleared ? 0.0f : 7.0f) ? 0 : 1;
                }
                CHECK(wrong == 0);
            }
        }
    }
}

namespace {

// What rasterize reads, as the twin leaves it.
struct RasterInputs {
    RasterInputs(Gpu& gpu, const ViewedScene& view, const TwinStages& twin, const reference::Settings& settings)
        : pixels(std::size_t{view.eye.size_px.x} * view.eye.size_px.y), eye_view(viewOf(view.eye, settings.near)) {
        std::vector<gpu::ProjectedSplat> device_splats;
        for (const reference::ProjectedSplat& splat : twin.splats) { device_splats.push_back(test::toDevice(splat)); }
        std::vector<std::uint32_t> pair_ranks;
        for (const TilePair& pair : twin.sorted_pairs) { pair_ranks.push_back(pair.splat); }
        eyes = gpu.upload("eyes", std::vector{eye_view});
        splats = gpu.upload("splats", device_splats);
        ranks = gpu.upload("ranks", pair_ranks);
        ranges = gpu.upload("ranges", twin.ranges);
        colours = gpu.allocate<glm::vec4>("colours", pixels);
        pass.eyes = eyes.address<gpu::EyeView>();
        pass.splats = splats.address<gpu::ProjectedSplat>();
        pass.ranks = ranks.address<gpu::uint>();
        pass.ranges = ranges.address<gpu::uvec2>();
        pass.colours = colours.address<glm::vec4>();
        pass.background = settings.background;
    }

    std::size_t pixels;
    gpu::EyeView eye_view;
    Buffer eyes, splats, ranks, ranges, colours;
    gpu::RasterizePass pass{};
};

// `kernel` for a scene's splats, and 32 threads a cell.
RasterizeKernel rasterizeKernel(RasterizeKernel kernel, const Scene& scene) {
    kernel.threads_per_cell = 32;
    kernel.local_size_x = gpu::kCellsPerTile * kernel.threads_per_cell;
    kernel.splat_kind = test::shapeOf(scene);
    return kernel;
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "rasterize blends the twin's splats, pairs and ranges to the twin's picture") {
    for (const ViewedScene& view : allScenes()) {
        const Kernel& kernel = this->kernel(rasterizeKernel({.depth = 1, .moments = 1, .depth_choice = gpu::kDepthInverse}, view.scene));
        CAPTURE(view.name);
        reference::Settings settings = kSettings;
        settings.background = {0.2, 0.4, 0.1};
        settings.inverse_depth_moments = true;
        const TwinStages twin(view, settings);
        RasterInputs inputs(*this, view, twin, settings);
        const std::size_t pixels = inputs.pixels;
        const Buffer depths = allocate<float>("depths", pixels), moments = allocate<gpu::vec2>("moments", pixels);
        inputs.pass.depths = depths.address<float>();
        inputs.pass.moments = moments.address<gpu::vec2>();
        run([&](Commands& commands) {
            commands.dispatch(kernel, inputs.pass, inputs.eye_view.size_tiles.x, inputs.eye_view.size_tiles.y);
        });
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
        check("colour and alpha", 4, readBack<float>(inputs.colours, 4 * pixels), test::toImage(truth), 70.0);
        check("depth", 1, readBack<float>(depths, pixels), test::toImage(truth.size_px, truth.depth), 90.0);
        std::vector<float> moment_values;
        for (const gpu::vec2& pixel : readBack<gpu::vec2>(moments, pixels)) {
            moment_values.insert(moment_values.end(), {pixel.x, pixel.y});
        }
        check("moments", 2, std::move(moment_values), test::toImage(truth.size_px, truth.inverse_depth, truth.inverse_depth_squared), 90.0);
    }
}

TEST_CASE_FIXTURE(Gpu, "rasterize rounds colours to half floats where these are wanted") {
    const ViewedScene view = test::viewBuiltin("builtin:fence", {250, 190});
    const TwinStages twin(view, kSettings);
    std::array<std::vector<gpu::uvec2>, 2> pictures;
    for (const bool halves : {false, true}) {
        RasterInputs inputs(*this, view, twin, kSettings);
        inputs.pass.half_colours = inputs.colours.address<gpu::uvec2>();
        const Kernel& kernel = this->kernel(rasterizeKernel({.depth_choice = gpu::kDepthInverse, .half_colours = halves}, view.scene));
        run([&](Commands& commands) {
            commands.dispatch(kernel, inputs.pass, inputs.eye_view.size_tiles.x, inputs.eye_view.size_tiles.y);
        });
        if (halves) {
            pictures[1] = readBack<gpu::uvec2>(inputs.colours, inputs.pixels);
        } else {
            for (const glm::vec4& c : readBack<glm::vec4>(inputs.colours, inputs.pixels)) {
                pictures[0].emplace_back(glm::packHalf2x16({c.x, c.y}), glm::packHalf2x16({c.z, c.w}));
            }
        }
    }
    // Which of the two nearest is up to the device.
    std::size_t other = 0;
    for (std::size_t i = 0; i < pictures[0].size(); ++i) {
        for (const auto& [a, b] : {std::pair(pictures[0][i].x, pictures[1][i].x), std::pair(pictures[0][i].y, pictures[1][i].y)}) {
            for (const int shift : {0, 16}) {
                other += std::abs(static_cast<int>((a >> shift) & 0xffff) - static_cast<int>((b >> shift) & 0xffff)) <= 1 ? 0 : 1;
            }
        }
    }
    CHECK(other == 0);
}

TEST_CASE_FIXTURE(Gpu, "rasterize leaves the word that each pixel moves by, and none where its depth is not one") {
    std::size_t pixels = 0, other = 0, other_spread = 0;
    for (const ViewedScene& view : allScenes()) {
        for (const reference::DepthChoice choice :
             {reference::DepthChoice::kSum, reference::DepthChoice::kMean, reference::DepthChoice::kInverse}) {
            for (const bool spreads : {false, true}) {
                CAPTURE(view.name);
                CAPTURE(static_cast<int>(choice));
                CAPTURE(spreads);
                const reference::StereoSettings stereo{.choice = spreads ? TileChoice::kPredicted : TileChoice::kPaper,
                                                       .depth_choice = choice};
                reference::Settings settings = kSettings;
                settings.inverse_depth_moments = true;
                const TwinStages twin(view, settings);
                RasterInputs inputs(*this, view, twin, settings);
                // Rows of both, one after the other, as where they share memory with a picture.
                const std::size_t width = view.eye.size_px.x;
                const auto rasterize = [&](bool even_rows) {
                    const Kernel& kernel = this->kernel(rasterizeKernel(
                        {.moving = 1, .spread = spreads, .depth_choice = test::depthChoiceOf(choice), .even_rows = even_rows}, view.scene));
                    const Buffer rows = upload("rows", std::vector<gpu::uint>(4 * inputs.pixels, 0xcdcdcdcdu));
                    inputs.pass.arrivals = rows.address<gpu::uint>();
                    inputs.pass.moving = rows.address<gpu::uint>(width * sizeof(gpu::uint));
                    inputs.pass.row_words = static_cast<gpu::uint>(4 * width);
                    run([&](Commands& commands) {
                        commands.dispatch(kernel, inputs.pass, inputs.eye_view.size_tiles.x, inputs.eye_view.size_tiles.y);
                    });
                    return readBack<gpu::uint>(rows, 4 * inputs.pixels);
                };
                const auto words = rasterize(false);
                if (spreads) {
                    auto of_even = words;
                    for (std::size_t y = 1; y < view.eye.size_px.y; y += 2) {
                        const auto row = of_even.begin() + static_cast<std::ptrdiff_t>(4 * width * y);
                        std::fill(row, row + static_cast<std::ptrdiff_t>(4 * width), 0xcdcdcdcdu);
                    }
                    CHECK(rasterize(true) == of_even);
                }
                const reference::Picture truth = reference::rasterize(twin.splats, twin.sorted_pairs, twin.ranges, view.eye, settings);
                std::size_t differ = 0, differ_in_spread = 0, touched = 0;
                for (std::size_t i = 0; i < inputs.pixels; ++i) {
                    const std::size_t row = 4 * width * (i / width), x = i % width;
                    touched += words[row + x] == 0 && words[row + 2 * width + x] == 0xcdcdcdcdu ? 0 : 1;
                    const reference::Arrival got = test::unpackArrival(words[row + width + x]);
                    const auto expected = reference::movingPixel(truth, i, stereo);
                    const bool same = (got.way == reference::Arrival::kLanded) == expected.has_value();
                    CHECK(got.way != reference::Arrival::kBetween);
                    if (!same || !expected) {
                        differ += same ? 0 : 1;
                        continue;
                    }
                    differ += test::isNear(got.inverse_depth, expected->inverse_depth, 1e-5, 1e-12) ? 0 : 1;
                    // Spreads of less than 2^-10 are the rounding of single precision's sums; rounding also decides between two codes.
                    const auto apart = std::max(got.spread, expected->spread) - std::min(got.spread, expected->spread);
                    differ_in_spread += apart == 0 || std::max(got.spread, expected->spread) <= 7 ? 0 : 1;
                    if (!spreads) { CHECK(got.spread == 0); }
                }
                CHECK(touched == 0);
                pixels += inputs.pixels;
                other += differ;
                other_spread += differ_in_spread;
            }
        }
    }
    MESSAGE(other << " depths and " << other_spread << " spreads of " << pixels << " pixels differ");
    // A hit that rounding takes away or adds moves a pixel of the cloud farthest.
    CHECK(test::share(other, pixels) <= 0.001);
    CHECK(test::share(other_spread, pixels) <= 0.0005);
}

}  // namespace tile_passes_test
