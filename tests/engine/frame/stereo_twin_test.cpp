// The device's stereo frames match the twin's.
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_cases.h"

SUITE(stereo_twin) {

using reference::DepthChoice;
using reference::TileKind;

struct View {
    std::string name;
    ViewedScene view;
    std::array<Eye, 2> eyes;
};

std::vector<View> makeViews() {
    const auto room = viewAtelier({160, 120}), fence = viewBuiltin("builtin:fence", {160, 120}),
               gaussians = viewGaussians({160, 120}, false), dimmed = viewGaussians({160, 120}, true);
    return {{"room", room, stereoPair(room.eye, 0.063)},
            {"room, canted", room, headsetEyes(room.eye, glm::radians(5.0))},
            {"fence", fence, stereoPair(fence.eye, 0.12)},
            {"3D Gaussians", gaussians, stereoPair(gaussians.eye, 0.063)},
            {"3D Gaussians, dimmed, canted", dimmed, headsetEyes(dimmed.eye, glm::radians(5.0))}};
}

struct Making {
    Mode mode;
    std::uint32_t move_cost;
    bool letter;
};
// Costs of moving: nothing, as much as the pairs of many tiles, and more than any; also exactly the paper,
// with each eye by itself.
constexpr Making kMakings[] = {{Mode::kReproject, 0, false},     {Mode::kReproject, 0, true},
                               {Mode::kPaper, 0, false},         {Mode::kPaper, 0, true},
                               {Mode::kPredicted, 0, false},     {Mode::kPredicted, 150, false},
                               {Mode::kPredicted, 100000, false}};

// `full`: the twin's full render of the other eye.
void checkIsTwins(KeptFrame& frame, const View& seen, Side dominant, const Making& making,
                  const Image& full) {
    INFO("seen.name ", seen.name, ", dominant ", static_cast<int>(dominant), ", mode ", nameOf(making.mode),
         ", move_cost ", making.move_cost, ", letter ", making.letter);
    const reference::StereoSettings twin_settings{
        .choice = choiceOf(making.mode),
        .depth_choice = making.letter ? DepthChoice::kSum : DepthChoice::kInverse,
        .forward = making.letter,
        .margin_px = 8,
        .center_rois = true,
        .budget = 0.15,
        .move_cost = making.move_cost};
    FrameSettings settings = makeSettings(making.mode, dominant);
    settings.stereo = settingsOf(twin_settings);
    settings.per_eye = making.letter;
    const auto [made, depth, twin, same_kind] =
        makeWithTwin(frame, seen.view.scene, seen.eyes, twin_settings, settings);
    // The device rounds errors down pixel by pixel, so among tiles that are nearly alike, such as those of
    // the fence's equal bars, it may choose others; they are then worth as much.
    double chosen_error = 0.0, exchanged_error = 0.0;
    for (std::size_t t = 0; t < twin.tile_kinds.size(); ++t) {
        const double error = twin.tile_errors.empty() ? 0.0 : twin.tile_errors[t];
        chosen_error += twin.tile_kinds[t] == TileKind::kPredicted ? error : 0.0;
        if (same_kind[t] == 0) { exchanged_error += made.tile_kinds[t] != 0 ? -error : error; }
    }
    const auto other_kinds = std::ranges::count(same_kind, 0u);
    std::size_t other_classes = 0;
    for (std::size_t i = 0; i < twin.resolved.size(); ++i) {
        if (made.tile_kinds[tileOf(i, full.size_px)] != 0) { continue; }
        other_classes += made.pixel_classes[i] != static_cast<std::uint8_t>(twin.resolved[i].pixel_class);
    }
    // Tiles that only one of them renders: both pictures are equally near to the full render.
    const double device_db = compare(made.pictures[1 - dominant], full).psnrDb(),
                 twin_db = compare(toImage(full.size_px, twin.affiliated), full).psnrDb();
    // measured: 0.19 in one, 0.12 in one
    if (std::min(device_db, twin_db) < 70.0) { CHECK(std::abs(device_db - twin_db) <= 0.25); }
    // Along rows, resample moves the pixels itself; a pass that does not run has no time.
    const bool canted = seen.name.ends_with("canted");
    if (making.mode != Mode::kPredicted) {
        CHECK(std::ranges::any_of(made.result.gpu_ms, [](const auto& pass) {
                  return pass.label.text() == "affiliated reproject";
              }) == canted);
    }
    if (seen.view.scene.isGaussian3d()) {
        // Splats that fall between pixels are newcomers only for the device, and this cloud is full of them.
        CHECK(other_kinds <= 2);  // measured: two, in two of these frames
        CHECK(std::abs(exchanged_error) <= 0.03 * chosen_error);
        CHECK(other_classes <= 4);  // measured: three, canted
        return;
    }
    // With canted eyes, one disc that comes through the near plane is a newcomer only for the twin: the
    // device's bounds of such discs are wider, so the dominant eye sees it. For the cost of its tile the
    // device renders another one, in place of a third.
    CHECK(other_kinds <= (canted ? 3 : 1));  // measured: three and one, each in one of all these frames
    // Measured: 0.0063, from the tile that the twin's budget just reached.
    if (!canted) { CHECK(std::abs(exchanged_error) <= 0.01 * chosen_error); }
    CHECK(other_classes <= 2);  // measured: none
}

// Checks every second frame, starting with the first or the second.
void checkEverySecond(const Context& context, std::size_t first) {
    std::size_t number = first;
    for (const View& seen : makeViews()) {
        KeptFrame frame(context, seen.view.scene);
        for (const Side dominant : {kLeft, kRight}) {
            const Image full = toImage(reference::render(seen.view.scene, seen.eyes[1 - dominant], {}));
            for (const Making& making : kMakings) {
                if (number++ % 2 == 0) { checkIsTwins(frame, seen, dominant, making, full); }
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "the device's stereo frames are the twin's, but for places that are rounded") {
    checkEverySecond(context(), 0);
}

TEST_CASE_FIXTURE(Gpu, "the device's other stereo frames are the twin's, too" * nightly()) {
    checkEverySecond(context(), 1);
}

}  // SUITE(stereo_twin)
