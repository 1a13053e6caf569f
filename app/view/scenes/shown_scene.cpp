// One scene after another.
#include "app/view/scenes/shown_scene.h"

#include "app/view/scenes/view_scenes.h"
#include "engine/error.h"
#include "engine/gpu/device_error.h"

#include <algorithm>
#include <utility>

namespace binosplat {

ShownScene::ShownScene(const Context& context, const ViewOptions& options, const FrameLog& log, std::optional<FramesAhead> ahead)
    : context_(context), options_(options), log_(log), ahead_(std::move(ahead)) {
    begin(options.scene);
}

std::optional<double> ShownScene::loading() const {
    if (loader_) { return loader_->progress(); }
    if (!scene_ || !scene_->live || scene_->live->share() >= 1.0) { return std::nullopt; }
    return scene_->live->share();
}

bool ShownScene::isLoading() const {
    return loader_ || maker_ ||
           std::ranges::any_of(given_up_, [](const std::unique_ptr<SceneLoader>& loader) { return !loader->isDone(); });
}

void ShownScene::begin(const std::string& scene) {
    // Loaders that are giving up are not waited for.
    std::erase_if(given_up_, [](const std::unique_ptr<SceneLoader>& loader) { return loader->isDone(); });
    if (loader_) {
        loader_->cancel();
        given_up_.push_back(std::move(loader_));
    }
    ++asked_count_;
    asked_ = scene;
    RunOptions run = options_.run;
    if (scene != options_.scene) {  // a given place belongs to the first one
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
               [this, &files, scene = asked_, step = std::exchange(steps_asked_, 0), count = asked_count_]() -> FileWorker::Done {
                   return [this, &files, count, found = sceneBeside(scene, step)] {
                       is_looking_ = false;
                       // Unless another scene was asked for since.
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
        if (loader_) { loader_->expect(*ahead_); }
    }
    if (!scene_ || options_.load_first) { return; }
    if (maker_ && maker_->isDone()) {
        if (StereoFrame* const made = maker_->made()) { frame_->takeKernels(*made); }
        if (!maker_->hasGivenUp()) { haveReady(maker_->ahead()); }
        maker_.reset();
    }
    if (maker_) {
        if (!maker_->ahead().isLike(*ahead_) || loader_) { maker_->cancel(); }
    } else if (!loader_ && !ready_->isLike(*ahead_)) {
        maker_ = std::make_unique<KernelMaker>(context_, scene_->gpu_scene, options_.run.camera, *ahead_);
    }
}

void ShownScene::haveReady(const FramesAhead& ahead) {
    ready_ = ahead;
    if (ahead_->isLike(ahead)) { ahead_->known.insert(kindOf(*scene_)); }
}

ViewSettings ShownScene::drawable(ViewSettings settings) const {
    if (!scene_ || !ready_ || options_.load_first) { return settings; }
    FramesAhead wanted = *ready_;  // another size needs no new kernels to wait for
    wanted.stereo = settings.stereo;
    wanted.tint = settings.tint;
    if (!wanted.isLike(*ready_)) {
        const Axes axes = settings.stereo.axes;  // which take no other kernels
        settings.stereo = ready_->stereo;
        settings.stereo.axes = axes;
        settings.tint = ready_->tint;
    }
    return settings;
}

std::string ShownScene::take(ViewState& state) {
    const std::unique_ptr<SceneLoader> loader = std::move(loader_);
    try {
        std::unique_ptr<LoadedScene> taken = loader->take();
        maker_.reset();
        if (scene_) { left_[scene_->place] = state.sceneFromRoom(); }
        showInFrames(*taken);
        scene_ = std::move(taken);
        if (const auto kernels = std::exchange(scene_->kernels, nullptr)) { frame_->takeKernels(*kernels); }
        if (ahead_) { haveReady(loader->madeFor()); }
    } catch (const vk::DeviceLostError&) { throw; } catch (const DeviceError& error) {
        const bool lacks_memory = error.kind() == DeviceError::Kind::kMemory;
        return lacks_memory && scene_ ? makeWay(state) : goOnWithout(error.what());
    } catch (const vk::SystemError& error) { return goOnWithout(error.what()); } catch (const Error& error) {
        return goOnWithout(error.what());
    }
    gone_first_.clear();
    log_.say("shows " + scene_->name);
    const std::string complaint = place(state);
    for (const std::string& line : scene_->notes.lines) { log_.print("note: " + line); }
    return complaint;
}

void ShownScene::showInFrames(const LoadedScene& scene) {
    // Each waits for its own frames in flight; after that nothing reads the previous scene.
    if (frame_) {
        frame_->show(scene.gpu_scene);
    } else {
        frame_ = std::make_unique<StereoFrame>(context_, scene.gpu_scene);
    }
    try {
        if (insets_) { insets_->show(scene.gpu_scene); }
    } catch (const Error&) { insets_.reset(); }  // reported when a headset takes insets
}

StereoFrame& ShownScene::insets() {
    if (!insets_) { insets_ = StereoFrame::beside(*frame_); }
    return *insets_;
}

std::vector<Image> ShownScene::picturesOf(std::span<const Eye> eyes, const FrameSettings& settings) {
    const std::unique_ptr<StereoFrame> frame = StereoFrame::beside(*frame_);
    frame->render(eyes, settings);
    std::vector<Image> pictures;
    for (std::size_t e = 0; e < eyes.size(); ++e) { pictures.push_back(frame->readPicture(static_cast<int>(e))); }
    return pictures;
}

void ShownScene::rebuildKernels() {
    if (insets_) { (void)insets_->finish(); }  // it shares the kernels
    frame_->rebuildKernels();
}

std::string ShownScene::goOnWithout(const std::string& why) {
    if (scene_) { return why; }
    // Another scene may have displaced it.
    const std::string instead = gone_first_.empty() ? options_.scene : gone_first_;
    // There is nothing to show instead.
    if (asked_ == instead) { throw; }
    begin(instead);
    return why;
}

std::string ShownScene::makeWay(const ViewState& state) {
    left_[scene_->place] = state.sceneFromRoom();
    gone_first_ = scene_->name;
    maker_.reset();
    insets_.reset();
    // Its kernels stay.
    if (!nothing_) { nothing_ = std::make_unique<GpuScene>(context_, Scene{}); }
    frame_->show(*nothing_);
    scene_.reset();
    begin(std::string(asked_));
    return fmt::format("{} and {} do not fit into the device's memory together: the first one goes first", gone_first_, asked_);
}

std::string ShownScene::place(ViewState& state) {
    state.countFrom(scene_->origin);
    if (const auto left = left_.find(scene_->place); left != left_.end()) {
        state.place(left->second);
        return {};
    }
    const CameraOptions& camera = options_.run.camera;
    const std::optional<Similarity> asked = state.takeAsked();
    state.place(asked.value_or(scene_->start));
    const bool is_given = camera.eye || camera.look || camera.up || !camera.cameras_file.empty();
    if (asked || (is_given && scene_->name == options_.scene)) { return {}; }
    if (scene_->remembered) {
        state.place(*scene_->remembered);
        log_.say("the wearer stands where this scene was saved");
    }
    return scene_->remembering_trouble;
}

}  // namespace binosplat
