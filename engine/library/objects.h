// What the interface's handles lead to.
#pragma once

#include "engine/frame/stereo_frame.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/library/errors.h"
#include "engine/library/targets.h"

#include <atomic>
#include <condition_variable>
#include <map>
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

// What a frame is asked for, as the engine has it.
struct AskedFrame {
    std::vector<Eye> eyes;
    std::vector<bsp_target> targets;  // for each eye, if the frame has them
    FrameSettings settings;
    bsp_scene_t* scene = nullptr;
    bool is_cut = false;
};

bsp_frame_info readFrame(const bsp_frame_info* frame);
bsp_frame_result resultOf(const FrameResult& result);

// A command buffer of the library's own around what was lent.
struct Submission {
    explicit Submission(const Context& context);
    vk::raii::CommandPool pool;
    vk::raii::CommandBuffer commands{nullptr};
    vk::raii::Fence fence;
};

}  // namespace binosplat

struct bsp_device_t {
    bsp_device_t(const bsp_device_info& info, const binosplat::ContextOptions& options);

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

    [[nodiscard]] binosplat::AskedFrame ask(const bsp_frame_info& frame, bool with_targets) const;
    void render(const binosplat::AskedFrame& asked, bsp_frame_result* result);
    binosplat::Image read(std::uint32_t view, bool depth);
    // From now on frames are of nothing.
    void forget() noexcept;

    // For programs with images of their own (record.cpp).
    void prepare(const binosplat::AskedFrame& asked);
    std::uint64_t record(const binosplat::AskedFrame& asked, VkCommandBuffer commands);
    std::uint64_t submit(const binosplat::AskedFrame& asked, const bsp_submit_info& info);
    // False if the device is not done with it.
    bool collect(std::uint64_t number, bsp_frame_result* result);
    void discard(std::uint64_t number);

    bsp_device_t& device;
    std::atomic<bsp_scene_t*> shown{nullptr};  // another thread may destroy another scene

private:
    // A frame that was recorded: for each part its number there.
    struct Lent {
        std::vector<std::uint64_t> numbers;
        std::unique_ptr<binosplat::Submission> submission;  // null: the program submits it
    };

    static std::span<const binosplat::Eye> eyesOf(const binosplat::AskedFrame& asked, std::size_t part);
    static binosplat::FrameSettings settingsOf(const binosplat::AskedFrame& asked, std::size_t part);
    [[nodiscard]] const binosplat::GpuScene& gpuOf(const bsp_scene_t* scene) const { return scene != nullptr ? *scene->gpu : device.empty; }
    // Of a pair of views, or of the last one alone.
    binosplat::StereoFrame& part(std::size_t index);
    // From now on frames are of it; null: of nothing.
    void show(bsp_scene_t* scene);
    // Shows its scene, and drops pasts if it says so.
    void begin(const binosplat::AskedFrame& asked);
    // Records all parts; none if one fails.
    std::vector<vk::CommandBuffer> lend(const binosplat::AskedFrame& asked, Lent& lent);
    void drop(Lent& lent);
    void dropAll() noexcept;

    std::vector<std::unique_ptr<binosplat::StereoFrame>> parts_;  // the first one owns the kernels of all
    binosplat::TargetImages targets_;
    std::uint64_t last_number_ = 0;
    std::map<std::uint64_t, Lent> lent_;
    std::unique_ptr<binosplat::Submission> idle_submission_;
    std::size_t views_read_ = 0;
    bool has_depth_ = false;
};
