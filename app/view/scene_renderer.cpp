// A frame of the scene for the headset.
#include "app/view/scene_renderer.h"

#include "app/options/modes.h"
#include "app/view/placement/view_eyes.h"

#include <algorithm>
#include <utility>

namespace binosplat {

SceneRenderer::SceneRenderer(const xr::Instance& instance, const Context& context, const RunOptions& options,
                             const FrameLog& log, vk::Format format)
    : instance_(instance),
      context_(context),
      options_(options),
      log_(log),
      format_(format),
      presenter_(context, format),
      has_gpu_(!context.isSoftware()) {
    if (const std::optional<xr::InsetSizes> inset = xr::findInset(instance)) {
        context_px_ = inset->context_px;
    }
    presenter_.makeKernels();
}

ShownRate SceneRenderer::rate() const {
    ShownRate rate{met_.metHz(), met_.displayHz(),    met_.late(), governed_.resolution_scale, {},
                   {},           governor_.isBeaten()};
    const bool renders_both = frame_.mode == Mode::kPredicted && hasCoarseTiles(frame_, 2);
    if (governed_.error_bound_db > 0.0 && frame_.mode == Mode::kTemporal) {
        rate.bound_db = governed_.error_bound_db;
    } else if (hasBudget(frame_.mode) && !renders_both) {
        rate.budget = governed_.budget;
    }
    return rate;
}

void SceneRenderer::meetDisplay(const xr::Session& session) {
    const double period_ms = session.periodMs();
    met_.add(session.displayTime(), period_ms, session.followsShown());
    const bool is_late = met_.late() > 0;
    if (std::exchange(is_late_, is_late) || !is_late) { return; }
    const FrameCost cost{last_.gpu_total_ms, 1e3 * session.busySeconds(), 1e3 * session.openSeconds()};
    log_.say(
        fmt::format("a frame was late (a display takes {:.1f} ms): {}", period_ms, whyLate(cost, period_ms)));
}

bool SceneRenderer::dropDepth(ConnectedHeadset& headset) {
    headset.images->dropDepth();
    if (headset.inset_images) { headset.inset_images->dropDepth(); }
    return std::exchange(takes_depth_, false);
}

glm::dvec3 SceneRenderer::backgroundOf(const ViewSettings& settings, const glm::dvec3& set) const {
    if (seesThrough(settings)) { return glm::dvec3(0.0); }
    return settings.backdrop == Backdrop::kAsSet ? set : colourOf(settings.backdrop);
}

std::vector<glm::uvec2> SceneRenderer::sizesToCome(const ViewSettings& settings) const {
    std::vector<glm::uvec2> sizes_px;
    if (settings.quality == Quality::kOff) { return sizes_px; }
    for (double tenths = 10.0; tenths >= 10.0 * leastScale(settings.quality) - 1e-6; --tenths) {
        sizes_px.push_back(sizePx(governedScale(settings.resolution_scale, tenths)));
    }
    return sizes_px;
}

std::array<std::span<const std::uint8_t>, 2> SceneRenderer::hiddenTiles(ConnectedHeadset& headset,
                                                                        const ViewSettings& settings,
                                                                        const FrameViews& views,
                                                                        glm::uvec2 size_px) const {
    // If both eyes share a picture, it is seen through either lens.
    if (settings.showsOneEye() || !settings.visibility_mask) { return {}; }
    return headset.lens_mask.update(headset.session.hiddenMeshes(), headset.session.hiddenMeshVersion(),
                                    views.eyes, size_px, sizesToCome(settings));
}

bool SceneRenderer::knowsLens(ConnectedHeadset& headset, const ViewSettings& settings,
                              const FrameViews& views) const {
    if (settings.showsOneEye() || !settings.visibility_mask) { return true; }
    const glm::uvec2 size_px = sizePx(settings);
    static_cast<void>(hiddenTiles(headset, settings, views, size_px));
    return headset.lens_mask.knows(size_px);
}

FrameSettings SceneRenderer::settingsOfFrame(ConnectedHeadset& headset, const ViewSettings& settings,
                                             double scale, const FrameViews& views) {
    StereoOptions stereo = settings.stereo;
    stereo.warp.budget = governed_.budget;
    stereo.warp.error_bound_db = governed_.error_bound_db;
    if (headset.inset) { stereo.half_periphery = false; }  // the runtime overlays the inset
    FrameSettings frame = frameSettings(options_.camera, stereo, kWearersOrder);
    // In the wearer's metres, however large the scene is.
    frame.near *= scale;
    frame.units_per_metre = scale;
    frame.keep_depth = frame.keep_both_depths = headset.images->takesDepth();
    frame.half_floats = frame.surface_depths = true;
    frame.keep_classes = settings.tint;
    frame.gazes = views.gazes;
    frame.times_passes = settings.page == PanelPage::kMethod;
    frame.mark = governed_count_;
    frame.measured_part = measured_part_ = (measured_part_ + 1) % gpu::kMeasuredParts;
    frame.keep_history = true;
    frame.waits_for_lists = false;
    frame.most_px = sizes_.images_px;
    frame.background = backgroundOf(settings, frame.background);
    frame.hidden_tiles = hiddenTiles(headset, settings, views, sizes_.view_px);
    sayHidden(frame.hidden_tiles);
    return frame;
}

void SceneRenderer::aim(ConnectedHeadset& headset, const Similarity& scene_from_room,
                        const ViewSettings& settings, FrameViews& views) {
    frame_ = settingsOfFrame(headset, settings, scene_from_room.scale, views);
    eyes_.clear();
    inset_eyes_.clear();
    for (const int e : drawnEyes()) {
        const auto at = static_cast<std::size_t>(e);
        eyes_.push_back(
            eyeInScene(scene_from_room, views.room_from_eyes[at], views.eyes[at].fov, sizes_.view_px));
    }
    seen_ = eyes_;
    if (sizes_.stay) {
        keepAxes(scene_from_room, views);
    } else {
        axes_ = StayingAxes(glm::radians(kAxesMarginDegrees));
    }
    if (headset.inset) { aimInsets(scene_from_room, views); }
}

FramesWanted SceneRenderer::framesWanted(const ConnectedHeadset& headset,
                                         const Similarity& there_from_here) const {
    const auto there = [&](const auto& eyes) {
        std::vector<Eye> moved(eyes.begin(), eyes.end());
        for (Eye& eye : moved) { eye.world_from_camera = transform(there_from_here, eye.world_from_camera); }
        return moved;
    };
    const auto scaled = [&](FrameSettings frame) {
        frame.near *= there_from_here.scale;
        frame.units_per_metre *= there_from_here.scale;
        frame.hidden_tiles = {};
        return frame;
    };
    FramesWanted wanted{there(eyes_), scaled(frame_), {}, {}, {}};
    for (std::size_t e = 0; e < wanted.hidden_tiles.size(); ++e) {
        wanted.hidden_tiles[e].assign(frame_.hidden_tiles[e].begin(), frame_.hidden_tiles[e].end());
    }
    if (headset.inset) {
        wanted.inset_eyes = there(inset_eyes_);
        wanted.inset_settings = scaled(inset_frame_);
    }
    return wanted;
}

FramesWanted SceneRenderer::framesWanted(ConnectedHeadset& headset, const Similarity& scene_from_room,
                                         const ViewSettings& settings, FrameViews views,
                                         const Similarity& there_from_here) {
    const StayingAxes axes = axes_;  // which follow once a frame
    const FrameSizes sizes = sizes_;
    if (const ImagesWanted images = imagesWanted(headset, settings, views); !suit(headset, images)) {
        const glm::uvec2 size_px = headset.images_ahead.sizePx(), inset_px = images.asked.inset_px;
        sizes_ = {images.asked.view_px, size_px, inset_px, inset_px, images.asked.stay};
    }
    aim(headset, scene_from_room, settings, views);
    FramesWanted wanted = std::as_const(*this).framesWanted(headset, there_from_here);
    axes_ = axes;
    sizes_ = sizes;
    return wanted;
}

void SceneRenderer::prepare(ConnectedHeadset& headset, ShownScene& shown, const Similarity& scene_from_room,
                            const ViewSettings& settings, FrameViews& views) {
    aim(headset, scene_from_room, settings, views);
    headset.images->draw(eyes_.front().size_px);
    std::vector<Eye> all = eyes_;
    all.insert(all.end(), inset_eyes_.begin(), inset_eyes_.end());
    shown.follow(all, headset.session.stepSeconds());
    try {
        shown.frame().reserve(eyes_, frame_);
        glm::uvec2 largest_px = headset.images->partPx();
        if (headset.inset) {
            shown.insets().reserve(inset_eyes_, inset_frame_);
            largest_px = glm::max(largest_px, headset.inset_images->partPx());
        } else {
            shown.dropInsets();
        }
        presenter_.reserve(largest_px, headset.images->takesDepth());
    } catch (const Error&) {
        last_ = {};
        eyes_.clear();
        throw;
    }
}

void SceneRenderer::keepAxes(const Similarity& scene_from_room, FrameViews& views) {
    const std::span<const Eye> pictures = axes_.follow(seen_, frame_.hidden_tiles);
    eyes_.assign(pictures.begin(), pictures.end());
    frame_.hidden_tiles = axes_.hiddenTiles();
    frame_.gazes = turnGazes(frame_.gazes, seen_, eyes_);
    for (const int e : drawnEyes()) {
        const auto at = static_cast<std::size_t>(e);
        const Eye& picture = eyes_[frame_.mode == Mode::kMono ? 0 : at];
        views.pictures[at] = pictureInRoom(scene_from_room, picture, views.eyes[at].pose.position);
    }
}

void SceneRenderer::aimInsets(const Similarity& scene_from_room, const FrameViews& views) {
    inset_frame_ = frame_;
    inset_frame_.hidden_tiles = {};
    inset_frame_.gazes = {};
    inset_frame_.most_px = sizes_.inset_images_px;
    for (const int e : drawnEyes()) {
        const auto at = static_cast<std::size_t>(e);
        const Eye& inset = inset_eyes_.emplace_back(
            eyeInScene(scene_from_room, views.room_from_eyes[at], views.insets->at(at).fov, sizes_.inset_px));
        // One low-pass for both, or thin splats would be wider around the inset than within.
        Eye& about = eyes_[inset_eyes_.size() - 1];
        about.own_pixel_px = std::min(about.intrinsics.fx / inset.intrinsics.fx, 1.0);
    }
}

void SceneRenderer::meetOther(const ConnectedHeadset& headset, ShownScene& shown) const {
    shown.meetOther(eyes_, frame_, headset.inset ? inset_eyes_ : std::vector<Eye>(), inset_frame_);
}

PictureShot SceneRenderer::shotOf(const ShownScene& shown, const Similarity& scene_from_room,
                                  const ViewSettings& settings, const FrameViews& views) const {
    StereoOptions stereo = settings.stereo;
    stereo.mode = settings.picture_both_eyes ? Mode::kShared : Mode::kMono;
    stereo.foveation_deg = 0.0;
    FrameSettings frame = frameSettings(options_.camera, stereo, kWearersOrder);
    frame.near *= scene_from_room.scale;
    frame.units_per_metre = scene_from_room.scale;
    frame.half_floats = true;
    frame.background = backgroundOf(settings, frame.background);
    std::vector<Eye> eyes;
    for (const int e : {kLeft, kRight}) {
        if (!settings.picture_both_eyes && e != stereo.dominant) { continue; }
        const auto at = static_cast<std::size_t>(e);
        eyes.push_back(eyeInScene(scene_from_room, views.room_from_eyes[at], views.eyes[at].fov,
                                  instance_.recommendedSizePx()));
    }
    return shown.shotOf(std::move(eyes), frame);
}

void SceneRenderer::render(ConnectedHeadset& headset, ShownScene& shown, const ViewSettings& settings,
                           MirrorWindow* window, const std::function<void(Commands&)>& record_panel) {
    headset.images->seeThrough(seesThrough(settings));
    for (const int e : drawnEyes()) {
        headset.images->acquire(e, settings.submit_depth);
        if (headset.inset) { headset.inset_images->acquire(e, settings.submit_depth); }
    }
    if (headset.inset) {
        headset.inset_images->seeThrough(seesThrough(settings));
        const std::optional<FrameResult> known =
            shown.insets().renderAhead(inset_eyes_, inset_frame_, [&](Commands& commands) {
                recordEyes(commands, *headset.inset_images, shown.insets(), settings.tint, nullptr);
            });
        if (known) { insets_ms_ = known->gpu_total_ms; }
    } else {
        insets_ms_ = 0.0;
    }
    shown.passOver();
    std::optional<FrameResult> known = shown.frame().renderAhead(
        eyes_, frame_,
        [&](Commands& commands) {
            recordEyes(commands, *headset.images, shown.frame(), settings.tint, window);
            record_panel(commands);
        },
        window != nullptr ? window->drawn() : vk::Semaphore());
    const bool is_of_now = known && known->mark == governed_count_ && governed_ == governor_.settings();
    if (known) {
        last_ = std::move(*known);
        last_.gpu_total_ms += insets_ms_;
    }
    LoadedScene& scene = *shown.drawn();
    scene.count(last_.counters);
    if (known && scene.stream) { fitSplats(*scene.stream, headset.session.periodMs()); }
    const GovernedSettings before = governor_.settings();
    governor_.measure({.gpu_ms = last_.gpu_total_ms,
                       .period_ms = headset.session.periodMs(),
                       .is_old = !is_of_now,
                       .lost_periods = headset.session.lostPeriods(),
                       .work = last_.work_rendered,
                       .warp_error = last_.warp_error,
                       .half_loss = last_.half_loss,
                       .is_full = !last_.counters.warped});
    sayGoverned(governor_.settings() != before);
    sayCutShort(shown.drawsOther());
}

void SceneRenderer::recordEyes(Commands& commands, EyeImages& images, const StereoFrame& frame, bool tint,
                               MirrorWindow* window) {
    for (const int e : drawnEyes()) {
        const bool is_mono = frame_.mode == Mode::kMono;
        images.present(commands, e, frame.picture(is_mono ? 0 : e), tint ? frame.chosenTiles(e) : nullptr,
                       frame_.near);
        // The window shows the dominant eye or, with tint, the eye that is made from it.
        const bool shown = is_mono || (e == frame_.dominant) != tint;
        if (window == nullptr || !window->drawn() || !shown) { continue; }
        const std::size_t at = is_mono ? 0 : static_cast<std::size_t>(e);
        const Buffer& pixels = sizes_.stay ? presenter_.turn(commands, images.partPx(), sizes_.view_px,
                                                             pictureFromView(eyes_[at], seen_[at]))
                                           : presenter_.pixels();
        window->keepEye(commands, pixels, sizes_.view_px, images.sizePx(), format_);
    }
}

void SceneRenderer::fitSplats(SceneStream& stream, double period_ms) {
    // A software device is too slow for any number.
    if (options_.load.splat_budget > 0 || !has_gpu_) { return; }
    if (!splat_budget_) { splat_budget_.emplace(stream.mostSplats()); }
    if (splat_budget_->measure(last_.gpu_total_ms, period_ms, last_.counters.splats_read)) {
        stream.setSplatBudget(splat_budget_->splats());
    }
}

void SceneRenderer::sayGoverned(bool is_other) {
    if (is_other || (governor_.isBeaten() && !said_beaten_)) { log_.say(governor_.sentence()); }
    // Once for the same settings, even if frames fit now and then.
    said_beaten_ = governor_.isBeaten() || (said_beaten_ && !is_other);
}

void SceneRenderer::sayCutShort(bool of_other) {
    const std::uint64_t now = last_.counters.ahead ? last_.counters.ahead->frames_cut_short : 0;
    was_cut_short_ = now > std::exchange(cut_short_[of_other ? 1 : 0], now);
    if (was_cut_short_) { log_.say(fmt::format("frames shown incomplete because a list was full: {}", now)); }
}

void SceneRenderer::sayHidden(const std::array<std::span<const std::uint8_t>, 2>& hidden) {
    const std::array<std::uint32_t, 2> tiles{countHidden(hidden[kLeft]), countHidden(hidden[kRight])};
    if (tiles == std::array<std::uint32_t, 2>{} || std::exchange(hidden_tiles_, tiles) == tiles) { return; }
    log_.say(fmt::format("the lenses hide {} and {} of {} tiles", tiles[kLeft], tiles[kRight],
                         hidden[kLeft].size()));
}

}  // namespace binosplat
