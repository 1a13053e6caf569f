// Scenes: loaded on threads of their own.
#include "engine/builtin/procedural.h"
#include "engine/files/web/web_files.h"
#include "engine/library/objects.h"
#include "engine/library/structures.h"
#include "engine/places/standpoint.h"
#include "engine/stream/moving_scene.h"
#include "engine/stream/scene_stream.h"

#include <limits>

using namespace binosplat;

namespace {

constexpr std::uint64_t kCacheBytes = std::uint64_t{4} << 30;  // for scenes from the web, as --cache-limit
WebSettings usualWeb() { return {webCacheFolder(), kCacheBytes, {}}; }
constexpr double kReadingShare = 0.8;  // of loading; the rest is uploading

void put(double (&to)[3], const glm::dvec3& from) {
    for (int i = 0; i < 3; ++i) { to[i] = from[i]; }
}

}  // namespace

bsp_scene_t::bsp_scene_t(bsp_device_t& of_device, const bsp_scene_info& info, std::optional<Scene> of_splats,
                         LoadNotes notes)
    : device(of_device),
      source(info.source != nullptr ? info.source : "splats"),
      asked(info),
      uploads_(of_device.context) {
    thread_ = std::thread([this, scene = std::move(of_splats), known = std::move(notes)]() mutable {
        try {
            load(std::move(scene), std::move(known));
        } catch (...) { failure_ = failureNow(); }
        if (failure_.code != BSP_SUCCESS) { gpu.reset(), live.reset(); }
        const std::lock_guard lock(mutex_);
        has_ended_ = true;
        ended_.notify_all();
    });
}

bsp_scene_t::~bsp_scene_t() {
    cancelled = true;
    thread_.join();
    const std::lock_guard lock(device.renderers_mutex);
    for (bsp_renderer_t* renderer : device.renderers) {
        if (renderer->shows(this)) { renderer->forget(); }
    }
}

void bsp_scene_t::load(std::optional<Scene> scene, LoadNotes notes) {
    const auto stepOf = [this, own = std::this_thread::get_id()](double first, double share) {
        return [=, this](double done) {
            progress_ = first + share * done;
            // A reader's other threads go on until it stops.
            if (cancelled && std::this_thread::get_id() == own) { throw Cancelled(); }
        };
    };
    if (!scene && asked.live != 0) { scene = openLive(notes, stepOf(0.0, kReadingShare)); }
    if (!scene) {
        scene = loadSceneFromAnywhere(source, 0, notes, stepOf(0.0, kReadingShare), {}, usualWeb());
    }
    for (const std::string& line : notes.lines) { device.log(line); }
    judge(*scene, notes);
    if (!live) {
        gpu = std::make_unique<GpuScene>(device.context, *scene, stepOf(kReadingShare, 1.0 - kReadingShare),
                                         true);
    }
    properties.device_bytes = onDevice().bytes();
    if (cancelled) { throw Cancelled(); }
    progress_ = 1.0;
}

std::optional<Scene> bsp_scene_t::openLive(LoadNotes& notes, const Progress& progress) {
    const int threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()) / 2, 1, 4);
    if (!isStreamedScene(source)) {
        if (!isMovingScene(source)) { return std::nullopt; }
        MovingSettings settings{.threads = threads};
        if (asked.rate_hz > 0.0) { settings.rate_hz = asked.rate_hz; }
        auto moving =
            std::make_unique<MovingScene>(device.context, SceneSeries(source), std::move(settings), progress);
        notes = moving->notes();
        Scene first = moving->takeFirst();
        live = std::move(moving);
        return first;
    }
    WebSettings web = usualWeb();
    web.fetch.attempts = 2;  // the loader retries by itself
    auto chunks = std::make_unique<ChunkSource>(source, web, progress);
    const auto coarsest = static_cast<std::uint32_t>(chunks->meta().levels.size() - 1);
    Scene scene =
        loadSceneFromAnywhere(source, 0, notes, progress, {.level = coarsest, .fits = {}}, usualWeb());
    StreamSettings settings{.splat_budget = asked.splat_budget};
    live = std::make_unique<SceneStream>(device.context, std::move(chunks), std::move(settings));
    return scene;
}

void bsp_scene_t::judge(const Scene& scene, const LoadNotes& notes) {
    origin = scene.origin;
    const std::optional<View> own = isBuiltin(source) ? builtinView(source) : std::nullopt;
    const View start = own ? *own : judgeStandpoint(scene).view;
    properties.splats = scene.size();
    properties.skipped = notes.skipped_not_finite + notes.skipped_zero_rotation;
    properties.scale_count = scene.isGaussian3d() ? 3 : 2;
    properties.sh_degree = static_cast<std::uint32_t>(scene.sh_degree);
    properties.core_size = coreSize(scene);
    properties.near = usualNear(scene);
    glm::vec3 low(std::numeric_limits<float>::infinity()), high(-low);
    for (const glm::vec3& position : scene.positions) {
        low = glm::min(low, position), high = glm::max(high, position);
    }
    if (scene.size() == 0) { low = high = glm::vec3(0.0f); }
    put(properties.low, glm::dvec3(low) + origin);
    put(properties.high, glm::dvec3(high) + origin);
    put(properties.eye, start.eye + origin);
    put(properties.look, start.look + origin);
    put(properties.up, start.up);
}

bsp_result bsp_scene_t::state(double* progress, bool waits) {
    std::unique_lock lock(mutex_);
    if (waits) {
        ended_.wait(lock, [this] { return has_ended_; });
    }
    if (progress != nullptr) { *progress = progress_; }
    if (!has_ended_) { return BSP_NOT_READY; }
    return failure_.code == BSP_SUCCESS ? BSP_SUCCESS : report(failure_);
}

void bsp_scene_t::requireThere() {
    const std::lock_guard lock(mutex_);
    check(has_ended_, "{}: the scene is still loading, must be loaded", source);
    check(failure_.code == BSP_SUCCESS, "the scene was not loaded: {}", failure_.text);
}

bsp_result bsp_scene_create(bsp_device device, const bsp_scene_info* info, bsp_scene* scene) {
    return guarded([&] {
        check(device != nullptr && scene != nullptr, "{} is null", device == nullptr ? "device" : "scene");
        const auto known =
            readStructure(info, BSP_TYPE_SCENE_INFO, offsetof(bsp_scene_info, splats), "bsp_scene_info");
        check((known.source == nullptr) != (known.splats == nullptr),
              "bsp_scene_info has {}, must have a source or splats",
              known.source == nullptr ? "neither" : "both");
        check(known.rate_hz >= 0.0 && std::isfinite(known.rate_hz), "rate_hz is {}, must be 0 or more",
              known.rate_hz);
        LoadNotes notes;
        std::optional<Scene> of_splats;
        if (known.splats != nullptr) {
            of_splats = sceneOf(
                readStructure(known.splats, BSP_TYPE_SPLATS, offsetof(bsp_splats, activated), "bsp_splats"),
                notes);
        }
        *scene = new bsp_scene_t(*device, known, std::move(of_splats), std::move(notes));
        return BSP_SUCCESS;
    });
}

bsp_result bsp_scene_state(bsp_scene scene, double* progress) {
    return guarded([&] { return scene->state(progress, false); });
}

bsp_result bsp_scene_wait(bsp_scene scene) {
    return guarded([&] { return scene->state(nullptr, true); });
}

void bsp_scene_cancel(bsp_scene scene) { scene->cancelled = true; }

void bsp_scene_destroy(bsp_scene scene) { delete scene; }

bsp_result bsp_scene_get_properties(bsp_scene scene, bsp_scene_properties* properties) {
    return guarded([&] {
        checkHeader(properties, BSP_TYPE_SCENE_PROPERTIES, sizeof(bsp_header), "bsp_scene_properties");
        scene->requireThere();
        writeStructure(properties, scene->properties);
        return BSP_SUCCESS;
    });
}
