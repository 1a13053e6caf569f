// Shows one scene after another.
#include "app/view/scenes/shown_scene.h"

#include "app/view/scenes/view_scenes.h"
#include "engine/error.h"
#include "engine/gpu/device_error.h"

#include <algorithm>
#include <utility>

namespace binosplat {

ShownScene::ShownScene(const Context& context, const ViewOptions& options, const FrameLog& log,
                       std::optional<FramesAhead> ahead)
    : context_(context), options_(options), log_(log), ahead_(std::move(ahead)) {
    begin(options.scene, options.compare);
}

std::string ShownScene::names() const {
    return other_.scene ? fmt::format("{} | {}", name(), other_.scene->name) : name();
}

std::optional<double> ShownScene::loading() const {
    if (loader_) { return loader_->progress(); }
    if (other_loader_) { return other_loader_->progress(); }
    const LoadedScene* const scene = drawn();
    if (scene == nullptr || !scene->live || scene->live->share() >= 1.0) { return std::nullopt; }
    return scene->live->share();
}

bool ShownScene::isLoading() const {
    return loader_ || other_loader_ || maker_ ||
           std::ranges::any_of(given_up_,
                               [](const std::unique_ptr<SceneLoader>& loader) { return !loader->isDone(); });
}

void ShownScene::begin(const std::string& scene, const std::string& compared) {
    if (shown_.scene && std::exchange(compares_next_, false)) { return beginOther(scene); }
    load(scene);
    compared_next_ = compared;
}

void ShownScene::giveUp(std::unique_ptr<SceneLoader>& loader) {
    // Loaders that are giving up are not waited for.
    std::erase_if(given_up_, [](const std::unique_ptr<SceneLoader>& earlier) { return earlier->isDone(); });
    if (!loader) { return; }
    loader->cancel();
    given_up_.push_back(std::move(loader));
}

void ShownScene::load(const std::string& scene) {
    giveUp(loader_);
    giveUp(other_loader_);
    ++asked_count_;
    asked_ = scene;
    compared_next_.clear();
    RunOptions run = options_.run;
    if (scene != options_.scene) {  // a place on the command line is for the first scene
        run.camera.cameras_file.clear();
        run.camera.eye = run.camera.look = run.camera.up = std::nullopt;
    }
    loader_ = std::make_unique<SceneLoader>(context_, scene, std::move(run), ahead_, options_.load_first);
}

void ShownScene::beginBeside(int step, FileWorker& files) {
    steps_asked_ += step;
    if (!is_looking_) { lookBeside(files); }
}

void ShownScene::lookBeside(FileWorker& files) {
    is_looking_ = true;
    files.read("looking beside " + asked_,
               [this, &files, scene = asked_, step = std::exchange(steps_asked_, 0),
                count = asked_count_]() -> FileWorker::Done {
                   return [this, &files, count, found = sceneBeside(scene, step)] {
                       is_looking_ = false;
                       // Unless another scene has been asked for since.
                       if (count == asked_count_) { begin(found); }
                       if (steps_asked_ != 0) { lookBeside(files); }
                   };
               });
}

void ShownScene::expect(const StereoOptions& stereo, glm::uvec2 size_px, bool tint) {
    if (!ahead_) { return; }
    FramesAhead wanted{stereo, size_px, ahead_->with_depth, tint, {}};
    if (!ahead_->isLike(wanted)) {
        ahead_ = std::move(wanted);
        for (SceneLoader* const loader : {loader_.get(), other_loader_.get()}) {
            if (loader != nullptr) { loader->expect(*ahead_); }
        }
    }
    if (!shown_.scene || options_.load_first) { return; }
    if (maker_ && maker_->isDone()) {
        if (StereoFrame* const made = maker_->made()) { takeKernels(*made); }
        if (!maker_->hasGivenUp()) { haveReady(*made_for_, maker_->ahead()); }
        maker_.reset();
    }
    const bool loads = loader_ || other_loader_;
    if (maker_) {
        if (!maker_->ahead().isLike(*ahead_) || loads) { maker_->cancel(); }
        return;
    }
    for (Held* const held : {&drawing(), &resting()}) {
        if (loads || maker_ || !held->scene || held->ready->isLike(*ahead_)) { continue; }
        made_for_ = held;
        maker_ =
            std::make_unique<KernelMaker>(context_, held->scene->gpu_scene, options_.run.camera, *ahead_);
    }
}

void ShownScene::haveReady(Held& held, const FramesAhead& ahead) {
    held.ready = ahead;
    if (ahead_->isLike(ahead)) { ahead_->known.insert(kindOf(*held.scene)); }
}

void ShownScene::takeKernels(StereoFrame& from) {
    // All frames share the kernels, and none may be on the device with a kernel that is removed.
    for (const Held* const held : {&shown_, &other_}) {
        if (held->frame) { (void)held->frame->finish(); }
        if (held->insets) { (void)held->insets->finish(); }
    }
    shown_.frame->takeKernels(from);
}

ViewSettings ShownScene::drawable(ViewSettings settings) const {
    const std::optional<FramesAhead>& ready = drawing().ready;
    if (!drawn() || !ready || options_.load_first) { return settings; }
    FramesAhead wanted = *ready;  // another size does not need new kernels
    wanted.stereo = settings.stereo;
    wanted.tint = settings.tint;
    if (!wanted.isLike(*ready)) {
        const Axes axes = settings.stereo.axes;  // which do not need other kernels
        settings.stereo = ready->stereo;
        settings.stereo.axes = axes;
        settings.tint = ready->tint;
    }
    return settings;
}

std::string ShownScene::take(ViewState& state) {
    const std::unique_ptr<SceneLoader> loader = std::move(loader_);
    try {
        std::unique_ptr<LoadedScene> taken = loader->take();
        maker_.reset();
        dropOther();
        if (shown_.scene) { left_[shown_.scene->place] = state.sceneFromRoom(); }
        showInFrames(*taken);
        shown_.scene = std::move(taken);
        if (const auto kernels = std::exchange(shown_.scene->kernels, nullptr)) { takeKernels(*kernels); }
        if (ahead_) { haveReady(shown_, loader->madeFor()); }
    } catch (const vk::DeviceLostError&) { throw; } catch (const DeviceError& error) {
        const bool lacks_memory = error.kind() == DeviceError::Kind::kMemory;
        return lacks_memory && shown_.scene ? makeWay(state) : goOnWithout(error.what());
    } catch (const vk::SystemError& error) { return goOnWithout(error.what()); } catch (const Error& error) {
        return goOnWithout(error.what());
    }
    gone_first_.clear();
    log_.say("shows " + shown_.scene->name);
    const std::string complaint = place(state);
    for (const std::string& line : shown_.scene->notes.lines) { log_.print("note: " + line); }
    if (!compared_next_.empty()) { beginOther(std::exchange(compared_next_, {})); }
    return complaint;
}

void ShownScene::showInFrames(const LoadedScene& scene) {
    // Each waits for its own frames in flight; after that, nothing reads the previous scene.
    if (shown_.frame) {
        shown_.frame->show(scene.gpu_scene);
    } else {
        shown_.frame = std::make_unique<StereoFrame>(context_, scene.gpu_scene);
    }
    try {
        if (shown_.insets) { shown_.insets->show(scene.gpu_scene); }
    } catch (const Error&) { shown_.insets.reset(); }  // reported when a headset takes insets
}

StereoFrame& ShownScene::insets() {
    Held& held = drawing();
    if (!held.insets) { held.insets = StereoFrame::beside(*held.frame); }
    return *held.insets;
}

void ShownScene::rebuildKernels() {
    // They share the kernels.
    for (StereoFrame* const frame : {shown_.insets.get(), other_.insets.get(), other_.frame.get()}) {
        if (frame != nullptr) { (void)frame->finish(); }
    }
    shown_.frame->rebuildKernels();
}

std::string ShownScene::goOnWithout(const std::string& why) {
    if (shown_.scene) { return why; }
    // Another scene may have displaced it.
    const std::string instead = gone_first_.empty() ? options_.scene : gone_first_;
    // There is nothing to show instead.
    if (asked_ == instead) { throw; }
    load(instead);
    return why;
}

std::string ShownScene::makeWay(const ViewState& state) {
    left_[shown_.scene->place] = state.sceneFromRoom();
    gone_first_ = shown_.scene->name;
    const std::string compared = compared_next_;
    maker_.reset();
    dropOther();
    shown_.insets.reset();
    // Its kernels stay.
    if (!nothing_) { nothing_ = std::make_unique<GpuScene>(context_, Scene{}); }
    shown_.frame->show(*nothing_);
    shown_.scene.reset();
    load(std::string(asked_));
    compared_next_ = compared;
    return fmt::format(
        "{} and {} do not fit into the device's memory together: the first one is removed first", gone_first_,
        asked_);
}

std::string ShownScene::place(ViewState& state) {
    state.countFrom(shown_.scene->origin);
    if (const auto left = left_.find(shown_.scene->place); left != left_.end()) {
        state.place(left->second);
        return {};
    }
    const CameraOptions& camera = options_.run.camera;
    const std::optional<Similarity> asked = state.takeAsked();
    state.place(asked.value_or(shown_.scene->start));
    const bool is_given = camera.eye || camera.look || camera.up || !camera.cameras_file.empty();
    if (asked || (is_given && shown_.scene->name == options_.scene)) { return {}; }
    if (shown_.scene->remembered) {
        state.place(*shown_.scene->remembered);
        log_.say("the wearer stands where this scene was saved");
    }
    return shown_.scene->remembering_trouble;
}

}  // namespace binosplat
