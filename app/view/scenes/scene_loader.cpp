// Loads scenes alongside the frames.
#include "app/view/scenes/scene_loader.h"

#include "app/load.h"
#include "app/options/start_view.h"
#include "app/view/placement/placement.h"
#include "app/view/scenes/scene_up.h"
#include "app/view/settings/view_files.h"
#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/error.h"

#include <utility>

namespace binosplat {

namespace {

// The share of reading the file; the rest is the upload to the device.
constexpr double kReadingShare = 0.8;

struct Cancelled {};

// The eye of a standing person, with about a headset's view angle.
Eye startEye(const View& start) {
    constexpr glm::uvec2 kSizePx(1024, 1024);
    return {lookAt(start.eye, start.look, start.up), intrinsicsFromFovX(glm::radians(100.0), kSizePx),
            kSizePx};
}

// Facts about the whole scene, not its coarsest level.
void tellOfStream(SceneFacts& facts, const SceneStream& stream) {
    facts.splats = stream.source().meta().levels.front().splats + stream.source().environmentSplats();
    facts.device_bytes = stream.scene().bytes();
}

}  // namespace

std::string placeOf(const std::string& scene) {
    if (isBuiltin(scene) || isAddress(scene)) { return scene; }
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::weakly_canonical(scene, error);
    return error ? scene : whole.string();
}

std::pair<std::uint32_t, int> kindOf(const LoadedScene& scene) {
    return {scene.gpu_scene.splatKind(), scene.gpu_scene.shDegree()};
}

void LoadedScene::follow(std::span<const Eye> eyes, double step_seconds) {
    if (!live) { return; }
    clock.pass(step_seconds);
    live->setTime(clock.time_s());
    live->update(eyes, step_seconds);
}

void LoadedScene::count(FrameCounters& counters) const {
    if (live) { counters.streaming = streamingOf(*live); }
}

SceneLoader::SceneLoader(const Context& context, PassKernels& kernels, std::string scene, RunOptions options,
                         std::optional<FramesAhead> ahead, bool settled)
    : scene_(std::move(scene)),
      ahead_(std::move(ahead)),
      thread_([this, &context, &kernels, run = std::move(options), settled] {
          load(context, kernels, run, settled);
      }) {}

SceneLoader::~SceneLoader() {
    cancelled_ = true;
    if (thread_.joinable()) { thread_.join(); }
}

void SceneLoader::cancel() {
    const std::lock_guard lock(mutex_);
    cancelled_ = true;
    if (done_) { loaded_.reset(); }
}

void SceneLoader::expect(const FramesAhead& ahead) {
    const std::lock_guard lock(mutex_);
    ahead_ = ahead;
}

void SceneLoader::load(const Context& context, PassKernels& kernels, const RunOptions& options,
                       bool settled) {
    try {
        LoadNotes notes;
        // Readers may report from threads of their own, where this must not throw.
        const auto reading = [this, own = std::this_thread::get_id()](double share) {
            if (cancelled_ && std::this_thread::get_id() == own) { throw Cancelled(); }
            progress_ = kReadingShare * share;
        };
        std::optional<OpenedScene> opened;
        if (mayLive(scene_, options.load)) {
            opened = openLive(context, scene_, options, StreamFor::kFrames, reading);
        }
        if (opened) { notes = std::move(opened->notes); }
        Scene scene = opened ? std::move(opened->sample)
                             : loadAsAsked(scene_, options.load, options.memory_limit_mib, notes, reading);
        reading(1.0);
        const View start = startView(scene, options.camera, options.metres_per_unit);
        SceneFacts facts = factsOf(scene, notes, scene_);
        const glm::dvec3 up = upOfScene(scene, scene_, start.up);
        const std::optional<double> floor = floorHeight(scene, up);
        const auto bringing = [this](double share) {
            if (cancelled_) { throw Cancelled(); }
            progress_ = kReadingShare + (1.0 - kReadingShare) * share;
        };
        if (opened) {
            loaded_ = std::make_unique<LoadedScene>(std::move(*opened));
            const Eye eye = startEye(start);
            if (SceneStream* const stream = loaded_->stream) {
                settled ? stream->settle({&eye, 1}, bringing) : stream->settleCoarsest({&eye, 1}, bringing);
                tellOfStream(facts, *stream);
            }
        } else {
            loaded_ = std::make_unique<LoadedScene>(context, scene, bringing);
        }
        loaded_->name = scene_;
        loaded_->place = placeOf(scene_);
        loaded_->origin = scene.origin;
        try {
            const RememberedPlace remembered = rememberedPlace(scene_);
            loaded_->remembered = remembered.scene_from_room;
            loaded_->measured = remembered.metres_per_unit;
            if (loaded_->remembered) { loaded_->remembered->position -= scene.origin; }
        } catch (const Error& error) { loaded_->remembering_trouble = error.what(); }
        const bool is_asked_for =
            options.camera.eye || options.camera.look || !options.camera.cameras_file.empty();
        const double growth = is_asked_for ? 1.0 : growthToSee(start, options.metres_per_unit);
        loaded_->start_view = start;
        loaded_->start = startPlacement(start, growth * options.metres_per_unit);
        loaded_->up = up;
        loaded_->floor = floor;
        loaded_->viewpoints = findViewpoints(scene, scene_, options.camera.cameras_file);
        loaded_->facts = std::move(facts);
        loaded_->notes = std::move(notes);
        makeKernels(context, kernels, options);
    } catch (const Cancelled&) {
        loaded_.reset();  // nobody waits
    } catch (...) { error_ = std::current_exception(); }
    const std::lock_guard lock(mutex_);
    if (cancelled_ || error_) { loaded_.reset(); }  // cancelled after the last check
    done_ = true;
}

void SceneLoader::makeKernels(const Context& context, PassKernels& kernels, const RunOptions& options) {
    while (!finish()) {
        {
            const std::lock_guard lock(mutex_);
            made_for_ = ahead_;
        }
        if (made_for_->known.contains(kindOf(*loaded_))) { continue; }
        makeKernelsAhead(context, kernels, loaded_->gpu_scene, options.camera, *made_for_, [this] {
            if (cancelled_) { throw Cancelled(); }
        });
    }
}

bool SceneLoader::finish() {
    const std::lock_guard lock(mutex_);
    if (ahead_ && !(made_for_ && made_for_->isLike(*ahead_))) { return false; }
    done_ = true;
    return true;
}

std::unique_ptr<LoadedScene> SceneLoader::take() {
    thread_.join();
    if (error_) { std::rethrow_exception(error_); }
    return std::move(loaded_);
}

}  // namespace binosplat
