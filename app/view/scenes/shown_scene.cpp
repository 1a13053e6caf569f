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
    : context_(context), options_(options), log_(log), kernels_(context), ahead_(std::move(ahead)) {
    begin(options.scene, options.compare);
}

std::string ShownScene::names() const {
    return other_.scene ? fmt::format("{} | {}", name(), other_.scene->name) : name();
}

std::optional<double> ShownScene::loading() const {
    for (const Coming* const coming : {&next_, &other_next_}) {
        if (coming->loader) { return coming->loader->progress(); }
    }
    const LoadedScene* const scene = drawn();
    if (scene == nullptr || !scene->live || scene->live->share() >= 1.0) { return std::nullopt; }
    return scene->live->share();
}

bool ShownScene::isLoading() const {
    return next_.loader || other_next_.loader || isMakingMethod() ||
           std::ranges::any_of(given_up_,
                               [](const Coming& coming) { return !coming.isLoaded() || coming.isMaking(); });
}

void ShownScene::begin(const std::string& scene, const std::string& compared) {
    if (shown_.scene && std::exchange(compares_next_, false)) { return beginOther(scene); }
    load(scene);
    compared_next_ = compared;
}

void ShownScene::giveUp(Coming& coming) {
    if (coming.loader) { given_up_.push_back(std::exchange(coming, {})); }
    forgetGivenUp();
}

void ShownScene::forgetGivenUp() {
    // Those that are giving up are not waited for.
    for (Coming& coming : given_up_) {
        if (coming.isMaking()) { continue; }
        coming.frames = {};
        coming.loader->cancel();
    }
    std::erase_if(given_up_,
                  [](const Coming& coming) { return coming.isLoaded() && !coming.frames.valid(); });
}

std::unique_ptr<SceneLoader> ShownScene::makeLoader(const std::string& scene, RunOptions options) {
    return std::make_unique<SceneLoader>(context_, kernels_, scene, std::move(options), ahead_,
                                         options_.load_first);
}

void ShownScene::load(const std::string& scene) {
    giveUp(next_);
    giveUp(other_next_);
    ++asked_count_;
    asked_ = scene;
    compared_next_.clear();
    RunOptions run = options_.run;
    if (scene != options_.scene) {  // a place on the command line is for the first scene
        run.camera.cameras_file.clear();
        run.camera.eye = run.camera.look = run.camera.up = std::nullopt;
    }
    next_.loader = makeLoader(scene, std::move(run));
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

void ShownScene::expect(const ViewSettings& asked, glm::uvec2 size_px, const ImagesFor& images) {
    forgetGivenUp();
    if (!ahead_) { return; }
    FramesAhead wanted{asked.stereo, size_px, ahead_->with_depth, asked.tint};
    if (!ahead_->isLike(wanted)) {
        ahead_ = std::move(wanted);
        for (const Coming* const coming : {&next_, &other_next_}) {
            if (coming->loader) { coming->loader->expect(*ahead_); }
        }
    }
    ahead_->images_px = images.size_px;
    ahead_->resolution_scale = asked.resolution_scale;
    if (!shown_.scene || options_.load_first) { return; }
    if (images.are_there) { takeRemade(); }
    if (maker_ && maker_->isDone()) {
        if (!maker_->hasGivenUp()) { haveReady(*made_for_, maker_->ahead()); }
        maker_.reset();
    }
    const bool loads = next_.loader || other_next_.loader;
    if (maker_) {
        if (!maker_->ahead().isLike(*ahead_) || loads) { maker_->cancel(); }
        return;
    }
    for (Held* const held : {&drawing(), &resting()}) {
        if (loads || maker_ || !held->scene || held->ready->isLike(*ahead_)) { continue; }
        made_for_ = held;
        maker_ = std::make_unique<KernelMaker>(context_, kernels_, held->scene->gpu_scene,
                                               options_.run.camera, *ahead_);
    }
}

void ShownScene::haveReady(Held& held, const FramesAhead& ahead) {
    held.ready = ahead;
    held.ready->images_px = {0, 0};
    if (ahead_->isLike(ahead)) { ahead_->known.insert(kindOf(*held.scene)); }
}

ViewSettings ShownScene::drawable(ViewSettings settings) const {
    const std::optional<FramesAhead>& met = drawing().met;
    if (!drawn() || !met || options_.load_first) { return settings; }
    FramesAhead wanted = *met;  // another size does not need new kernels
    wanted.stereo = settings.stereo;
    wanted.tint = settings.tint;
    const Axes axes = settings.stereo.axes;  // which do not need other kernels
    if (!wanted.isLike(*met)) {
        settings.stereo = met->stereo;
        settings.stereo.axes = axes;
        settings.tint = met->tint;
    }
    if (!met->hasFramesOf(*ahead_)) {
        // Of the same method: in the images that are there.
        settings.stereo.axes = met->stereo.axes;
        settings.resolution_scale = met->resolution_scale;
    }
    return settings;
}

std::string ShownScene::take(ViewState& state) {
    Coming coming = std::exchange(next_, {});
    try {
        std::unique_ptr<LoadedScene> taken = coming.loader->take();
        maker_.reset();
        SceneFrames frames = takeFrames(coming);
        dropOther();
        const bool is_met = frames.frame && coming.like;
        if (frames.frame == nullptr) { shown_.remade = {}; }  // it reads the scene that goes at once
        if (shown_.scene) { left_[shown_.scene->place] = state.sceneFromRoom(); }
        if (frames.frame) {
            letGo(shown_);
            shown_.frames = std::move(frames);
        } else {
            showInFrames(*taken);
        }
        shown_.scene = std::move(taken);
        if (ahead_) { haveReady(shown_, coming.loader->madeFor()); }
        shown_.met = is_met ? coming.like : shown_.ready;
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
    // Each waits for its own frames in flight; after that nothing reads the previous scene.
    freeGone();
    SceneFrames& frames = shown_.frames;
    if (frames.frame) {
        frames.frame->show(scene.gpu_scene);
    } else {
        frames.frame = std::make_unique<StereoFrame>(context_, scene.gpu_scene, kernels_);
    }
    try {
        if (frames.insets) { frames.insets->show(scene.gpu_scene); }
    } catch (const Error&) { frames.insets.reset(); }  // reported when a headset takes insets
}

StereoFrame& ShownScene::insets() {
    SceneFrames& frames = drawing().frames;
    if (!frames.insets) { frames.insets = StereoFrame::beside(*frames.frame); }
    return *frames.insets;
}

void ShownScene::rebuildKernels() {
    // They share the kernels.
    freeGone();
    for (StereoFrame* const frame :
         {shown_.frames.insets.get(), other_.frames.insets.get(), other_.frames.frame.get()}) {
        if (frame != nullptr) { (void)frame->finish(); }
    }
    shown_.frames.frame->rebuildKernels();
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
    freeGone();
    shown_.remade = {};
    shown_.frames.insets.reset();
    if (!nothing_) { nothing_ = std::make_unique<GpuScene>(context_, Scene{}); }
    shown_.frames.frame->show(*nothing_);
    shown_.scene.reset();
    load(std::string(asked_));
    compared_next_ = compared;
    return fmt::format(
        "{} and {} do not fit into the device's memory together: the first one is removed first", gone_first_,
        asked_);
}

void ShownScene::moveTime(bool play, int step, std::optional<std::size_t> frame) {
    if (!shown_.scene || shown_.scene->moving == nullptr || (!play && step == 0 && !frame)) { return; }
    SceneClock& clock = shown_.scene->clock;
    if (play) { clock.togglePlaying(); }
    if (step != 0) { clock.step(step); }
    if (frame) { clock.goTo(*frame); }
    log_.say(fmt::format("{} frame {} of {}", clock.plays() ? "plays from" : "paused at", clock.frame() + 1,
                         clock.frameCount()));
}

bool ShownScene::isPlaceGiven(const LoadedScene& scene) const {
    const CameraOptions& camera = options_.run.camera;
    return scene.name == options_.scene &&
           (camera.eye || camera.look || camera.up || !camera.cameras_file.empty());
}

Similarity ShownScene::placementOf(const LoadedScene& scene, const ViewState& state) const {
    if (const auto left = left_.find(scene.place); left != left_.end()) { return left->second; }
    if (std::optional<Similarity> asked = state.asked()) {
        asked->position -= scene.origin;
        return *asked;
    }
    return scene.remembered && !isPlaceGiven(scene) ? *scene.remembered : scene.start;
}

std::string ShownScene::place(ViewState& state) {
    const LoadedScene& scene = *shown_.scene;
    state.countFrom(scene.origin);
    state.place(placementOf(scene, state));
    if (left_.contains(scene.place) || state.takeAsked() || isPlaceGiven(scene)) { return {}; }
    if (scene.remembered) { log_.say("the wearer stands where this scene was saved"); }
    return scene.remembering_trouble;
}

}  // namespace binosplat
