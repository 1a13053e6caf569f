// Facts about frames with coarse tiles where the eye would not see more.
#include "engine/twin/coarse.h"
#include "tests/engine/passes/history_stages.h"

SUITE(coarse_frames) {

using Tiles = std::vector<std::uint8_t>;

FrameSettings settingsFor(const Gaze& gaze, Mode mode = Mode::kMono) {
    FrameSettings settings = makeSettings(mode);
    settings.gazes = {gaze, gaze};
    settings.half_periphery = true;
    return settings;
}
FrameSettings inFull(FrameSettings settings) {
    settings.half_periphery = false;
    return settings;
}

// The squared error of each tile, over its pixels and their channels.
std::vector<double> tileErrors(const Image& a, const Image& b) {
    std::vector<double> errors(tileCount(a.size_px), 0.0);
    for (std::size_t i = 0; i < a.pixelCount(); ++i) {
        for (std::size_t c = 0; c < 3; ++c) {
            errors[tileOf(i, a.size_px)] +=
                std::pow(static_cast<double>(a.values[4 * i + c]) - b.values[4 * i + c], 2);
        }
    }
    return errors;
}

// Compares a picture with the twin's, tile by tile: all but `flips` tiles, with a splat at a threshold, must
// agree, and kinds of tiles and depths must match, too.
void checkTiles(StereoFrame& frame, const FrameResult& result, const reference::CoarsePicture& twin,
                std::ptrdiff_t flips) {
    const auto errors = tileErrors(frame.readPicture(0), toImage(twin.picture));
    CHECK(std::ranges::count_if(errors, [](double error) { return error > 256 * 3 * 1e-8; }) <= flips);
    CHECK(*std::ranges::max_element(errors) < 256 * 3 * 1e-4);
    const auto coarse = std::ranges::count(twin.coarse, 1), tried = std::ranges::count(twin.tried, 1);
    CHECK(countOf(result, "tiles_coarse") == within(coarse - 2, coarse + 2));
    CHECK(countOf(result, "tiles_tried_as_coarse") == within(tried - 2, tried + 2));
    const std::vector<float> depths = frame.readDominantDepth().values;
    std::size_t off = 0;
    for (std::size_t i = 0; i < depths.size(); ++i) {
        const double expected = twin.picture.depth[i];
        off += std::abs(double{depths[i]} - expected) > 1e-3 * (1.0 + expected);
    }
    CHECK(off <= depths.size() / 100);
}

reference::CoarsePicture twinOf(const ViewedScene& view, const FrameSettings& settings) {
    const Gaze& gaze = settings.gazes[0].value();
    return reference::renderCoarse(view.scene, view.eye, {gaze.direction, gaze.clear_rad},
                                   {.background = settings.background, .inverse_depth_moments = true},
                                   settings.hidden_tiles[0]);
}

TEST_CASE_FIXTURE(Gpu, "a picture with coarse tiles is the twin's, in odd sizes and behind lenses, too") {
    for (const ViewedScene& view :
         {viewWide({381, 279}), viewGaussians({143, 97}, false), viewGaussians({96, 80}, true)}) {
        KeptFrame frame(context(), view.scene);
        const std::uint32_t columns = tilesOf(view.eye.size_px).x;
        Tiles corner(tileCount(view.eye.size_px));
        for (std::size_t t = 0; t < corner.size(); ++t) { corner[t] = t % columns + t / columns < 6; }
        for (const Tiles& hidden : {Tiles{}, corner}) {
            INFO(view.name, ", whole ", hidden.empty());
            FrameSettings settings =
                settingsFor(view.scene.isGaussian3d() ? kAside : Gaze{{-0.5, 0.2, 1.0}, 0.15});
            settings.hidden_tiles[0] = hidden;
            settings.background = glm::dvec3(0.1, 0.2, 0.3);
            const FrameResult result = frame.render({&view.eye, 1}, settings);
            const auto twin = twinOf(view, settings);
            CHECK(countOf(result, "tiles_coarse") > 0);
            const auto tiles = static_cast<std::ptrdiff_t>(twin.coarse.size());
            checkTiles(frame, result, twin, view.scene.isGaussian3d() ? tiles / 8 : tiles / 50);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "however many threads and tiles there are, coarse tiles are the twin's") {
    std::uint64_t in_full = 0, coarse = 0;
    int run = 0;
    for (const glm::uvec2& size_px :
         std::vector<glm::uvec2>{{15, 16}, {16, 16}, {17, 33}, {31, 32}, {33, 48}, {80, 16}, {176, 144}}) {
        const ViewedScene view = viewWide(size_px);
        const FrameSettings settings = settingsFor(kAside);
        const auto twin = twinOf(view, settings);
        for (const std::uint32_t threads : {8u, 16u, 32u, 64u}) {
            if (size_px.x < 176 && run++ % 3 != 0) { continue; }
            INFO("width ", size_px.x, ", threads ", threads);
            KeptFrame frame(context(), view.scene, {.threads_per_cell = threads});
            const FrameResult result = frame.render({&view.eye, 1}, settings);
            checkTiles(frame, result, twin, static_cast<std::ptrdiff_t>(twin.coarse.size() / 25));
            coarse += countOf(result, "tiles_coarse");
            in_full += countOf(result, "tiles_tried_as_coarse") - countOf(result, "tiles_coarse");
        }
    }
    CHECK(coarse > 80);
    CHECK(in_full > 10);
}

TEST_CASE_FIXTURE(Gpu, "a coarse tile leaves its samples' depths, a quarter of its pairs, what it lacks") {
    const ViewedScene view = viewWide({176, 144});
    const std::array<Eye, 2> eyes{view.eye, view.eye};
    for (const bool halves : {false, true}) {
        FrameSettings settings = settingsFor(kAside, Mode::kTemporal);
        settings.half_floats = halves;
        KeptFrame frame(context(), view.scene);
        frame.render(eyes, settings);
        const auto twin = twinOf(view, settings);
        const EyeOnDevice eye = readEye(*this, frame, 0, view.eye);
        std::size_t coarse = 0, off = 0, pixels = 0;
        for (std::size_t t = 0; t < twin.coarse.size(); ++t) {
            const reference::HistoryTile& tile = eye.history.tiles[t];
            CHECK(tile.age == 0);
            CHECK(tile.errors == std::array<double, 4>{});
            if (twin.coarse[t] == 0 || tile.lost == 0.0) { continue; }
            ++coarse;
            CHECK(tile.lost == doctest::Approx(std::sqrt(twin.losses[t] / (3.0 * 256.0))).epsilon(0.02));
        }
        for (std::size_t i = 0; i < eye.history.pixels.size(); ++i) {
            const double alpha = twin.picture.rgba[i].a,
                         inverse_depth = alpha > 0.0 ? twin.picture.inverse_depth[i] / alpha : 0.0;
            if (twin.coarse[tileOf(i, view.eye.size_px)] == 0) { continue; }
            ++pixels;
            const auto made = eye.history.pixels[i].value_or(reference::MovingPixel{0.0, 0});
            off += std::abs(made.inverse_depth - inverse_depth) > 1e-3 * inverse_depth;
        }
        CHECK(coarse > 20);
        CHECK(off <= pixels / 100);
        // The same view, rendered in full, gives the number of pairs in each tile.
        KeptFrame other(context(), view.scene);
        other.render(eyes, inFull(settings));
        const EyeOnDevice in_full = readEye(*this, other, 0, view.eye);
        for (std::size_t t = 0; t < twin.coarse.size(); ++t) {
            const std::uint64_t pairs = in_full.history.tiles[t].cost;
            // A flat tile loses nothing.
            const bool is_coarse = eye.history.tiles[t].lost > 0.0 || twin.coarse[t] != 0;
            CHECK(eye.history.tiles[t].cost == (is_coarse ? pairs / 4 : pairs));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "what a coarse tile lacks counts once it would be seen, and then it is rendered") {
    // With a squared error of 0.3072.
    const reference::HistoryTile lacks{100, 1, {}, {0.1, 0.2, 0.3, 0.4}, {}, 0.02};
    CHECK(reference::withLoss(lacks, 0.08).errors == lacks.errors);
    CHECK(reference::withLoss(lacks, 0.09).errors[3] == doctest::Approx(0.42));
    const ViewedScene view = viewWide({176, 144});
    const std::array<Eye, 2> eyes{view.eye, view.eye};
    FrameSettings settings = settingsFor(kAside, Mode::kTemporal);
    KeptFrame frame(context(), view.scene);
    CHECK(countOf(frame.render(eyes, settings), "tiles_coarse") > 40);
    const Image aside = frame.readPicture(0);
    settings.gazes[0] = settings.gazes[1] = Gaze{{0.0, 0.0, 1.0}, 1.6};
    for (int i = 0; i < 20; ++i) { frame.render(eyes, settings); }
    const Image made = frame.readPicture(0);
    CHECK(frame.render(eyes, settings).work_rendered == 0.0);
    frame.forgetHistory();
    frame.render(eyes, inFull(settings));
    CHECK(compare(frame.readPicture(0), aside).psnrDb() < 55.0);
    // A tile that was expected to lose nothing may stay.
    CHECK(compare(frame.readPicture(0), made).psnrDb() > 65.0);
}

TEST_CASE_FIXTURE(Gpu, "where an eye looks its picture is the full one, and the rest is hardly noticed") {
    const ViewedScene view = viewWide({512, 448}, 60000);
    KeptFrame frame(context(), view.scene);
    for (const Gaze& gaze : {Gaze{{0.4, 0.0, 1.0}, 0.0}, Gaze{{-0.7, 0.3, 1.0}, 0.1}}) {
        CAPTURE(gaze.direction.x);
        const FrameResult full = frame.render({&view.eye, 1}, inFull(settingsFor(gaze)));
        const Image whole = frame.readPicture(0);
        const FrameResult half = frame.render({&view.eye, 1}, settingsFor(gaze));
        const std::vector<double> errors = tileErrors(whole, frame.readPicture(0));
        const reference::Gaze its_gaze{gaze.direction, gaze.clear_rad};
        const Tiles beyond = reference::findBeyond(view.eye, its_gaze);
        const std::vector<double> shares = reference::findSharesThere(view.eye, its_gaze);
        std::size_t coarse = 0, noticed = 0, of_beyond = 0;
        for (std::size_t t = 0; t < errors.size(); ++t) {
            if (beyond[t] == 0) { CHECK(errors[t] == 0.0); }
            of_beyond += beyond[t];
            coarse += errors[t] > 0.0;
            noticed += shares[t] * errors[t] >= double{gpu::kLeastSeenError};
        }
        CHECK(100 * noticed <= coarse);
        CHECK(3 * coarse > of_beyond);
        CHECK(countOf(half, "tile_pairs") == countOf(full, "tile_pairs"));
        CHECK(4 * countOf(half, "tile_pairs_in_full") + countOf(half, "tile_pairs_as_samples") <
              4 * countOf(full, "tile_pairs"));
        CHECK(countOf(half, "tiles_coarse") >= coarse);
        CHECK(countOf(half, "commands") == countOf(full, "commands"));
    }
}

TEST_CASE_FIXTURE(Gpu, "an eye that may look everywhere, or nobody knows where, sees all in full") {
    const ViewedScene view = viewWide({200, 160});
    KeptFrame frame(context(), view.scene);
    const FrameSettings clear = settingsFor({{0.0, 0.0, 1.0}, 1.6});
    const FrameResult full = frame.render({&view.eye, 1}, inFull(clear));
    const Image whole = frame.readPicture(0), depth = frame.readDominantDepth();
    const FrameResult made = frame.render({&view.eye, 1}, clear);
    CHECK(frame.readPicture(0).values == whole.values);
    CHECK(frame.readDominantDepth().values == depth.values);
    CHECK(these(countOf(made, "tiles_tried_as_coarse"), countOf(made, "tile_pairs_as_samples"),
                countOf(made, "tile_pairs_in_full")) == these(0, 0, countOf(full, "tile_pairs")));
    FrameSettings unknown = clear, moments = settingsFor({{0.0, 0.0, 1.0}, 0.1});
    unknown.gazes = {};
    moments.keep_moments = true;
    for (const FrameSettings& settings : {unknown, moments}) {
        CAPTURE(settings.keep_moments);
        CHECK_FALSE(frame.render({&view.eye, 1}, settings).counters.named().contains("tiles_coarse"));
        CHECK(frame.readPicture(0).values == whole.values);
    }
}

TEST_CASE_FIXTURE(Gpu, "lists that are too short grow, and what coarse tiles take is given back") {
    const ViewedScene view = viewWide({240, 200});
    const FrameSettings settings = settingsFor({{0.0, 0.0, 1.0}, 0.2});
    KeptFrame short_of(context(), view.scene, {.first_capacity = {256, 256}}), roomy(context(), view.scene);
    const auto bytes = [&] { return context().memoryUse().current_bytes.load(); };
    const FrameResult result = roomy.render({&view.eye, 1}, settings);
    const std::uint64_t with_coarse = bytes();
    const FrameResult grown = short_of.render({&view.eye, 1}, settings);
    CHECK(short_of.readPicture(0).values == roomy.readPicture(0).values);
    for (const char* name : {"tile_pairs", "tiles_coarse", "tile_pairs_as_samples", "tile_pairs_in_full"}) {
        CHECK(countOf(grown, name) == countOf(result, name));
    }
    const std::uint64_t with_both = bytes();
    CHECK(with_both > with_coarse);
    roomy.render({&view.eye, 1}, inFull(settings));
    CHECK(bytes() < with_both);
}

}  // SUITE(coarse_frames)
