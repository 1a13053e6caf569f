// Facts about frames whose eye has half the resolution where it would not see more: against the twin, and against the same frames in full.
#include "engine/reference/periphery.h"
#include "tests/engine/frame/frame_runs.h"

SUITE(periphery_frames) {

using Tiles = std::vector<std::uint8_t>;

FrameSettings settingsFor(const Gaze& gaze) {
    FrameSettings settings;
    settings.mode = Mode::kMono;
    settings.gazes[0] = gaze;
    settings.half_periphery = true;
    return settings;
}

FrameSettings inFull(FrameSettings settings) {
    settings.half_periphery = false;
    return settings;
}

// A headset's wide view of a room.
ViewedScene viewRoom(glm::uvec2 size_px, std::uint64_t splats) {
    ViewedScene view = test::viewBuiltin("builtin:atelier", size_px, splats);
    view.eye.intrinsics = intrinsicsFromAngles({-0.9, 0.8, 0.75, -0.85}, size_px);
    return view;
}

// The squared error of each tile, over its pixels and their channels.
std::vector<double> tileErrors(const Image& a, const Image& b) {
    const std::size_t columns = tilesOf(a.size_px).x;
    std::vector<double> errors(columns * tilesOf(a.size_px).y, 0.0);
    for (std::size_t i = 0; i < a.pixelCount(); ++i) {
        const std::size_t tile = i / a.size_px.x / 16 * columns + i % a.size_px.x / 16;
        for (std::size_t c = 0; c < 3; ++c) { errors[tile] += std::pow(static_cast<double>(a.values[4 * i + c]) - b.values[4 * i + c], 2); }
    }
    return errors;
}

Tiles someHidden(const Eye& eye) {
    const glm::uvec2 tiles = tilesOf(eye.size_px);
    Tiles hidden(std::size_t{tiles.x} * tiles.y, 0);
    for (std::size_t t = 0; t < hidden.size(); ++t) { hidden[t] = t % tiles.x + t / tiles.x < 6 ? 1 : 0; }
    return hidden;
}

// How far a picture in two is from the twin's, tile by tile: all but `flips` of them alike.
void checkAgainstTwin(const Image& made, const reference::Picture& twin, std::ptrdiff_t flips) {
    const auto errors = tileErrors(made, test::toImage(twin));
    CHECK(std::ranges::count_if(errors, [](double error) { return error > 256 * 3 * 1e-8; }) <= flips);
    CHECK(*std::ranges::max_element(errors) < 256 * 3 * 1e-4);
}

TEST_CASE_FIXTURE(Gpu, "a picture in two is the twin's, of discs and of Gaussians, also in odd sizes and behind a lens that hides parts") {
    for (const ViewedScene& view :
         {viewRoom({381, 279}, 20000), test::viewGaussians({143, 97}, false), test::viewGaussians({96, 80}, true)}) {
        // So few pixels show less than an eye resolves but far from where it looks.
        const Gaze gaze = view.scene.isGaussian3d() ? Gaze{{-3.0, 1.0, -2.0}, 0.0} : Gaze{{-0.5, 0.2, 1.0}, 0.15};
        KeptFrame frame(context(), view.scene);
        for (const Tiles& hidden : {Tiles{}, someHidden(view.eye)}) {
            CAPTURE(view.name);
            CAPTURE(hidden.empty());
            FrameSettings settings = settingsFor(gaze);
            settings.hidden_tiles[0] = hidden;
            settings.background = glm::dvec3(0.1, 0.2, 0.3);
            const FrameResult result = frame.render({&view.eye, 1}, settings);
            reference::Settings twin_settings;
            twin_settings.background = settings.background;
            const auto twin = reference::renderPeriphery(view.scene, view.eye, {gaze.direction, gaze.clear_rad}, twin_settings, hidden);
            // A splat at a threshold in one sample shows in up to four tiles.
            const auto tiles = static_cast<std::ptrdiff_t>(twin.own_tiles.size());
            const std::ptrdiff_t flips = view.scene.isGaussian3d() ? tiles / 8 : tiles / 50;
            checkAgainstTwin(frame.readPicture(0), twin.picture, flips);
            const auto own = static_cast<std::uint64_t>(std::ranges::count(twin.own_tiles, 1));
            CHECK(std::max(own, countOf(result, "tiles_full_size")) - std::min(own, countOf(result, "tiles_full_size")) <= 2);
            CHECK(countOf(result, "tiles_half_size") > 0);
            const Image depth = frame.readDominantDepth();
            std::size_t off = 0;
            for (std::size_t i = 0; i < depth.values.size(); ++i) {
                off +=
                    std::abs(static_cast<double>(depth.values[i]) - twin.picture.depth[i]) > 1e-3 * (1.0 + twin.picture.depth[i]) ? 1 : 0;
            }
            CHECK(off <= depth.values.size() / 100);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "where an eye looks its picture is the one in full, and what it sees of the rest is too little to be noticed") {
    const ViewedScene view = viewRoom({512, 448}, 60000);
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
        std::size_t made_of_half = 0, noticed = 0, of_beyond = 0;
        for (std::size_t t = 0; t < errors.size(); ++t) {
            if (beyond[t] == 0) { CHECK(errors[t] == 0.0); }
            of_beyond += beyond[t];
            made_of_half += errors[t] > 0.0 ? 1 : 0;
            noticed += shares[t] * errors[t] >= static_cast<double>(gpu::kLeastSeenError) ? 1 : 0;
        }
        CHECK(100 * noticed <= made_of_half);
        CHECK(3 * made_of_half > of_beyond);
        CHECK(countOf(half, "tile_pairs") + countOf(half, "tile_pairs_half_size") < countOf(full, "tile_pairs"));
        CHECK(countOf(half, "tiles_full_size") + made_of_half <= countOf(half, "tiles"));
    }
}

TEST_CASE_FIXTURE(Gpu, "an eye that may look everywhere, or of which nothing is known, has one picture, byte for byte") {
    const ViewedScene view = viewRoom({200, 160}, 20000);
    KeptFrame frame(context(), view.scene);
    const FrameSettings clear = settingsFor({{0.0, 0.0, 1.0}, 1.6});
    const FrameResult full = frame.render({&view.eye, 1}, inFull(clear));
    const Image whole = frame.readPicture(0), depth = frame.readDominantDepth();
    const FrameResult made = frame.render({&view.eye, 1}, clear);
    CHECK(frame.readPicture(0).values == whole.values);
    CHECK(frame.readDominantDepth().values == depth.values);
    CHECK(countOf(made, "tiles_half_size") == 0);
    CHECK(countOf(made, "tile_pairs_half_size") == 0);
    // Splats that only the other picture's low-pass brings in make no pair but where rounding does.
    CHECK(static_cast<double>(countOf(made, "tile_pairs")) ==
          doctest::Approx(static_cast<double>(countOf(full, "tile_pairs"))).epsilon(1e-3));
    FrameSettings unknown = clear;
    unknown.gazes = {};
    const FrameResult plain = frame.render({&view.eye, 1}, unknown);
    CHECK(frame.readPicture(0).values == whole.values);
    CHECK_FALSE(plain.counters.named().contains("tiles_half_size"));
    // Whoever wants moments has them.
    FrameSettings moments = settingsFor({{0.0, 0.0, 1.0}, 0.1});
    moments.keep_moments = true;
    const FrameResult with_moments = frame.render({&view.eye, 1}, moments);
    CHECK_FALSE(with_moments.counters.named().contains("tiles_half_size"));
    CHECK(frame.readPicture(0).values == whole.values);
}

TEST_CASE_FIXTURE(
    Gpu, "lists grow, whichever picture they are too short for; half the size takes fewer bytes, and other frames give them back") {
    const ViewedScene view = viewRoom({240, 200}, 20000);
    const FrameSettings settings = settingsFor({{0.0, 0.0, 1.0}, 0.2});
    KeptFrame short_of(context(), view.scene, {.first_capacity = {256, 256}});
    const auto roomy = StereoFrame::beside(short_of);
    roomy->render({&view.eye, 1}, inFull(settings));
    const std::uint64_t before = context().memoryUse().current_bytes;
    const FrameResult result = roomy->render({&view.eye, 1}, settings);
    const std::uint64_t in_two = context().memoryUse().current_bytes;
    CHECK(in_two > before);
    CHECK(countOf(result, "periphery_bytes") < countOf(result, "pixel_bytes") / 3);
    const FrameResult grown = short_of.render({&view.eye, 1}, settings);
    CHECK(short_of.readPicture(0).values == roomy->readPicture(0).values);
    CHECK(countOf(grown, "tile_pairs") == countOf(result, "tile_pairs"));
    CHECK(countOf(grown, "tile_pairs_half_size") == countOf(result, "tile_pairs_half_size"));
    const std::uint64_t with_both = context().memoryUse().current_bytes;
    roomy->render({&view.eye, 1}, inFull(settings));
    CHECK(context().memoryUse().current_bytes < with_both);
}

}  // SUITE(periphery_frames)
