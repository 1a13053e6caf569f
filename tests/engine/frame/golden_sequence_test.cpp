// Pictures that must not change: the last pair of a walk whose frames are made from the ones before, the twin's.
#include "engine/frame/changes.h"
#include "engine/reference/past.h"
#include "engine/stream/moving_scene.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/frame/golden_files.h"

#include <array>
#include <cmath>
#include <span>
#include <vector>

TEST_SUITE_BEGIN("golden");

namespace golden_sequence_test {

#ifdef BINOSPLAT_HAS_PNG

using namespace binosplat;
using test::Gpu;
using test::ViewedScene;

namespace {

// Longer walks come apart: one tile in the 70 that float32 prices otherwise is another picture from then on.
constexpr int kFrames = 6;
// In the first frame, where the right eye would be made from the left one, all of it.
constexpr double budgetOf(int frame) { return frame == 0 ? 1.0 : 0.2; }
// A tile that float32 prices just otherwise is rendered a frame earlier or later.
constexpr double kLeastDb = 45.0;

ViewedScene viewWalk() { return test::viewBuiltin("builtin:atelier", {112, 80}, 20000); }

// A head that walks by 3 mm a frame, sways and looks around.
std::array<Eye, 2> eyesAt(const Eye& start, int frame) {
    Eye eye = start;
    const glm::dvec3 step(0.003 * frame, 0.004 * std::sin(0.5 * frame), 0.001 * frame);
    eye.world_from_camera.position += eye.world_from_camera.orientation * step;
    eye.world_from_camera.orientation = eye.world_from_camera.orientation * glm::angleAxis(0.003 * frame, glm::dvec3(0, 1, 0)) *
                                        glm::angleAxis(0.01 * std::sin(0.3 * frame), glm::dvec3(1, 0, 0));
    return stereoPair(eye, 0.063);
}

struct FullEye {
    reference::Picture picture;
    std::vector<std::uint64_t> costs;  // pairs of each tile
};
FullEye renderFull(const Scene& scene, const Eye& eye) {
    const reference::Settings settings{.inverse_depth_moments = true};
    const auto visible = reference::cull(scene, {&eye, 1}, settings);
    const auto order = reference::sortDepth(reference::compact(scene, visible, eye, settings), settings);
    const auto splats = reference::project(scene, order, eye, settings);
    auto pairs = reference::bin(splats, eye.size_px, settings);
    reference::sortTiles(pairs, settings);
    const auto ranges = reference::tileRanges(pairs, eye.size_px);
    FullEye full{reference::rasterize(splats, pairs, ranges, eye, settings), {}};
    for (const reference::TileRange& range : ranges) { full.costs.push_back(range.end - range.begin); }
    return full;
}

// Renders the tiles again that are worth most, of all of these together.
void mend(const Scene& scene, std::span<reference::Past> warped, double budget) {
    std::vector<std::vector<reference::TileKind>> kinds;
    std::vector<std::vector<std::optional<std::uint32_t>>> prices;
    std::vector<std::vector<std::uint64_t>> costs;
    std::uint64_t picture_cost = 0;
    for (reference::Past& past : warped) {
        reference::growErrors(past.tiles);
        std::vector<double> errors;
        costs.emplace_back();
        for (const reference::PastTile& tile : past.tiles) {
            errors.push_back(reference::worthOf(tile));
            costs.back().push_back(reference::costOf(tile));
            picture_cost += costs.back().back();
        }
        kinds.emplace_back(errors.size(), reference::TileKind::kNone);
        prices.push_back(reference::price(kinds.back(), errors, costs.back()));
    }
    std::vector<reference::PricedTiles> priced;
    for (std::size_t e = 0; e < warped.size(); ++e) { priced.push_back({kinds[e], prices[e], costs[e]}); }
    reference::selectTogether(priced, static_cast<std::uint64_t>(budget * static_cast<double>(picture_cost)));
    for (std::size_t e = 0; e < warped.size(); ++e) {
        const FullEye full = renderFull(scene, warped[e].eye);
        reference::renderTiles(warped[e], full.picture, full.costs, kinds[e]);
    }
}

reference::Past pastOf(const Scene& scene, const Eye& eye) {
    const FullEye full = renderFull(scene, eye);
    return reference::pastOf(eye, full.picture, full.costs);
}

std::array<Image, 2> walkOfTwin(Mode mode, const ViewedScene& view) {
    const auto eyes = eyesAt(view.eye, kFrames);
    std::array<Image, 2> pair;
    if (mode == Mode::kAlternate) {
        // The right eye was rendered in the first frame after the one that rendered both, so that in the last it is the left one's turn.
        static_assert(kFrames % 2 == 0);
        const reference::Past right = pastOf(view.scene, eyesAt(view.eye, kFrames - 1)[kRight]);
        return {test::toImage(renderFull(view.scene, eyes[kLeft]).picture),
                test::toImage(view.eye.size_px, reference::warpPast(right, eyes[kRight]).picture.rgba)};
    }
    const auto first = eyesAt(view.eye, 0);
    std::array<reference::Past, 2> pasts{pastOf(view.scene, first[kLeft]), pastOf(view.scene, first[kRight])};
    for (int frame = 1; frame <= kFrames; ++frame) {
        const auto at = eyesAt(view.eye, frame);
        for (std::size_t e = 0; e < 2; ++e) { pasts[e] = reference::warpPast(pasts[e], at[e]).picture; }
        mend(view.scene, pasts, budgetOf(frame));
    }
    for (std::size_t e = 0; e < 2; ++e) { pair[e] = test::toImage(view.eye.size_px, pasts[e].rgba); }
    return pair;
}

// With a gaze half of the resolution is where it does not look.
std::array<Image, 2> walkOfDevice(const Context& context, Mode mode, const ViewedScene& view, const std::optional<Gaze>& gaze = {}) {
    const GpuScene scene(context, view.scene);
    StereoFrame frame(context, scene);
    const test::KeptKernels kept(context, frame);
    FrameSettings settings;
    settings.mode = mode;
    settings.keep_past = true;
    settings.half_periphery = gaze.has_value();
    settings.gazes = {gaze, gaze};
    for (int i = 0; i <= kFrames; ++i) {
        settings.stereo.budget = budgetOf(i);
        const FrameResult result = frame.render(eyesAt(view.eye, i), settings);
        if (gaze) { CHECK(result.counters.periphery.value().half_tiles > 0); }
    }
    return {frame.readPicture(kLeft), frame.readPicture(kRight)};
}

// Left and right beside each other.
Image besideEachOther(const std::array<Image, 2>& pair) {
    const glm::uvec2 size_px = pair[0].size_px;
    Image both{{2 * size_px.x, size_px.y}, pair[0].channels, {}};
    const auto row_values = static_cast<std::ptrdiff_t>(size_px.x) * pair[0].channels;
    for (std::ptrdiff_t y = 0; y < static_cast<std::ptrdiff_t>(size_px.y); ++y) {
        for (const Image& image : pair) {
            const auto row = image.values.begin() + y * row_values;
            both.values.insert(both.values.end(), row, row + row_values);
        }
    }
    return both;
}

// Of builtin:clockwork, from where what moves is a part of the picture; it goes on with every second frame.
Scene clockworkAt(int frame) { return makeBuiltin("builtin:clockwork", 0, {}, static_cast<std::uint64_t>(frame / 2)); }
constexpr double kClockworkRate = 45.0, kDisplayRate = 90.0;

Eye clockworkEye() {
    Eye eye = test::eyeOf(*builtinView("clockwork"), {112, 80});
    eye.world_from_camera.position += eye.world_from_camera.orientation * glm::dvec3(-0.6, 0.0, -1.5);
    eye.world_from_camera.orientation = eye.world_from_camera.orientation * glm::angleAxis(0.5, glm::dvec3(0, 1, 0));
    return eye;
}

std::array<Image, 2> clockworkOfTwin() {
    constexpr double kNear = 0.2;
    const Eye start = clockworkEye();
    Scene scene = clockworkAt(0);
    const SceneTraits traits = traitsOf(scene);
    SceneFrame packed = makeSceneFrame(scene, traits);
    const auto first = eyesAt(start, 0);
    std::array<reference::Past, 2> pasts{pastOf(scene, first[kLeft]), pastOf(scene, first[kRight])};
    for (int frame = 1; frame <= kFrames; ++frame) {
        const auto at = eyesAt(start, frame);
        scene = clockworkAt(frame);
        SceneFrame next = makeSceneFrame(scene, traits, packed);
        const std::vector<SceneChange> changes = differenceOf(packed, next, traits).changes;
        packed = std::move(next);
        double share = 0.0;
        for (std::size_t e = 0; e < 2; ++e) {
            pasts[e] = reference::warpPast(pasts[e], at[e]).picture;
            std::vector<reference::ChangedRect> rects;
            for (const gpu::ChangedRect& rect : rectsOf(changes, at[e], kNear)) {
                rects.push_back({rect.begin_px, rect.end_px, static_cast<double>(rect.error)});
            }
            reference::markChanged(pasts[e].tiles, at[e].size_px, rects);
            share += 0.5 * changedShare(changes, at[e], kNear);
        }
        CHECK(share < 0.4);  // otherwise there would be no past
        CHECK((share > 0.1) == (frame % 2 == 0));
        // See StereoFrame::prepare.
        mend(scene, pasts, std::max(budgetOf(frame), 1.2 * share + 0.5 * budgetOf(frame)));
    }
    return {test::toImage(start.size_px, pasts[kLeft].rgba), test::toImage(start.size_px, pasts[kRight].rgba)};
}

std::array<Image, 2> clockworkOfDevice(const Context& context) {
    MovingScene moving(context, SceneSeries("builtin:clockwork"), {.rate_hz = kClockworkRate, .memory_bytes = 1});
    StereoFrame frame(context, moving.scene());
    const test::KeptKernels kept(context, frame);
    FrameSettings settings;
    settings.mode = Mode::kTemporal;
    settings.keep_past = true;
    for (int i = 0; i <= kFrames; ++i) {
        moving.setTime(i / kDisplayRate);
        moving.settle({});
        settings.stereo.budget = budgetOf(i);
        frame.render(eyesAt(clockworkEye(), i), settings);
    }
    return {frame.readPicture(kLeft), frame.readPicture(kRight)};
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "the last pair of a walk past a scene that moves is what twin and device come to") {
    const Image twin = besideEachOther(clockworkOfTwin()), device = besideEachOther(clockworkOfDevice(context()));
    const Image expected = test::readGolden("walk-clockwork", twin);
    MESSAGE(compare(expected, twin).psnrDb() << " and " << compare(expected, device).psnrDb() << " dB");
    test::checkGolden("walk-clockwork", expected, twin, "twin", kLeastDb);
    test::checkGolden("walk-clockwork", expected, device, "device", kLeastDb);
    // What moved is where it is now, not where it was.
    const auto eyes = eyesAt(clockworkEye(), kFrames);
    const auto fullOf = [&](const Scene& scene) {
        return besideEachOther(
            {test::toImage(renderFull(scene, eyes[kLeft]).picture), test::toImage(renderFull(scene, eyes[kRight]).picture)});
    };
    const double now_db = compare(fullOf(clockworkAt(kFrames)), device).psnrDb();
    CHECK(now_db > 35.0);
    CHECK(compare(fullOf(clockworkAt(kFrames - 2)), device).psnrDb() < now_db - 5.0);
}

TEST_CASE_FIXTURE(Gpu, "the last pair of a walk is what twin and device come to") {
    const ViewedScene view = viewWalk();
    for (const auto& [mode, name] :
         {std::pair(Mode::kTemporal, std::string("walk-temporal")), std::pair(Mode::kAlternate, std::string("walk-alternate"))}) {
        const Image twin = besideEachOther(walkOfTwin(mode, view)), device = besideEachOther(walkOfDevice(context(), mode, view));
        const Image expected = test::readGolden(name, twin);
        MESSAGE(name << ": " << compare(expected, twin).psnrDb() << " and " << compare(expected, device).psnrDb() << " dB");
        test::checkGolden(name, expected, twin, "twin", kLeastDb);
        test::checkGolden(name, expected, device, "device", kLeastDb);
        // It is not merely the full render.
        const auto eyes = eyesAt(view.eye, kFrames);
        const Image full = besideEachOther(
            {test::toImage(renderFull(view.scene, eyes[kLeft]).picture), test::toImage(renderFull(view.scene, eyes[kRight]).picture)});
        CHECK(compare(full, device).psnrDb() > 30.0);
        CHECK(compare(full, device).psnrDb() < kLeastDb);
    }
}

// Its passes have twins of their own, see periphery_past_test.
TEST_CASE_FIXTURE(Gpu, "the last pair of a walk in two pictures an eye is what it was") {
    const ViewedScene view = test::viewBuiltin("builtin:atelier", {160, 112}, 20000);
    const Gaze aside{{-3.0, 1.0, -2.0}, 0.0};  // so few pixels show less than an eye resolves but far from where it looks
    const Image device = besideEachOther(walkOfDevice(context(), Mode::kTemporal, view, aside));
    const Image expected = test::readGolden("walk-temporal-half", device);
    MESSAGE(compare(expected, device).psnrDb() << " dB");
    test::checkGolden("walk-temporal-half", expected, device, "device", kLeastDb);
    const auto eyes = eyesAt(view.eye, kFrames);
    const Image full = besideEachOther(
        {test::toImage(renderFull(view.scene, eyes[kLeft]).picture), test::toImage(renderFull(view.scene, eyes[kRight]).picture)});
    MESSAGE(compare(full, device).psnrDb() << " dB to the full render");
    CHECK(compare(full, device).psnrDb() > 30.0);
    CHECK(compare(full, device).psnrDb() < kLeastDb);
}

#endif

}  // namespace golden_sequence_test
