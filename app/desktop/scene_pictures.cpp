// Frames of the window's scene, and of the one beside it.
#include "app/desktop/scene_pictures.h"

#include "app/options/modes.h"
#include "engine/error.h"
#include "engine/places/standpoint.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binosplat {

namespace {

constexpr double kRestSeconds = 0.15, kSmoothSeconds = 0.4;  // without a change, before these refinements
// Four samples per pixel, a quarter of the picture at a time: each takes about as long as a picture with one
// sample. If that is longer, the window would not answer for too long.
constexpr double kSmoothScale = 2.0, kMostQuarterMs = 1000.0;
constexpr double kMostSmoothPixels = 4.0 * 3840.0 * 2160.0;  // of the samples
constexpr double kNoPictureSeconds = 0.002;
// Share of the distance to the centre, so that the near plane is nearer than usual if the camera is close.
constexpr double kNearShare = 0.05;

double secondsSince(std::chrono::steady_clock::time_point then) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

}  // namespace

FramesAhead framesInMotion(const ViewSettings& settings, glm::uvec2 size_px) {
    StereoOptions stereo = settings.stereo;
    if (!showsTwoEyes(settings.window_stereo)) { stereo.mode = Mode::kMono; }
    stereo.foveation_deg = 0.0;
    stereo.half_periphery = false;
    return {stereo, size_px, /*with_depth*/ true, settings.tint, {}};
}

bool becomesSmooth(SmoothAtRest wish, double samples, glm::uvec2 part_px, double picture_ms) {
    const bool fits =
        samples <= kSmoothScale && samples * samples * part_px.x * part_px.y <= kMostSmoothPixels;
    return fits &&
           (wish == SmoothAtRest::kOn || (wish == SmoothAtRest::kAuto && picture_ms < kMostQuarterMs));
}

void ScenePictures::forget() {
    shown_.forget();
    drawn_ = {};
    motion_ = MotionScale(context_.isSoftware());
}

void ScenePictures::beginComparison() {
    if (!other_) { other_.emplace(context_); }
    other_->forget();
}

double ScenePictures::secondsToNext() const {
    const auto changes = [](const LoadedScene* scene) {
        return scene != nullptr && scene->live &&
               (!scene->live->isSettled() || (scene->moving != nullptr && scene->clock.plays()));
    };
    if (std::ranges::any_of(both(), changes)) { return kNoPictureSeconds; }
    return secondsToRefine().value_or(std::numeric_limits<double>::infinity());
}

double ScenePictures::samples() const { return kSmoothScale * state_.settings().resolution_scale; }

bool ScenePictures::smooths() const {
    return becomesSmooth(state_.settings().window_smooth, samples(), drawn_.part_px,
                         shown_.lastFrame().gpu_total_ms);
}

std::optional<double> ScenePictures::secondsToRefine() const {
    if (refinement_ == Refinement::kSmooth || (refinement_ == Refinement::kFull && !smooths())) { return {}; }
    const double rest = refinement_ == Refinement::kMoving ? kRestSeconds : kSmoothSeconds;
    return std::max(rest - secondsSince(changed_at_), 0.0);
}

bool ScenePictures::draw(const OrbitCamera& camera, const WindowLayout& layout, double seconds,
                         double refresh_hz) {
    scenes_.follow(eyesOf(camera, layout.sight, layout.partPx()), seconds);
    for (LoadedScene* const scene : both()) {
        if (scene == nullptr || !scene->live) { continue; }
        for (const std::string& line : scene->live->takeLines(Waits::kNever)) { say_(line); }
        moment_ += scene->live->isSettled() ? 0 : 1;
    }
    const auto frameOf = [](const LoadedScene* scene) { return scene != nullptr ? scene->clock.frame() : 0; };
    Sight sight{both(),
                camera,
                layout.partPx(),
                state_.settings(),
                {frameOf(scenes_.get()), frameOf(scenes_.other())},
                moment_};
    sight.settings.page = {};  // these change nothing in the scene
    sight.settings.panel = {};
    if (!(sight == drawn_)) {
        drawn_ = std::move(sight);
        refinement_ = Refinement::kMoving;
        changed_at_ = Clock::now();
        render(layout, motion_.scale(), false, refresh_hz);
        return true;
    }
    const std::optional<double> seconds_left = secondsToRefine();
    if (!seconds_left || (*seconds_left > 0.0 && !is_file_asked_)) { return false; }
    if (refinement_ == Refinement::kFull && !is_file_asked_) { return smoothOn(); }
    refinement_ = Refinement::kFull;
    render(layout, 1.0, true, refresh_hz);
    if (std::exchange(is_file_asked_, false)) { writeFile(layout); }
    return true;
}

void ScenePictures::render(const WindowLayout& layout, double scale, bool at_rest, double refresh_hz) {
    drawn_sight_ = layout.sight;
    const double gpu_ms = renderWhole(scale, at_rest);
    motion_.measure(0.001 * static_cast<double>(shown_.lastFrame().mark), gpu_ms, refresh_hz);
}

double ScenePictures::renderWhole(double scale, bool at_rest) {
    quarters_ = 0;
    const double resolution = scale * state_.settings().resolution_scale;
    const glm::uvec2 size_px =
        glm::max(glm::uvec2(glm::round(resolution * glm::dvec2(drawn_.part_px))), glm::uvec2(16));
    FrameSettings settings = settingsFor(at_rest);
    settings.mark = static_cast<std::uint64_t>(std::lround(1000.0 * resolution));
    double gpu_ms = 0.0;
    renderBoth(eyesOf(drawn_.camera, drawn_sight_, size_px),
               [&](DesktopPictures& pictures, StereoFrame& frame, const std::vector<Eye>& eyes) {
                   pictures.render(frame, eyes, settings, drawn_sight_.stereo, at_rest);
                   gpu_ms += pictures.lastFrame().gpu_total_ms;
               });
    return gpu_ms;
}

void ScenePictures::renderBoth(std::vector<Eye> eyes,
                               const std::function<void(DesktopPictures& pictures, StereoFrame& frame,
                                                        const std::vector<Eye>& eyes)>& draw) {
    draw(shown_, scenes_.frame(), eyes);
    if (scenes_.other() == nullptr) { return; }
    try {
        for (Eye& eye : eyes) { eye.world_from_camera.position += scenes_.otherFromShown(); }
        draw(*other_, scenes_.otherFrame(), eyes);
    } catch (const vk::DeviceLostError&) { throw; } catch (const Error& error) {
        say_(scenes_.goOnAlone(error));
    }
}

bool ScenePictures::smoothOn() {
    if (quarters_ < 4) {
        std::vector<Eye> eyes = eyesOf(drawn_.camera, drawn_sight_, drawn_.part_px);
        for (Eye& eye : eyes) { eye = quarterOf(eye, drawn_.part_px, quarters_, samples()); }
        renderBoth(std::move(eyes),
                   [&](DesktopPictures& pictures, StereoFrame& frame, const std::vector<Eye>& seen) {
                       pictures.renderQuarter(quarters_, frame, seen, settingsFor(true), drawn_sight_.stereo);
                   });
        ++quarters_;
        return false;
    }
    takeBackQuarters();
    refinement_ = Refinement::kSmooth;
    shown_.showQuarters();
    if (scenes_.other() != nullptr) { other_->showQuarters(); }
    return true;
}

void ScenePictures::takeBackQuarters() {
    if (quarters_ > 0) { renderWhole(1.0, true); }
}

FrameSettings ScenePictures::settingsFor(bool at_rest) const {
    const ViewSettings& settings = state_.settings();
    FrameSettings frame = frameSettings(options_, framesInMotion(settings, {}).stereo, kWearersOrder);
    if (at_rest && frame.mode != Mode::kMono && !settings.tint) { frame.mode = Mode::kShared; }
    const double size = scenes_.get()->facts.size_units,
                 usual = size > 0.0 ? kUsualNear * std::min(size, 1.0) : kUsualNear;
    frame.near = options_.near.value_or(std::min(usual, kNearShare * drawn_.camera.distance()));
    // The largest quarter, which is as large as the whole with one sample per pixel.
    frame.most_px = quarterOf({}, drawn_.part_px, 3, samples()).size_px;
    frame.half_floats = frame.surface_depths = true;
    frame.keep_both_depths = true;
    frame.keep_classes = settings.tint;
    frame.keep_history = !at_rest;
    frame.times_passes = settings.page == PanelPage::kMethod;
    if (settings.backdrop != Backdrop::kAsSet) { frame.background = colourOf(settings.backdrop); }
    return frame;
}

void ScenePictures::writeFile(const WindowLayout& layout) {
    const bool both = state_.settings().picture_both_eyes;
    WindowSight sight = layout.sight;
    sight.stereo = both ? WindowStereo::kSideBySide : WindowStereo::kMono;
    FrameSettings settings = settingsFor(true);
    settings.mode = both ? Mode::kShared : Mode::kMono;
    settings.keep_classes = false;
    scenes_.draw(curtain_.isAway());  // of the other one, if it fills the window
    PictureShot shot =
        scenes_.shotOf(scenes_.seenFromDrawn(eyesOf(drawn_.camera, sight, layout.area_px)), settings);
    if (smooths()) { shot.smoothen(); }
    writer_.begin(std::move(shot), scenes_.drawn()->name);
    say_("saving a picture");
    scenes_.draw(false);
}

void ScenePictures::keep(SceneNotes& notes) {
    if (scenes_.get() == nullptr || shown_.eyes().empty()) { return; }
    try {
        takeBackQuarters();
        notes.keepPicture(*scenes_.get(), [picture = scenes_.frame().readPicture(0)] { return picture; });
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError&) {
        // A missing picture is not worth a message.
    } catch (const Error&) {}
}

void ScenePictures::compose(Commands& commands, vk::Image window, const std::vector<EyePart>& parts) {
    if (scenes_.get() == nullptr) { return; }
    const bool compares = scenes_.other() != nullptr;
    if (!compares || !curtain_.isAway()) { shown_.compose(commands, window, parts); }
    if (!compares) { return; }
    changeLayout(commands, window, vk::ImageLayout::eTransferDstOptimal,
                 vk::ImageLayout::eTransferDstOptimal);
    other_->compose(commands, window, parts, curtain_.share());
    if (!curtain_.isAway()) { curtain_.compose(commands, window, parts); }
}

std::optional<glm::dvec3> ScenePictures::seenAt(const std::vector<EyePart>& parts,
                                                const glm::dvec2& place_px) {
    const std::optional<EyePart> part = partAt(parts, place_px);
    if (!part || shown_.eyes().empty()) { return std::nullopt; }
    takeBackQuarters();
    const int e = shown_.eyes().size() == 1 ? 0 : part->eye;
    const Eye& eye = shown_.eyes()[static_cast<std::size_t>(e)];
    const glm::dvec2 pixel =
        (place_px - glm::dvec2(part->at_px)) * glm::dvec2(eye.size_px) / glm::dvec2(part->size_px);
    const bool is_other = scenes_.other() != nullptr && curtain_.isOtherAt(parts, place_px);
    const std::optional<double> depth = (is_other ? scenes_.otherFrame() : scenes_.frame())
                                            .depthAt(e, glm::min(glm::uvec2(pixel), eye.size_px - 1u));
    return depth ? std::optional(pointAt(eye, pixel, *depth)) : std::nullopt;
}

}  // namespace binosplat
