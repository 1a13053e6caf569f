// Loading beside the frames.
#include "app/view/scenes/scene_loader.h"

#include "app/load.h"
#include "app/view/scenes/scene_up.h"

#include <utility>

namespace binosplat {

namespace {

// Of the whole, what reading the file takes; the rest is the way to the device.
constexpr double kReadingShare = 0.8;

struct Cancelled {};

}  // namespace

std::pair<std::uint32_t, int> kindOf(const LoadedScene& scene) { return {scene.gpu_scene.splatKind(), scene.gpu_scene.shDegree()}; }

SceneLoader::SceneLoader(const Context& context, std::string scene, RunOptions options, std::optional<FramesAhead> ahead)
    : scene_(std::move(scene)),
      thread_([this, &context, run = std::move(options), frames = std::move(ahead)] { load(context, run, frames); }) {}

SceneLoader::~SceneLoader() {
    cancelled_ = true;
    if (thread_.joinable()) { thread_.join(); }
}

void SceneLoader::load(const Context& context, const RunOptions& options, const std::optional<FramesAhead>& ahead) {
    try {
        LoadNotes notes;
        // Readers may report from threads of their own, which must not throw.
        const auto reading = [this, own = std::this_thread::get_id()](double share) {
            if (cancelled_ && std::this_thread::get_id() == own) { throw Cancelled(); }
            progress_ = kReadingShare * share;
        };
        Scene scene = loadScene(scene_, 0, &notes, reading, levelChoice(options.load, options.memory_limit_mib));
        reading(1.0);
        drawAs(options.load, scene, notes);
        const Similarity start = startPlacement(options, scene);
        SceneFacts facts = factsOf(scene, notes, scene_);
        const glm::dvec3 up = upOfScene(scene, scene_, options.camera.up.value_or(viewOfScene(scene, 60.0).up));
        loaded_ = std::make_unique<LoadedScene>(context, scene, [this](double share) {
            if (cancelled_) { throw Cancelled(); }
            progress_ = kReadingShare + (1.0 - kReadingShare) * share;
        });
        if (ahead && !ahead->known.contains(kindOf(*loaded_))) {
            makeKernelsAhead(context, loaded_->gpu_scene, loaded_->frame, options.camera, *ahead, [this] {
                if (cancelled_) { throw Cancelled(); }
            });
        }
        loaded_->name = scene_;
        loaded_->start = start;
        loaded_->up = up;
        loaded_->facts = std::move(facts);
        loaded_->notes = std::move(notes);
    } catch (const Cancelled&) {
        loaded_.reset();  // nobody waits
    } catch (...) { error_ = std::current_exception(); }
    done_ = true;
}

std::unique_ptr<LoadedScene> SceneLoader::take() {
    thread_.join();
    if (error_) { std::rethrow_exception(error_); }
    return std::move(loaded_);
}

}  // namespace binosplat
