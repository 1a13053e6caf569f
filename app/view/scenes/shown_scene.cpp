// One scene after another.
#include "app/view/scenes/shown_scene.h"

#include "app/view/scenes/view_scenes.h"
#include "app/view/view_files.h"
#include "engine/error.h"
#include "engine/scene/procedural.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

// One name for a file, however it is spelled.
std::string sameNameOf(const std::string& scene) {
    if (isBuiltin(scene)) { return scene; }
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(scene, error);
    return error ? scene : whole.string();
}

}  // namespace

ShownScene::ShownScene(const Context& context, const ViewOptions& options, const FrameLog& log, std::optional<FramesAhead> ahead)
    : context_(context), options_(options), log_(log), ahead_(std::move(ahead)) {
    begin(options.scene);
}

std::optional<double> ShownScene::loading() const { return loader_ ? std::optional(loader_->progress()) : std::nullopt; }

bool ShownScene::isLoading() const {
    return loader_ || std::ranges::any_of(given_up_, [](const std::unique_ptr<SceneLoader>& loader) { return !loader->isDone(); });
}

void ShownScene::begin(const std::string& scene) {
    // Nobody waits for one that gives up.
    std::erase_if(given_up_, [](const std::unique_ptr<SceneLoader>& loader) { return loader->isDone(); });
    if (loader_) {
        loader_->cancel();
        given_up_.push_back(std::move(loader_));
    }
    asked_ = scene;
    loader_ = std::make_unique<SceneLoader>(context_, scene, options_.run, ahead_);
}

void ShownScene::beginBeside(int step) { begin(sceneBeside(asked_, step)); }

std::string ShownScene::take(ViewSettings& settings) {
    const std::unique_ptr<SceneLoader> loader = std::move(loader_);
    try {
        std::unique_ptr<LoadedScene> taken = loader->take();
        {
            const std::lock_guard lock(context_.queueMutex());
            context_.queue().waitIdle();
        }
        // Drivers need many times a frame's time to make them.
        if (scene_) { taken->frame.takeKernels(scene_->frame); }
        if (ahead_) { ahead_->known.insert(kindOf(*taken)); }
        if (scene_) { left_[sameNameOf(scene_->name)] = scene_from_room; }
        scene_ = std::move(taken);
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError& error) {
        return goOnWithout(error.what());
    } catch (const Error& error) { return goOnWithout(error.what()); }
    log_.say("shows " + scene_->name);
    const std::string complaint = place(settings);
    for (const std::string& line : scene_->notes.lines) { log_.print("note: " + line); }
    return complaint;
}

std::string ShownScene::goOnWithout(const std::string& why) {
    if (scene_) { return why; }
    if (asked_ == options_.scene) { throw; }  // nothing to show instead
    begin(options_.scene);                    // which another one had pushed aside
    return why;
}

std::string ShownScene::place(ViewSettings& settings) {
    if (const auto left = left_.find(sameNameOf(scene_->name)); left != left_.end()) {
        scene_from_room = left->second;
        return {};
    }
    const CameraOptions& camera = options_.run.camera;
    const bool is_asked_for = camera.eye || camera.look || camera.up || settings.scene_from_room;
    scene_from_room = settings.scene_from_room.value_or(scene_->start);
    settings.scene_from_room.reset();
    if (is_asked_for) { return {}; }
    try {
        const std::optional<Similarity> remembered = rememberedPlacement(scene_->name);
        if (!remembered) { return {}; }
        scene_from_room = *remembered;
        log_.say("the wearer stands where this scene was saved");
    } catch (const Error& error) { return error.what(); }
    return {};
}

}  // namespace binosplat
