// A scene on its way to the device while frames go on.
#pragma once

#include "app/load.h"
#include "app/options/options.h"
#include "app/view/scenes/kernels_ahead.h"
#include "app/view/scenes/scene_clock.h"
#include "app/view/scenes/scene_facts.h"
#include "app/view/scenes/viewpoints.h"
#include "engine/frame/stereo_frame.h"

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace binosplat {

// A scene that can be shown, whole, streamed or moving.
struct LoadedScene {
    LoadedScene(const Context& context, const Scene& scene, const Progress& progress)
        : whole(std::make_unique<GpuScene>(context, scene, progress)), gpu_scene(*whole) {}
    explicit LoadedScene(OpenedScene opened)
        : live(std::move(opened.live)),
          stream(opened.stream),
          moving(opened.moving),
          gpu_scene(live->scene()) {
        if (moving != nullptr) { clock = {moving->rateHz(), moving->series().size()}; }
    }
    // Before a frame of these eyes: requests what they need, and moves a moving scene on. Never waits.
    void follow(std::span<const Eye> eyes, double step_seconds);
    // Adds what is resident of it to a frame's counters.
    void count(FrameCounters& counters) const;

    std::string name;
    std::unique_ptr<GpuScene> whole;  // or
    std::unique_ptr<LiveScene> live;  // one that loads while it is shown
    SceneStream* stream = nullptr;    // the same, if it is streamed
    MovingScene* moving = nullptr;    // the same, if it moves
    const GpuScene& gpu_scene;        // of either
    SceneClock clock;                 // of one that moves
    glm::dvec3 origin{0.0};           // see Scene
    View start_view{};                // see startView
    Similarity start;                 // see startPlacement
    glm::dvec3 up{0.0, -1.0, 0.0};    // see upOfScene
    std::optional<double> floor;      // see floorHeight, along `up`
    std::vector<Viewpoint> viewpoints;
    LoadNotes notes;
    SceneFacts facts;
    std::string place;                     // one name for a scene, however it is spelled
    std::optional<Similarity> remembered;  // see rememberedPlace
    std::optional<double> measured;        // metres in a unit, by somebody who knew
    std::string remembering_trouble;       // why not, if it exists but cannot be read
};

// One name for a scene, however it is spelled.
std::string placeOf(const std::string& scene);

// As in FramesAhead::known.
std::pair<std::uint32_t, int> kindOf(const LoadedScene& scene);

// Loads on a thread of its own.
class SceneLoader {
public:
    // With `ahead` it also makes those of `kernels` that the scene's frames need, unless scenes of its kind
    // were shown before. A streamed scene is done when the coarsest level of all its leaves is loaded or, if
    // `settled`, everything that the start view needs. `context` and `kernels` outlive this.
    SceneLoader(const Context& context, PassKernels& kernels, std::string scene, RunOptions options,
                std::optional<FramesAhead> ahead = {}, bool settled = false);
    SceneLoader(const SceneLoader&) = delete;
    SceneLoader& operator=(const SceneLoader&) = delete;
    // Gives up if it can, and waits for the rest.
    ~SceneLoader();

    // Tells it to give up; then, or if it was done already, there is nothing to take, and it keeps nothing in
    // memory.
    void cancel();
    // Frames will need other kernels than those it began with.
    void expect(const FramesAhead& ahead);

    [[nodiscard]] const std::string& scene() const { return scene_; }
    // Share done, 0 to 1.
    [[nodiscard]] double progress() const { return progress_; }
    [[nodiscard]] bool isDone() const { return done_; }
    // Once done: the scene, until it is taken; null if it could not be loaded, or nobody wants it any more.
    [[nodiscard]] const LoadedScene* loaded() const { return loaded_.get(); }
    // Waits for the scene and hands it over, once. Throws what loading threw.
    [[nodiscard]] std::unique_ptr<LoadedScene> take();
    // After that, with kernels: the frames that they are for.
    [[nodiscard]] const FramesAhead& madeFor() const { return *made_for_; }

private:
    void load(const Context& context, PassKernels& kernels, const RunOptions& options, bool settled);
    void makeKernels(const Context& context, PassKernels& kernels, const RunOptions& options);
    // Ends, unless other kernels are needed than those that were made.
    bool finish();

    std::string scene_;
    std::mutex mutex_;  // guards how it ends, and `ahead_`
    std::optional<FramesAhead> ahead_, made_for_;
    std::atomic<double> progress_ = 0.0;
    std::atomic<bool> done_ = false, cancelled_ = false;
    std::unique_ptr<LoadedScene> loaded_;
    std::exception_ptr error_;
    std::thread thread_;
};

}  // namespace binosplat
