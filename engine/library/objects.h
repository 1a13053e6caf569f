// The objects behind the interface's handles.
#pragma once

#include "engine/frame/stereo_frame.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/library/errors.h"
#include "engine/library/targets.h"
#include "engine/stream/live_scene.h"
#include "engine/stream/placed_scenes.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <thread>
#include <vector>

namespace binosplat {

// A scene from bsp_splats. Throws Error if a field does not make sense.
Scene sceneOf(const bsp_splats& splats, LoadNotes& notes);

// Of the first version.
constexpr std::size_t kFirstViewSize = offsetof(bsp_view, height) + sizeof(std::uint32_t);
// A view in the engine's form; positions are relative to `origin`.
Eye eyeOf(const bsp_view& view, const glm::dvec3& origin);

// A frame's settings in the engine's form.
struct AskedFrame {
    std::vector<Eye> eyes;
    std::vector<std::optional<Gaze>> gazes;
    std::vector<bsp_target> targets;  // one for each eye, if the frame has them
    FrameSettings settings;
    std::vector<bsp_scene_t*> scenes;  // a single one, or those of the instances
    std::vector<PlacedScene> placed;   // the instances; empty: the scene by itself
    glm::dvec3 origin{0.0};            // eyes are relative to it
    double time_s = 0.0;
    bool is_cut = false, settles = false;
};

// Brings a scene's changes to the device in submissions of its own, so that frames that the program holds may
// be dropped.
class ChangeUploads {
public:
    explicit ChangeUploads(const Context& context) : context_(context) {}
    // Does not wait. If it throws, the device may lack what the scene believes it has: hasLost().
    void bring(const GpuScene& scene);
    [[nodiscard]] bool hasLost() const { return has_lost_; }

private:
    const Context& context_;
    std::vector<std::unique_ptr<Commands>> commands_;
    bool has_lost_ = false;
};

bsp_frame_info readFrame(const bsp_frame_info* frame);
bsp_frame_result resultOf(const FrameResult& result, double share_there);

// A command buffer of the library's own, which executes lent commands.
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
    binosplat::GpuScene empty;  // shown by renderers that show nothing
    std::mutex renderers_mutex;
    std::set<bsp_renderer_t*> renderers;
};

// Loads on a thread of its own, which ends before the object does.
struct bsp_scene_t {
    bsp_scene_t(bsp_device_t& of_device, const bsp_scene_info& info,
                std::optional<binosplat::Scene> of_splats, binosplat::LoadNotes notes);
    ~bsp_scene_t();

    [[nodiscard]] const binosplat::GpuScene& onDevice() const { return live ? live->scene() : *gpu; }
    // For a live scene: requests what the eyes see at that time, and uploads what has been loaded, or
    // everything if it settles.
    void advance(std::span<const binosplat::Eye> eyes, double time_s, bool settles);

    [[nodiscard]] bsp_result state(double* progress, bool waits);
    // Throws unless the scene is loaded.
    void requireThere();

    bsp_device_t& device;
    const std::string source;
    const bsp_scene_info asked;  // its pointers are no longer valid
    std::atomic<bool> cancelled{false};
    // The rest is set once loading has succeeded.
    std::unique_ptr<binosplat::GpuScene> gpu;
    std::unique_ptr<binosplat::LiveScene> live;  // in place of `scene`
    bsp_scene_properties properties{};
    glm::dvec3 origin{0.0};

private:
    void load(std::optional<binosplat::Scene> scene, binosplat::LoadNotes notes);
    // Makes `live`, and returns a scene that represents it; nothing if the source neither streams nor moves.
    std::optional<binosplat::Scene> openLive(binosplat::LoadNotes& notes,
                                             const binosplat::Progress& progress);
    void judge(const binosplat::Scene& scene, const binosplat::LoadNotes& notes);

    binosplat::ChangeUploads uploads_;
    std::optional<std::chrono::steady_clock::time_point> advanced_;
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
    void render(binosplat::AskedFrame& asked, bsp_frame_result* result);
    binosplat::Image read(std::uint32_t view, bool depth);
    // Frames show nothing from now on.
    void forget() noexcept;
    [[nodiscard]] bool shows(const bsp_scene_t* scene);

    // For programs with images of their own (record.cpp).
    void prepare(binosplat::AskedFrame& asked);
    std::uint64_t record(binosplat::AskedFrame& asked, VkCommandBuffer commands);
    std::uint64_t submit(binosplat::AskedFrame& asked, const bsp_submit_info& info);
    // False if the device has not finished it.
    bool collect(std::uint64_t number, bsp_frame_result* result);
    void discard(std::uint64_t number);

    bsp_device_t& device;

private:
    // A recorded frame: its number in each part.
    struct Lent {
        std::vector<std::uint64_t> numbers;
        double share_there = 1.0;
        std::unique_ptr<binosplat::Submission> submission;  // null: the program submits it
    };

    static std::span<const binosplat::Eye> eyesOf(const binosplat::AskedFrame& asked, std::size_t part);
    static binosplat::FrameSettings settingsOf(const binosplat::AskedFrame& asked, std::size_t part);
    // Reads the scenes to show.
    void readScenes(const bsp_frame_info& frame, binosplat::AskedFrame& asked) const;
    // True if this part tests splats one by one against the program's depths.
    [[nodiscard]] static bool isCut(const binosplat::AskedFrame& asked, std::size_t part);
    // For a pair of views, or for the last one alone.
    binosplat::StereoFrame& part(std::size_t index);
    // Frames show these scenes from now on.
    void show(const binosplat::AskedFrame& asked);
    void showOnDevice(const binosplat::GpuScene& scene);
    // Shows the frame's scenes as they are now, and drops histories if it says so.
    void begin(binosplat::AskedFrame& asked);
    // Records all parts, or none if one fails.
    std::vector<vk::CommandBuffer> lend(binosplat::AskedFrame& asked, Lent& lent);
    void drop(Lent& lent);
    void dropAll() noexcept;

    // Also called by other threads, which may destroy another scene.
    std::mutex shown_mutex_;
    std::vector<bsp_scene_t*> shown_;
    std::unique_ptr<binosplat::PlacedScenes> group_;              // the scenes, if they are instances
    binosplat::ChangeUploads uploads_;                            // of the group
    const binosplat::GpuScene* on_device_;                        // what the parts show
    std::vector<std::unique_ptr<binosplat::StereoFrame>> parts_;  // the first one owns everyone's kernels
    binosplat::TargetImages targets_;
    std::uint64_t last_number_ = 0;
    std::map<std::uint64_t, Lent> lent_;
    std::unique_ptr<binosplat::Submission> idle_submission_;
    std::size_t views_read_ = 0;
    double share_there_ = 1.0;
    bool has_depth_ = false;
};
