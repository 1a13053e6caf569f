// A scene on its way to the device while frames go on.
#pragma once

#include "app/options/options.h"
#include "app/view/scenes/kernels_ahead.h"
#include "app/view/scenes/scene_facts.h"
#include "app/view/wearer/placement.h"
#include "engine/frame.h"

#include <atomic>
#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <thread>

namespace binosplat {

// A scene that can be shown. Stays where it is: the frame refers to the scene.
struct LoadedScene {
    LoadedScene(const Context& context, const Scene& scene, const Progress& progress)
        : gpu_scene(context, scene, progress), frame(context, gpu_scene) {}
    std::string name;
    GpuScene gpu_scene;
    StereoFrame frame;
    Similarity start;               // see startPlacement
    glm::dvec3 up{0.0, -1.0, 0.0};  // see upOfScene
    LoadNotes notes;
    SceneFacts facts;
};

// As FramesAhead::known has it.
std::pair<std::uint32_t, int> kindOf(const LoadedScene& scene);

// Loads on a thread of its own.
class SceneLoader {
public:
    // With `ahead` it also makes the kernels of its frames, unless others of its kind were shown before.
    SceneLoader(const Context& context, std::string scene, RunOptions options, std::optional<FramesAhead> ahead = {});
    SceneLoader(const SceneLoader&) = delete;
    SceneLoader& operator=(const SceneLoader&) = delete;
    // Gives up where it can, and waits for the rest.
    ~SceneLoader();

    // It is to give up where it can; then it is done, with nothing to take.
    void cancel() { cancelled_ = true; }

    [[nodiscard]] const std::string& scene() const { return scene_; }
    // Share done, 0 to 1.
    [[nodiscard]] double progress() const { return progress_; }
    [[nodiscard]] bool isDone() const { return done_; }
    // Waits for the scene and hands it over, once. Throws what loading threw.
    [[nodiscard]] std::unique_ptr<LoadedScene> take();

private:
    void load(const Context& context, const RunOptions& options, const std::optional<FramesAhead>& ahead);

    std::string scene_;
    std::atomic<double> progress_ = 0.0;
    std::atomic<bool> done_ = false, cancelled_ = false;
    std::unique_ptr<LoadedScene> loaded_;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace binosplat
