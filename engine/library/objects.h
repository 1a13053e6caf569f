// What the interface's handles lead to.
#pragma once

#include "engine/frame/stereo_frame.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/library/errors.h"

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <vector>

namespace binosplat {

// Scenes of bsp_splats. Throws Error where a field makes no sense.
Scene sceneOf(const bsp_splats& splats, LoadNotes& notes);

// A view as the engine has it; positions count from `origin`.
Eye eyeOf(const bsp_view& view, const glm::dvec3& origin);

}  // namespace binosplat

struct bsp_device_t {
    explicit bsp_device_t(const bsp_device_info& info);

    void log(const std::string& line) const {
        if (log_to != nullptr) { log_to(log_user, line.c_str()); }
    }

    bsp_log log_to;
    void* log_user;
    binosplat::Context context;
    binosplat::GpuScene empty;  // what renderers show that show nothing
    std::mutex renderers_mutex;
    std::set<bsp_renderer_t*> renderers;
};

// Loads on a thread of its own, which ends with the object at the latest.
struct bsp_scene_t {
    bsp_scene_t(bsp_device_t& of_device, std::string from_source, std::optional<binosplat::Scene> of_splats, binosplat::LoadNotes notes);
    ~bsp_scene_t();

    [[nodiscard]] bsp_result state(double* progress, bool waits);
    // Throws unless it is there.
    void requireThere();

    bsp_device_t& device;
    const std::string source;
    std::atomic<bool> cancelled{false};
    // The rest is there once loading has ended well.
    std::unique_ptr<binosplat::GpuScene> gpu;
    bsp_scene_properties properties{};
    glm::dvec3 origin{0.0};

private:
    void load(std::optional<binosplat::Scene> scene, binosplat::LoadNotes notes);
    void judge(const binosplat::Scene& scene, const binosplat::LoadNotes& notes);

    std::mutex mutex_;
    std::condition_variable ended_;
    bool has_ended_ = false;
    binosplat::Failure failure_{BSP_SUCCESS, ""};
    std::atomic<double> progress_{0.0};
    std::thread thread_;  // last
};

struct bsp_renderer_t {
    explicit bsp_renderer_t(bsp_device_t& of_device);
    ~bsp_renderer_t();

    void render(const bsp_frame_info& frame, bsp_frame_result* result);
    binosplat::Image read(std::uint32_t view, bool depth);
    // From now on frames are of nothing.
    void forget() noexcept;

    bsp_device_t& device;
    bsp_scene_t* shown = nullptr;

private:
    // Of a pair of views, or of the last one alone.
    struct Part {
        std::unique_ptr<binosplat::StereoFrame> frame;
        std::size_t views = 0;
    };

    Part& part(std::size_t index);
    // From now on frames are of it; null: of nothing.
    void show(bsp_scene_t* scene);

    std::vector<Part> parts_;  // the first one owns the kernels of all
    std::size_t views_read_ = 0;
    bool has_depth_ = false;
};
