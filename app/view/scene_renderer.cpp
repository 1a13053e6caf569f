// A frame of the scene for the headset.
#include "app/view/scene_renderer.h"

#include "app/options/modes.h"
#include "app/view/placement/view_eyes.h"

#include <utility>

namespace binosplat {

namespace {

glm::uvec2 scaledSize(const xr::Instance& instance, double scale) {
    const glm::dvec2 wanted = glm::round(scale * glm::dvec2(instance.recommendedSizePx()));
    return glm::clamp(glm::uvec2(wanted), glm::uvec2(16), instance.maxSizePx());
}

glm::dvec3 colourOf(Backdrop backdrop) { return glm::dvec3(backdrop == Backdrop::kWhite ? 1.0 : backdrop == Backdrop::kGrey ? 0.5 : 0.0); }

}  // namespace

SceneRenderer::SceneRenderer(const xr::Instance& instance, const Context& context, const RunOptions& options, const FrameLog& log,
                             vk::Format format)
    : instance_(instance), options_(options), log_(log), format_(format), presenter_(context, format) {
    presenter_.makeKernels(instance.takesDepth(), instance.canSeeThrough());
}

glm::uvec2 SceneRenderer::sizePx(const ViewSettings& settings) const { return scaledSize(instance_, settings.resolution_scale); }

void SceneRenderer::fitImages(ConnectedHeadset& headset, const ViewSettings& settings) {
    const glm::uvec2 size_px = sizePx(settings);
    if (!headset.images) { return makeImages(headset, size_px); }
    const glm::uvec2 before_px = headset.images->sizePx();
    if (before_px == size_px) { return; }
    try {
        makeImages(headset, size_px);
    } catch (const Error&) {
        makeImages(headset, before_px);
        throw;
    }
}

void SceneRenderer::makeImages(ConnectedHeadset& headset, glm::uvec2 size_px) {
    headset.images.reset();  // first, since both may not fit
    headset.images = std::make_unique<EyeImages>(headset.session, presenter_, format_, size_px);
    if (!takes_depth_) { headset.images->dropDepth(); }
}

void SceneRenderer::govern(ConnectedHeadset& headset, const ViewSettings& settings) {
    governor_.wish(settings.quality, settings.stereo.mode, {settings.stereo.budget, settings.resolution_scale});
    fitImages(headset, settings);
    if (governor_.settings() != std::exchange(governed_, governor_.settings())) { ++governed_count_; }
    headset.images->draw(scaledSize(instance_, governor_.settings().resolution_scale));
}

ShownRate SceneRenderer::rate() const {
    ShownRate rate{met_.metHz(), met_.displayHz(), governor_.settings().resolution_scale, {}, governor_.isBeaten()};
    if (hasBudget(frame_.mode)) { rate.budget = governor_.settings().budget; }
    return rate;
}

bool SceneRenderer::dropDepth(ConnectedHeadset& headset) {
    headset.images->dropDepth();
    return std::exchange(takes_depth_, false);
}

FrameSettings SceneRenderer::settingsOfFrame(ConnectedHeadset& headset, const ViewSettings& settings, double scale, const FrameViews& views,
                                             Order usual_order) {
    StereoOptions stereo = settings.stereo;
    stereo.budget = governor_.settings().budget;
    FrameSettings frame = frameSettings(options_.camera, stereo, usual_order);
    // Of the wearer, however large the scene is.
    frame.near = options_.camera.near * scale;
    frame.units_per_metre = scale;
    frame.dominant = settings.stereo.dominant;
    frame.keep_depth = frame.keep_both_depths = headset.images->takesDepth();
    frame.half_floats = true;
    frame.keep_classes = settings.tint;
    frame.square_boxes = false;
    frame.gazes = views.gazes;
    frame.mark = governed_count_;
    frame.keep_past = true;
    if (settings.backdrop != Backdrop::kAsSet) { frame.background = colourOf(settings.backdrop); }
    if (seesThrough(settings)) { frame.background = glm::dvec3(0.0); }
    // One eye's picture for both is seen through either lens.
    if (!settings.showsOneEye() && settings.visibility_mask) {
        frame.hidden_tiles = headset.lens_mask.update(headset.session.hiddenMeshes(), headset.session.hiddenMeshVersion(), views.eyes,
                                                      headset.images->partPx());
    }
    return frame;
}

void SceneRenderer::prepare(ConnectedHeadset& headset, LoadedScene& scene, const Similarity& scene_from_room, const ViewSettings& settings,
                            const FrameViews& views) {
    frame_ = settingsOfFrame(headset, settings, scene_from_room.scale, views, scene.gpu_scene.usualOrder());
    eyes_.clear();
    for (const int e : {kLeft, kRight}) {
        if (settings.showsOneEye() && e != frame_.dominant) { continue; }
        const auto at = static_cast<std::size_t>(e);
        eyes_.push_back(eyeInScene(scene_from_room, views.room_from_eyes[at], views.eyes[at].fov, headset.images->partPx()));
    }
    try {
        scene.frame.makeRoom(eyes_, frame_);
        presenter_.makeRoom(headset.images->partPx(), headset.images->takesDepth());
    } catch (const Error&) {
        forgetLastFrame();
        throw;
    }
}

void SceneRenderer::render(ConnectedHeadset& headset, LoadedScene& scene, const ViewSettings& settings, MirrorWindow* window,
                           const std::function<void(Commands&)>& record_panel) {
    const bool one_eye = settings.showsOneEye();
    headset.images->seeThrough(seesThrough(settings));
    for (const int e : {kLeft, kRight}) {
        if (!one_eye || e == frame_.dominant) { headset.images->acquire(e, true); }
    }
    std::optional<FrameResult> known = scene.frame.renderAhead(
        eyes_, frame_,
        [&](Commands& commands) {
            recordEyes(commands, headset, scene, frame_, settings.tint, window);
            record_panel(commands);
        },
        window != nullptr ? window->drawn() : vk::Semaphore());
    const bool is_of_now = known && known->mark == governed_count_;
    if (known) { last_ = std::move(*known); }
    met_.add(headset.session.periodMs(), headset.session.lostPeriods());
    governor_.measure({.gpu_ms = last_.gpu_total_ms,
                       .period_ms = headset.session.periodMs(),
                       .is_old = !is_of_now,
                       .lost_periods = headset.session.lostPeriods(),
                       .work = last_.work_rendered});
    sayGoverned();
    sayHidden(one_eye);
    sayCutShort();
}

void SceneRenderer::recordEyes(Commands& commands, ConnectedHeadset& headset, LoadedScene& scene, const FrameSettings& frame, bool tint,
                               MirrorWindow* window) {
    for (const int e : {kLeft, kRight}) {
        const bool dominant = e == frame.dominant;
        if (frame.mode == Mode::kMono && !dominant) { continue; }
        const Picture& image = scene.frame.picture(frame.mode == Mode::kMono ? 0 : e);
        headset.images->present(commands, e, image, tint ? scene.frame.chosenTiles(e) : nullptr, frame.near);
        // The window shows the dominant eye, or what is made of it where that is the point.
        const bool shown = frame.mode == Mode::kMono || dominant != tint;
        if (window != nullptr && window->drawn() && shown) {
            window->keepEye(commands, presenter_.pixels(), headset.images->partPx(), format_);
        }
    }
}

void SceneRenderer::sayGoverned() {
    const bool is_other = governor_.settings() != governed_;
    if (is_other || (governor_.isBeaten() && !said_beaten_)) { log_.say(governor_.sentence()); }
    // Once for the same settings, though frames may fit now and then.
    said_beaten_ = governor_.isBeaten() || (said_beaten_ && !is_other);
}

void SceneRenderer::sayCutShort() {
    const std::uint64_t now = last_.counters.ahead ? last_.counters.ahead->frames_cut_short : 0;
    if (now > std::exchange(cut_short_, now)) { log_.say(fmt::format("frames shown incomplete because a list was full: {}", now)); }
}

void SceneRenderer::sayHidden(bool one_eye) {
    const std::vector<TargetCounters>& targets = last_.counters.targets;
    if (one_eye || targets.size() != 2) { return; }
    const std::array<std::uint64_t, 2> hidden{targets[kLeft].tiles_hidden, targets[kRight].tiles_hidden};
    // None, where the lenses hid some before: that frame was for a picture.
    if (hidden == std::array<std::uint64_t, 2>{} || std::exchange(hidden_tiles_, hidden) == hidden) { return; }
    log_.say(fmt::format("the lenses hide {} and {} of {} tiles", hidden[kLeft], hidden[kRight], targets[kLeft].tiles));
}

}  // namespace binosplat
