// A frame of the scene for the headset.
#include "app/view/scene_renderer.h"

#include "app/options/modes.h"
#include "app/view/placement/view_eyes.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

glm::uvec2 scaledSize(const xr::Instance& instance, glm::uvec2 recommended_px, double scale) {
    const glm::dvec2 wanted = glm::round(scale * glm::dvec2(recommended_px));
    return glm::clamp(glm::uvec2(wanted), glm::uvec2(16), instance.maxSizePx());
}

// For the pictures of both eyes, if axes stay.
glm::uvec2 coverPx(const FrameViews& views, glm::uvec2 view_px) {
    glm::uvec2 size_px(0);
    for (const xr::EyeView& eye : views.eyes) {
        size_px = glm::max(
            size_px, coverOf(eyeInScene({}, {}, eye.fov, view_px), glm::radians(kAxesMarginDegrees)).size_px);
    }
    return size_px;
}

}  // namespace

SceneRenderer::SceneRenderer(const xr::Instance& instance, const Context& context, const RunOptions& options,
                             const FrameLog& log, vk::Format format)
    : instance_(instance),
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

glm::uvec2 SceneRenderer::sizePx(double scale) const {
    return scaledSize(instance_, context_px_.value_or(instance_.recommendedSizePx()), scale);
}

glm::uvec2 SceneRenderer::insetPx(const ConnectedHeadset& headset, double scale) const {
    return headset.inset ? scaledSize(instance_, headset.inset->inset_px, scale) : glm::uvec2(0);
}

bool SceneRenderer::mayStay(const ConnectedHeadset& headset, const ViewSettings& settings,
                            glm::uvec2 cover_px) {
    if (settings.stereo.axes != Axes::kStay) { return false; }
    const glm::uvec2 most_px = instance_.maxSizePx();
    std::string why_not;
    if (headset.inset) {
        why_not = "the headset takes insets";
    } else if (glm::any(glm::greaterThan(cover_px, most_px))) {
        why_not = fmt::format("pictures of {}x{} are larger than the runtime's {}x{}", cover_px.x, cover_px.y,
                              most_px.x, most_px.y);
    }
    if (std::exchange(why_not_, why_not) != why_not && !why_not.empty()) {
        log_.say("axes follow the view: " + why_not);
    }
    return why_not.empty();
}

void SceneRenderer::fitImages(ConnectedHeadset& headset, const ViewSettings& settings,
                              const FrameViews& views) {
    context_px_ = headset.inset ? std::optional(headset.inset->context_px) : std::nullopt;
    const glm::uvec2 view_px = sizePx(settings), inset_px = insetPx(headset, settings.resolution_scale);
    const glm::uvec2 cover_px = coverPx(views, view_px);
    stays_ = mayStay(headset, settings, cover_px);
    const glm::uvec2 least_px = stays_ ? cover_px : view_px;
    // Angles may jitter by the rounding of their float32.
    const glm::uvec2 size_px = stays_ ? glm::min(cover_px + gpu::kTileSize, instance_.maxSizePx()) : view_px;
    const ImagesAsked before = std::exchange(images_asked_, ImagesAsked{view_px, inset_px, stays_});
    if (!headset.images) { return makeImages(headset, size_px, inset_px); }
    const glm::uvec2 before_px = headset.images->sizePx();
    const glm::uvec2 inset_before_px = headset.inset_images ? headset.inset_images->sizePx() : glm::uvec2(0);
    if (before == images_asked_ && glm::all(glm::greaterThanEqual(before_px, least_px))) { return; }
    try {
        makeImages(headset, size_px, inset_px);
    } catch (const Error&) {
        images_asked_ = before;
        makeImages(headset, before_px, inset_before_px);
        throw;
    }
}

void SceneRenderer::makeImages(ConnectedHeadset& headset, glm::uvec2 size_px, glm::uvec2 inset_px) {
    const auto make = [&](std::unique_ptr<EyeImages>& images, glm::uvec2 px) {
        images.reset();  // first, since both may not fit
        images = std::make_unique<EyeImages>(headset.session, presenter_, format_, px);
        if (!takes_depth_) { images->dropDepth(); }
    };
    headset.inset_images.reset();
    make(headset.images, size_px);
    // Before there is a scene, so that its first frame need not.
    if (presenter_.pixels().bytes() == 0) { presenter_.reserve(size_px, headset.images->takesDepth()); }
    if (headset.inset) { make(headset.inset_images, inset_px); }
}

void SceneRenderer::govern(ConnectedHeadset& headset, const ViewSettings& settings, const FrameViews& views,
                           ShownScene& shown) {
    // With coarse tiles both eyes are rendered whatever the budget.
    const StereoOptions& stereo = settings.stereo;
    const bool coarse = stereo.mode == Mode::kPredicted && stereo.half_periphery &&
                        stereo.foveation_deg > 0.0 && !headset.inset;
    governor_.wish(settings.quality, coarse ? Mode::kShared : stereo.mode,
                   {stereo.warp.budget, settings.resolution_scale, stereo.warp.error_bound_db});
    fitImages(headset, settings, views);
    takeGoverned(headset, views, shown);
    const double scale = governed_.resolution_scale;
    view_px_ = sizePx(scale);
    headset.images->draw(view_px_);
    if (headset.inset) { headset.inset_images->draw(insetPx(headset, scale)); }
}

void SceneRenderer::takeGoverned(const ConnectedHeadset& headset, const FrameViews& views,
                                 ShownScene& shown) {
    const GovernedSettings& chosen = governor_.settings();
    if (chosen == governed_) { return; }
    // Larger pictures may need longer lists, which are made beside frames of the present size.
    const glm::uvec2 size_px = sizePx(chosen.resolution_scale),
                     before_px = sizePx(governed_.resolution_scale);
    const bool fits =
        governed_count_ > 0 && glm::all(glm::lessThanEqual(before_px, headset.images->sizePx()));
    if (fits && glm::any(glm::greaterThan(size_px, before_px)) &&
        !shown.makeRoomFor(stays_ ? coverPx(views, size_px) : size_px,
                           insetPx(headset, chosen.resolution_scale))) {
        return;
    }
    governed_ = chosen;
    ++governed_count_;
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
    frame.half_floats = true;
    frame.keep_classes = settings.tint;
    frame.gazes = views.gazes;
    frame.times_passes = settings.page == PanelPage::kMethod;
    frame.mark = governed_count_;
    frame.measured_part = measured_part_ = (measured_part_ + 1) % gpu::kMeasuredParts;
    frame.keep_history = true;
    frame.waits_for_lists = false;
    frame.most_px = headset.images->sizePx();
    frame.background = backgroundOf(settings, frame.background);
    // If both eyes share a picture, it is seen through either lens.
    if (!settings.showsOneEye() && settings.visibility_mask) {
        frame.hidden_tiles = headset.lens_mask.update(
            headset.session.hiddenMeshes(), headset.session.hiddenMeshVersion(), views.eyes, view_px_);
        sayHidden(frame.hidden_tiles);
    }
    return frame;
}

void SceneRenderer::aim(ConnectedHeadset& headset, const Similarity& scene_from_room,
                        const ViewSettings& settings, FrameViews& views) {
    frame_ = settingsOfFrame(headset, settings, scene_from_room.scale, views);
    eyes_.clear();
    inset_eyes_.clear();
    for (const int e : drawnEyes()) {
        const auto at = static_cast<std::size_t>(e);
        eyes_.push_back(eyeInScene(scene_from_room, views.room_from_eyes[at], views.eyes[at].fov, view_px_));
    }
    seen_ = eyes_;
    if (stays_) {
        keepAxes(headset, scene_from_room, views);
    } else {
        axes_ = StayingAxes(glm::radians(kAxesMarginDegrees));
    }
    if (headset.inset) { aimInsets(headset, scene_from_room, views); }
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
    aim(headset, scene_from_room, settings, views);
    FramesWanted wanted = std::as_const(*this).framesWanted(headset, there_from_here);
    axes_ = axes;
    return wanted;
}

void SceneRenderer::prepare(ConnectedHeadset& headset, ShownScene& shown, const Similarity& scene_from_room,
                            const ViewSettings& settings, FrameViews& views) {
    aim(headset, scene_from_room, settings, views);
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

void SceneRenderer::keepAxes(ConnectedHeadset& headset, const Similarity& scene_from_room,
                             FrameViews& views) {
    const std::span<const Eye> pictures = axes_.follow(seen_, frame_.hidden_tiles);
    eyes_.assign(pictures.begin(), pictures.end());
    frame_.hidden_tiles = axes_.hiddenTiles();
    frame_.gazes = turnGazes(frame_.gazes, seen_, eyes_);
    headset.images->draw(eyes_.front().size_px);
    for (const int e : drawnEyes()) {
        const auto at = static_cast<std::size_t>(e);
        const Eye& picture = eyes_[frame_.mode == Mode::kMono ? 0 : at];
        views.pictures[at] = pictureInRoom(scene_from_room, picture, views.eyes[at].pose.position);
    }
}

void SceneRenderer::aimInsets(const ConnectedHeadset& headset, const Similarity& scene_from_room,
                              const FrameViews& views) {
    inset_frame_ = frame_;
    inset_frame_.hidden_tiles = {};
    inset_frame_.gazes = {};
    inset_frame_.most_px = headset.inset_images->sizePx();
    const glm::uvec2 size_px = headset.inset_images->partPx();
    for (const int e : drawnEyes()) {
        const auto at = static_cast<std::size_t>(e);
        const Eye& inset = inset_eyes_.emplace_back(
            eyeInScene(scene_from_room, views.room_from_eyes[at], views.insets->at(at).fov, size_px));
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
                       .half_loss = last_.half_loss});
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
        const Buffer& pixels = stays_ ? presenter_.turn(commands, images.partPx(), view_px_,
                                                        pictureFromView(eyes_[at], seen_[at]))
                                      : presenter_.pixels();
        window->keepEye(commands, pixels, view_px_, images.sizePx(), format_);
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
