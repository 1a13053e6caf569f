// Runs the window from its first picture to its last.
#include "app/desktop/desktop_shell.h"

#include "app/options/modes.h"
#include "app/terminal/interrupt.h"
#include "app/view/panel/panel_style.h"
#include "engine/error.h"
#include "engine/places/standpoint.h"

#include <algorithm>
#include <cmath>
#include <mutex>

namespace binosplat {

namespace {

constexpr double kRestSeconds = 0.15;     // without a change, before a picture is refined
constexpr double kIdleSeconds = 0.25;     // how often to check for Ctrl-C
constexpr double kLoadingSeconds = 0.05;  // how often to check for results of threads
constexpr double kGamepadSeconds = 1.0 / 60.0, kNoPictureSeconds = 0.002;
constexpr double kUsualAngleDeg = 60.0;
constexpr double kTourWaySeconds = 4.0;  // from one viewpoint to the next
// The panel's size: in its own pixels, on a desktop without magnification; and at most this share of the
// window's width.
constexpr double kPanelScale = 0.7, kPanelShare = 0.6;
// Share of the distance to the centre, so that the near plane is nearer than usual if the camera is close.
constexpr double kNearShare = 0.05;

double secondsSince(std::chrono::steady_clock::time_point then) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - then).count();
}

// Kernels for the method of pictures in motion.
FramesAhead framesAhead(const ViewSettings& settings, glm::uvec2 size_px) {
    StereoOptions stereo = settings.stereo;
    if (!showsTwoEyes(settings.window_stereo)) { stereo.mode = Mode::kMono; }
    stereo.foveation_deg = 0.0;
    stereo.half_periphery = false;
    return {stereo, size_px, /*with_depth*/ true, settings.tint, {}};
}

}  // namespace

DesktopShell::DesktopShell(const ViewOptions& options, const ViewSettings& settings, const Context& context)
    : options_(options),
      context_(context),
      state_(settings),
      window_(context),
      pictures_(context),
      panel_(context, vk::Format::eR8G8B8A8Srgb),
      commands_{Commands(context), Commands(context)},
      angle_rad_(glm::radians(options.run.camera.fov_x_deg.value_or(kUsualAngleDeg))),
      notes_(files_, [this](const std::string& message) { say(message); }),
      viewpoints_(files_, [this](const std::string& message) { say(message); }),
      scenes_(context_, options_, log_, framesAhead(settings, window_.sizePx())),
      requests_(state_, scenes_, notes_, files_, panel_,
                [this](const std::string& message) { say(message); }) {
    panel_.status().window.emplace();
    if (const std::string& complaint = panel_.canvas().font().complaint(); !complaint.empty()) {
        log_.print(complaint);
    }
}

void DesktopShell::run() {
    while (!leaving_) { step(); }
    while (const std::optional<std::string> outcome = writer_.finish()) { say(*outcome); }
    keepPictureOfScene();
    notes_.keepPreferences(state_.settings(), 0.0, true);
    files_.finish();
    log_.print(fmt::format("{} pictures in the window, {} of the scene", log_.frame, scene_frames_));
}

void DesktopShell::step() {
    window_.wait(secondsToWait());
    const double seconds = std::min(secondsSince(last_step_), 0.1);
    last_step_ = Clock::now();
    const bool is_enough = options_.frames != 0 && log_.frame - pictures_without_scene_ >= options_.frames;
    if (isInterrupted() || window_.isClosed() || is_enough) { leaving_ = true; }
    scenes_.freeGone();
    files_.deliver();
    dialogs_.deliver();
    if (const std::optional<std::string> outcome = writer_.takeOutcome()) { say(*outcome); }
    if (scenes_.isNextReady() && !writer_.isTaking()) { takeScene(); }
    if (scenes_.isOtherReady() && !writer_.isTaking()) { takeOther(); }
    for (const DesktopEvent& event : window_.takeEvents()) { handle(event); }
    const bool was_on_way = mover_.isGliding();
    mover_.pass(heldMotion(), seconds);
    if (was_on_way && !mover_.isGliding()) { log_.say("arrived"); }
    if (heldMotion().isAny()) { viewpoints_.endTour(); }
    goTo(viewpoints_.pass(seconds, !mover_.isGliding()), kTourWaySeconds);
    followComparison();
    layOutPanel(pointer_, seconds);
    draw(seconds);
    notes_.keepPreferences(state_.settings(), seconds);
    if (const std::string change = state_.takeChange(); !change.empty()) { log_.say(change); }
}

double DesktopShell::secondsToWait() const {
    if (window_.isMinimized()) { return kIdleSeconds; }
    if (!is_shown_) { return kNoPictureSeconds; }
    if (layouts_due_ > 0 || mover_.isGliding() || heldMotion().isAny()) { return 0.0; }
    const auto changes = [](const LoadedScene* scene) {
        return scene != nullptr && scene->live &&
               (!scene->live->isSettled() || (scene->moving != nullptr && scene->clock.plays()));
    };
    if (changes(scenes_.get()) || changes(scenes_.other())) { return kNoPictureSeconds; }
    double most = kIdleSeconds;
    if (!is_refined_) { most = std::clamp(kRestSeconds - secondsSince(changed_at_), 0.0, most); }
    if (viewpoints_.isTouring() || scenes_.isLoading() || !files_.now().empty() || !dialogs_.now().empty()) {
        most = std::min(most, kLoadingSeconds);
    }
    return window_.hasGamepad() ? std::min(most, kGamepadSeconds) : most;
}

void DesktopShell::takeScene() {
    const LoadedScene* const before = scenes_.get();
    keepPictureOfScene();
    if (before != nullptr) { left_[before->place] = mover_.camera(); }
    const std::string complaint = scenes_.take(state_);
    if (!complaint.empty()) { say(complaint); }
    const LoadedScene* const scene = scenes_.get();
    if (scene == before) { return; }
    pictures_.forget();
    drawn_ = {};
    motion_ = MotionScale(context_.isSoftware());
    viewpoints_.show(scenes_.get());
    ruler_.close();
    is_shown_ = false;
    if (scene == nullptr) { return; }  // it has made way for the next one
    OrbitCamera camera(scene->start_view);
    if (const Similarity& placed = state_.sceneFromRoom(); !(placed == scene->start)) {  // where it was saved
        const glm::dvec3 ahead = placed.orientation * glm::dvec3(0.0, 0.0, camera.distance());
        camera = OrbitCamera(View{placed.position, placed.position + ahead,
                                  placed.orientation * glm::dvec3(0.0, -1.0, 0.0), 0.0});
    }
    if (const auto left = left_.find(scene->place); left != left_.end()) { camera = left->second; }
    mover_.set(camera);
    notes_.remember(scene->name, complaint);
}

void DesktopShell::keepPictureOfScene() {
    if (scenes_.get() == nullptr || pictures_.eyes().empty()) { return; }
    try {
        notes_.keepPicture(*scenes_.get(), [picture = scenes_.frame().readPicture(0)] { return picture; });
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError&) {
        // A missing picture is not worth a message.
    } catch (const Error&) {}
}

WindowPart DesktopShell::panelPart() const {
    if (!state_.settings().panel) { return {}; }
    const glm::dvec2 size(window_.sizePx()), panel(kPanelPx);
    const double scale =
        std::min({window_.scale() * kPanelScale, size.y / panel.y, kPanelShare * size.x / panel.x});
    const glm::ivec2 size_px = glm::max(glm::ivec2(scale * panel), glm::ivec2(1));
    return {{static_cast<int>(size.x) - size_px.x, 0}, size_px};
}

glm::uvec2 DesktopShell::areaPx() const {
    const glm::uvec2 size_px = window_.sizePx();
    return {size_px.x - static_cast<unsigned>(panelPart().size_px.x), size_px.y};
}

WindowSight DesktopShell::windowSight() const {
    const ViewSettings& settings = state_.settings();
    return {settings.window_stereo, settings.window_eyes, settings.window_plane, angle_rad_};
}

DesktopShell::Sight DesktopShell::sightNow() const {
    Sight sight{scenes_.get(),           scenes_.other(),   mover_.camera(),
                parts().front().size_px, state_.settings(), moment_};
    sight.settings.page = {};  // these change nothing in the scene
    sight.settings.panel = {};
    return sight;
}

FrameSettings DesktopShell::frameSettingsNow(bool at_rest) const {
    const ViewSettings& settings = state_.settings();
    FrameSettings frame = frameSettings(options_.run.camera, framesAhead(settings, {}).stereo, kWearersOrder);
    if (at_rest && frame.mode != Mode::kMono && !settings.tint) { frame.mode = Mode::kShared; }
    const LoadedScene& scene = *scenes_.get();
    const double size = scene.facts.size_units,
                 usual = size > 0.0 ? kUsualNear * std::min(size, 1.0) : kUsualNear;
    frame.near = options_.run.camera.near.value_or(std::min(usual, kNearShare * mover_.camera().distance()));
    frame.half_floats = true;
    frame.keep_both_depths = true;
    frame.keep_classes = settings.tint;
    frame.keep_history = !at_rest;
    frame.times_passes = settings.page == PanelPage::kMethod;
    if (settings.backdrop != Backdrop::kAsSet) { frame.background = colourOf(settings.backdrop); }
    return frame;
}

void DesktopShell::draw(double seconds) {
    if (window_.isMinimized()) { return; }
    if (window_.takeDamage()) { is_shown_ = false; }
    if (is_shown_ && scenes_.get() != nullptr) { drawScene(seconds); }
    const std::uint64_t panel = state_.settings().panel ? panel_.canvas().revision() : 0;
    if (std::exchange(shown_panel_, panel) != panel) { is_shown_ = false; }
    if (!is_shown_) { show(); }
}

void DesktopShell::drawScene(double seconds) {
    const auto frameOf = [](const LoadedScene* scene) { return scene != nullptr ? scene->clock.frame() : 0; };
    const std::array before{frameOf(scenes_.get()), frameOf(scenes_.other())};
    scenes_.follow(eyesOf(mover_.camera(), windowSight(), sightNow().part_px), seconds);
    bool changes = before != std::array{frameOf(scenes_.get()), frameOf(scenes_.other())};
    for (LoadedScene* const scene : {scenes_.get(), scenes_.other()}) {
        if (scene == nullptr || !scene->live) { continue; }
        for (const std::string& line : scene->live->takeLines(Waits::kNever)) { say(line); }
        changes = changes || !scene->live->isSettled();
    }
    if (changes) { ++moment_; }
    const Sight sight = sightNow();
    if (!(sight == drawn_)) {
        drawn_ = sight;
        is_refined_ = false;
        changed_at_ = Clock::now();
        render(motion_.scale(), false);
    } else if (!is_refined_ && (secondsSince(changed_at_) >= kRestSeconds || writes_picture_)) {
        is_refined_ = true;
        render(1.0, true);
        if (std::exchange(writes_picture_, false)) { takePicture(); }
    }
}

void DesktopShell::render(double scale, bool at_rest) {
    const auto sizeAt = [&](double share) {
        const double of_part = share * state_.settings().resolution_scale;
        return glm::max(glm::uvec2(glm::round(of_part * glm::dvec2(drawn_.part_px))), glm::uvec2(16));
    };
    const glm::uvec2 size_px = sizeAt(scale);
    FrameSettings settings = frameSettingsNow(at_rest);
    settings.most_px = sizeAt(1.0);
    settings.mark =
        static_cast<std::uint64_t>(std::lround(1000.0 * scale * state_.settings().resolution_scale));
    const std::vector<Eye> eyes = eyesOf(mover_.camera(), windowSight(), size_px);
    pictures_.render(scenes_.frame(), eyes, settings, look(), at_rest);
    renderOther(eyes, settings, at_rest);
    const FrameResult& last = pictures_.lastFrame();
    const double other_ms = scenes_.other() != nullptr ? comparison_->pictures.lastFrame().gpu_total_ms : 0.0;
    motion_.measure(0.001 * static_cast<double>(last.mark), last.gpu_total_ms + other_ms,
                    window_.refreshHz());
    ++scene_frames_;
    is_shown_ = false;
    layouts_due_ = std::max(layouts_due_, 1);  // its times
    panel_.keepFrameTime();
}

void DesktopShell::show() {
    const auto compose = [&](vk::Image target, vk::Semaphore drawn) {
        Commands& commands = commands_[log_.frame % commands_.size()];
        commands.wait();
        commands.begin();
        const WindowPart panel = panelPart();
        if (panel.size_px.x > 0) { panel_.record(commands); }
        clearWindow(commands, target);
        if (scenes_.get() != nullptr) { composeScenes(commands, target); }
        if (panel.size_px.x > 0) { blitInto(commands, panel_.canvas().image(), kPanelPx, target, panel); }
        changeLayout(commands, target, vk::ImageLayout::eTransferDstOptimal, vk::ImageLayout::ePresentSrcKHR);
        commands.submit(drawn);
    };
    is_shown_ = window_.show(compose);
    if (!is_shown_) { return; }
    ++log_.frame;
    pictures_without_scene_ += scenes_.get() == nullptr ? 1 : 0;
}

void DesktopShell::say(const std::string& message) {
    panel_.status().message = message;
    layouts_due_ = std::max(layouts_due_, 1);
    log_.say(message);
}

}  // namespace binosplat
