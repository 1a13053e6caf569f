// Facts about the passes over tiles, tile_ranges and rasterize, each started from the output of the twin's
// previous pass.
#include "engine/twin/contribute.h"
#include "tests/engine/passes/pass_stages.h"
#include "tests/engine/passes/stereo_cases.h"

SUITE(tile_passes) {

using reference::TilePair;

const reference::Settings kSettings{};
const glm::vec3 kBackground(0.25f, 0.5f, 0.75f);

// What tile_ranges leaves and rasterize must do, in pictures that hold 7 everywhere before.
struct Ranges {
    std::vector<glm::uvec2> ranges;
    std::vector<std::uint32_t> full;  // ascending
    glm::uvec3 groups;                // for rasterize
    std::vector<glm::vec4> colours;
    std::vector<float> depths;
    std::uint32_t groups_done;  // of the list of pairs, afterwards
};
// Under a mask, only for the listed tiles.
Ranges rangesOnDevice(Gpu& gpu, const std::vector<std::uint32_t>& sorted_tiles, glm::uvec2 size_px,
                      bool is_masked = false, const std::vector<std::uint32_t>& listed = {},
                      bool half_floats = false, gpu::uint rank_bits = 0) {
    const Kernel& kernel = gpu.kernel(TileRangesKernel{.masked = is_masked, .half_colours = half_floats});
    const std::size_t pixels = std::size_t{size_px.x} * size_px.y, tile_count = tileCount(size_px);
    const Buffer tiles = gpu.upload("tiles", sorted_tiles),
                 pairs = gpu.upload("pairs", std::vector{makeList(sorted_tiles.size())}),
                 list = gpu.upload("tile list", listed),
                 ranges = gpu.upload("ranges", std::vector(tile_count, glm::uvec2(7))),
                 full = gpu.upload("full tiles", std::vector<gpu::uint>(tile_count, 7)),
                 colours = half_floats ? gpu.upload("colours", std::vector(pixels, glm::uvec2(0x47004700u)))
                                       : gpu.upload("colours", std::vector(pixels, glm::vec4(7.0f))),
                 depths = gpu.upload("depths", std::vector(pixels, 7.0f));
    gpu::EyeView eye{};
    eye.size_px = size_px;
    eye.size_tiles = tilesOf(size_px);
    gpu::TargetState state{};
    state.colours = at(colours);
    state.depths = at(depths);
    state.tile_list = at(list);
    state.full_tiles = at(full);
    state.chosen_tiles = makeList(listed.size());
    const Buffer target = gpu.upload("target", std::vector{state}),
                 eyes = gpu.upload("eyes", std::vector{eye});
    gpu::TileRangesPass pass{};
    pass.eyes = at(eyes);
    pass.tiles = at(tiles);
    pass.pairs = at(pairs);
    pass.ranges = at(ranges);
    pass.targets = at(target);
    pass.background = kBackground;
    pass.rank_bits = rank_bits;
    if (is_masked) {
        constexpr auto kPerTile =
            offsetof(gpu::TargetState, chosen_tiles) + offsetof(gpu::ListState, per_item);
        gpu.dispatchIndirect(kernel, pass, target, kPerTile);
    } else {
        gpu.dispatchOver(kernel, pass, tile_count);
    }
    const gpu::EyeCounters counted = gpu.readBack<gpu::TargetState>(target, 1)[0].counters;
    Ranges result{.ranges = gpu.readBack<glm::uvec2>(ranges, tile_count),
                  .full = gpu.readBack<gpu::uint>(full, counted.full_tiles),
                  .groups = {counted.per_full_tile.x, counted.per_full_tile.y, counted.per_full_tile.z},
                  .colours = half_floats ? unpackHalves(gpu.readBack<glm::uvec2>(colours, pixels))
                                         : gpu.readBack<glm::vec4>(colours, pixels),
                  .depths = gpu.readBack<float>(depths, pixels),
                  .groups_done = gpu.readBack<gpu::ListState>(pairs, 1)[0].groups_done};
    std::ranges::sort(result.full);
    return result;
}

// What rasterize reads, as the twin leaves it, and the twin's picture.
struct Raster {
    Raster(Gpu& gpu, const StagedScene& scene)
        : staged(scene), pixels(std::size_t{scene.view.eye.size_px.x} * scene.view.eye.size_px.y), gpu_(gpu) {
        std::vector<gpu::ProjectedSplat> device_splats;
        for (const reference::ProjectedSplat& splat : staged.twin.splats) {
            device_splats.push_back(toDevice(splat));
        }
        std::vector<std::uint32_t> pair_ranks;
        for (const TilePair& pair : staged.twin.sorted_pairs) { pair_ranks.push_back(pair.splat); }
        eyes_ = uploadEyes(gpu, {staged.view.eye}, kSettings.near);
        splats_ = gpu.upload("splats", device_splats);
        ranks_ = gpu.upload("ranks", pair_ranks);
        ranges_ = gpu.upload("ranges", staged.twin.ranges);
        colours = gpu.allocate<glm::vec4>("colours", pixels);
        pass.eyes = at(eyes_);
        pass.splats = at(splats_);
        pass.ranks = at(ranks_);
        pass.ranges = at(ranges_);
        state.colours = at(colours);
        pass.depth_choice = gpu::kDepthInverse;
        pass.background = kBackground;
    }

    [[nodiscard]] reference::Picture makeTwin() const {
        reference::Settings settings = kSettings;
        settings.background = kBackground;
        settings.inverse_depth_moments = true;
        return reference::rasterize(staged.twin.splats, staged.twin.sorted_pairs, staged.twin.ranges,
                                    staged.view.eye, settings);
    }
    // Runs `kernel` for the scene's splats, with 32 threads per cell.
    void run(RasterizeKernel variant) {
        variant.threads_per_cell = 32;
        variant.local_size_x = gpu::kCellsPerTile * variant.threads_per_cell;
        variant.splat_kind = shapeOf(staged.view.scene);
        const Buffer target = gpu_.upload("target", std::vector{state});
        pass.targets = at(target);
        gpu_.dispatch(gpu_.kernel(variant), pass, tilesOf(staged.view.eye.size_px));
    }

    const StagedScene& staged;
    std::size_t pixels;
    Buffer colours;
    gpu::RasterizePass pass{};
    gpu::TargetState state{};

private:
    Gpu& gpu_;
    Buffer eyes_, splats_, ranks_, ranges_;
};

// Words of rows that alternate with arrivals, as if they shared memory with a picture; words that belong to
// neither must stay.
constexpr gpu::uint kUnwritten = 0xcdcdcdcdu;
std::vector<gpu::uint> wordsOnDevice(Gpu& gpu, Raster& raster, const RasterizeKernel& variant) {
    const std::size_t width = raster.staged.view.eye.size_px.x;
    const Buffer rows = gpu.upload("rows", std::vector<gpu::uint>(4 * raster.pixels, kUnwritten));
    raster.state.arrivals = rows.address<gpu::uint>();
    raster.state.moving = rows.address<gpu::uint>(width * sizeof(gpu::uint));
    raster.state.row_words = static_cast<gpu::uint>(4 * width);
    raster.run(variant);
    return gpu.readBack<gpu::uint>(rows, 4 * raster.pixels);
}

TEST_CASE_FIXTURE(Gpu, "tile_ranges looks through any number of pairs, and past those of no tile") {
    const std::uint32_t count = 5000000;
    std::vector<std::uint32_t> tiles(count, 1);
    tiles[count - 2] = 2;
    tiles[count - 1] = 4;
    CHECK(rangesOnDevice(*this, tiles, {64, 16}).ranges ==
          std::vector{glm::uvec2(0), glm::uvec2(0, count - 2), glm::uvec2(count - 2, count - 1),
                      glm::uvec2(count - 1)});
    CHECK(rangesOnDevice(*this, {}, {32, 16}).ranges == std::vector(2, glm::uvec2(0)));
}

TEST_CASE_FIXTURE(Gpu, "tile_ranges finds the pairs of every tile; under a mask it clears those without") {
    std::mt19937 random(3);
    for (const glm::uvec2 size_px : {glm::uvec2(300, 170), glm::uvec2(16, 16), glm::uvec2(1001, 7)}) {
        const auto tile_count = static_cast<std::uint32_t>(tileCount(size_px));
        for (const std::uint32_t one_in : {1u, 3u, 10000u}) {
            for (const auto& [is_masked, half_floats] :
                 {std::pair(false, false), std::pair(true, false), std::pair(true, true)}) {
                INFO("size ", size_px.x, ", one in ", one_in, ", is masked ", is_masked, ", half floats ",
                     half_floats);
                std::vector<std::uint32_t> tiles, listed, full;
                std::vector<glm::uvec2> expected(tile_count, glm::uvec2(7));
                for (std::uint32_t t = 0; t < tile_count; ++t) {
                    if (is_masked && random() % 3 == 0) { continue; }
                    listed.push_back(t);
                    const auto begin = static_cast<std::uint32_t>(tiles.size());
                    if (random() % one_in == 0) {
                        full.push_back(t);
                        tiles.resize(tiles.size() + 1 + random() % 5, t);
                    }
                    expected[t] = {begin, tiles.size()};
                }
                std::ranges::shuffle(listed, random);
                const Ranges found = rangesOnDevice(*this, tiles, size_px, is_masked, listed, half_floats);
                CHECK(found.ranges == expected);
                for (std::uint32_t& tile : tiles) {
                    tile = tile << 18 | static_cast<std::uint32_t>(random()) >> 14;
                }
                CHECK(rangesOnDevice(*this, tiles, size_px, is_masked, listed, half_floats, 18).ranges ==
                      expected);
                if (!is_masked) { continue; }
                CHECK(these(found.full, found.groups_done) == these(full, 0));
                const auto groups = static_cast<std::uint32_t>(full.size());
                CHECK((listed.empty() || found.groups == glm::uvec3(groups, groups > 0 ? 1 : 0, 1)));
                for (std::size_t i = 0; i < found.colours.size(); ++i) {
                    const std::size_t t = tileOf(i, size_px);
                    const bool cleared =
                        std::ranges::find(listed, t) != listed.end() && expected[t].x == expected[t].y;
                    REQUIRE(found.colours[i] == (cleared ? glm::vec4(kBackground, 0.0f) : glm::vec4(7.0f)));
                    REQUIRE(found.depths[i] == (cleared ? 0.0f : 7.0f));
                }
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "rasterize rounds colours to half floats where these are wanted") {
    for (const StagedScene& staged : stagedScenes()) {
        CAPTURE(staged.view.name);
        Raster raster(*this, staged);
        raster.run({});
        const auto rounded = packHalves(readBack<glm::vec4>(raster.colours, raster.pixels));
        raster.run({.half_colours = 1});
        const auto halves = readBack<gpu::uvec2>(raster.colours, raster.pixels);
        // The device is free to choose between the two nearest.
        for (std::size_t i = 0; i < halves.size(); ++i) {
            for (const glm::uvec2 shift : {glm::uvec2(0), glm::uvec2(16)}) {
                const glm::ivec2 apart((rounded[i] >> shift & 0xffffu) - (halves[i] >> shift & 0xffffu));
                REQUIRE(glm::all(glm::lessThanEqual(glm::abs(apart), glm::ivec2(1))));
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "rasterize leaves the word that each pixel moves by, or none without a depth") {
    using reference::DepthChoice;
    std::size_t pixels = 0, other = 0, other_spread = 0;
    for (const StagedScene& staged : stagedScenes()) {
        CAPTURE(staged.view.name);
        Raster raster(*this, staged);
        const reference::Picture truth = raster.makeTwin();
        const std::size_t width = truth.size_px.x;
        for (const DepthChoice choice : {DepthChoice::kSum, DepthChoice::kMean, DepthChoice::kInverse}) {
            CAPTURE(static_cast<int>(choice));
            raster.pass.depth_choice = depthChoiceOf(choice);
            RasterizeKernel kernel{.depth = choice != DepthChoice::kInverse, .moments = 1};
            const auto words = wordsOnDevice(*this, raster, kernel);
            auto of_even = words;
            for (std::size_t i = 0; i < of_even.size(); ++i) {
                of_even[i] = i / (4 * width) % 2 == 0 ? words[i] : kUnwritten;
            }
            kernel.even_rows = 1;
            CHECK(wordsOnDevice(*this, raster, kernel) == of_even);
            // Where D does not affect the choice, its sum changes nothing.
            if (choice == DepthChoice::kInverse) {
                CHECK(wordsOnDevice(*this, raster, {.depth = 1, .moments = 1}) == words);
            }
            std::size_t touched = 0;
            for (std::size_t i = 0; i < raster.pixels; ++i) {
                const std::size_t row = 4 * width * (i / width), x = i % width;
                touched += !(words[row + x] == 0 && words[row + 2 * width + x] == kUnwritten);
                const reference::Arrival got = unpackArrival(words[row + width + x]);
                const auto expected = reference::movingPixel(truth, i, {.depth_choice = choice});
                CHECK(got.way != reference::Arrival::kBetween);
                const bool landed = got.way == reference::Arrival::kLanded;
                other += landed != expected.has_value() ||
                         (landed && !isNear(got.inverse_depth, expected->inverse_depth, 1e-5, 1e-12));
                // Spreads of less than 2^-10 are rounding errors of sums in single precision; rounding also
                // decides between two codes.
                other_spread += landed && expected && got.spread != expected->spread &&
                                std::max(got.spread, expected->spread) > 7;
            }
            CHECK(touched == 0);
            pixels += raster.pixels;
        }
    }
    // In the cloud, a hit that rounding removes or adds moves a pixel farthest.
    CHECK(share(other, pixels) <= 0.001);
    CHECK(share(other_spread, pixels) <= 0.0005);
}

using Contributions = std::array<double, gpu::kContributionSums>;
// For each splat by rank, from one run of contribute.
std::vector<Contributions> contributionsOnDevice(Gpu& gpu, const Raster& raster, const Buffer& wanted,
                                                 std::uint32_t threads, bool by_lanes) {
    const std::size_t splats = raster.staged.twin.splats.size();
    const Buffer ranks = gpu.upload("order", numbersUpTo(splats)),
                 sums = gpu.upload("sums", std::vector<std::int64_t>(splats * gpu::kContributionSums));
    const gpu::ContributePass pass{.eyes = raster.pass.eyes,
                                   .splats = raster.pass.splats,
                                   .ranks = raster.pass.ranks,
                                   .ranges = raster.pass.ranges,
                                   .order = at(ranks),
                                   .picture = raster.state.colours,
                                   .wanted = at(wanted),
                                   .sums = at(sums),
                                   .eye = 0,
                                   .rank_bits = 0};
    gpu.dispatch(gpu.kernel(contributeKernel(threads, shapeOf(raster.staged.view.scene), true, by_lanes)),
                 pass, tilesOf(raster.staged.view.eye.size_px));
    std::vector<Contributions> found(splats);
    const auto steps = gpu.readBack<std::int64_t>(sums, splats * gpu::kContributionSums);
    for (std::size_t i = 0; i < steps.size(); ++i) {
        found[i / gpu::kContributionSums][i % gpu::kContributionSums] =
            static_cast<double>(steps[i]) / gpu::kContributionSteps;
    }
    return found;
}

TEST_CASE_FIXTURE(Gpu, "contribute finds what each splat makes up of a picture and which way it should go") {
    for (const StagedScene& staged : stagedScenes()) {
        CAPTURE(staged.view.name);
        Raster raster(*this, staged);
        raster.run({});
        const reference::Picture truth = raster.makeTwin();
        std::vector<glm::dvec3> wanted;
        std::vector<glm::vec4> colours;
        for (const glm::dvec4& shown : truth.rgba) {
            wanted.push_back(0.5 * glm::dvec3(shown) + glm::dvec3(0.3, 0.1, 0.0));
            colours.emplace_back(glm::vec3(wanted.back()), 1.0f);
        }
        const Buffer picture = upload("wanted", colours);
        const auto expected =
            reference::contribute(staged.twin.splats, staged.twin.sorted_pairs, staged.twin.ranges,
                                  staged.view.eye, kSettings, truth, wanted);
        std::vector<std::pair<std::uint32_t, bool>> ways{{8u, false}, {32u, false}};
        if (PassKernels(context(), 8).cellsAreNarrow()) { ways.emplace_back(8u, true); }
        for (const auto& [threads, by_lanes] : ways) {
            CAPTURE(threads);
            CAPTURE(by_lanes);
            const auto found = contributionsOnDevice(*this, raster, picture, threads, by_lanes);
            CHECK(contributionsOnDevice(*this, raster, picture, threads, by_lanes) == found);
            Contributions off{}, all{};
            for (std::size_t i = 0; i < found.size(); ++i) {
                const reference::Contribution& e = expected[i];
                const std::array sums{e.weight,       e.missing.x,    e.missing.y, e.missing.z,
                                      e.opacity_pull, e.opacity_hold, e.size_pull, e.size_hold};
                for (std::size_t s = 0; s < sums.size(); ++s) {
                    off[s] += std::abs(found[i][s] - sums[s]), all[s] += std::abs(sums[s]);
                }
            }
            for (std::size_t s = 0; s < off.size(); ++s) {
                CAPTURE(s);
                // Colours are half floats, whose errors do not cancel in sums with both signs.
                CHECK(off[s] <= 1e-3 * all[s] + (s == gpu::kSumWeight ? 0.0 : 2e-4 * all[gpu::kSumWeight]));
            }
        }
    }
}

}  // SUITE(tile_passes)
