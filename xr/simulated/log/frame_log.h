// A line of JSON per frame: what the application submitted, when, and what the runtime told it meanwhile.
#pragma once

#include "xr/simulated/compose/geometry.h"

#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace simulated {

struct LoggedDepth {
    std::string format;  // as swapchain formats: "VK_FORMAT_D32_SFLOAT"
    double min_depth = 0.0, max_depth = 1.0, near_z = 0.0, far_z = 0.0;
};

// An XrSwapchainSubImage, and for projection views where and how it was seen.
struct LoggedView {
    std::string name;  // if there are insets: "left", "right", "left_inset", "right_inset"
    std::uint64_t swapchain = 0;
    std::uint32_t image_index = 0;  // the image last released
    std::uint32_t array_index = 0;
    std::string format;
    std::int32_t x = 0, y = 0, width = 0, height = 0;
    std::optional<Pose> pose;  // in the layer's space, as submitted
    std::optional<Fov> fov;
    std::optional<LoggedDepth> depth;
};

struct LoggedLayer {
    // "projection", "quad", "cylinder", "equirect2", "cube", "passthrough"
    std::string type;
    std::vector<std::string> flags;  // "blend_texture_source_alpha" ...
    std::string space;               // "LOCAL", "STAGE", "VIEW", "action"
    Pose stage_from_space;           // at the display time
    // Two or four for a projection layer, otherwise one.
    std::vector<LoggedView> views;
    std::optional<Pose> pose;          // quads: in the layer's space
    std::optional<glm::dvec2> size_m;  // quads
    // For quads and surrounding layers: "both", "left", "right".
    std::string eye_visibility;
    // For cylinders and spheres: "radius", "central_angle" ...
    std::vector<std::pair<std::string, double>> numbers = {};
};

struct LoggedEye {
    Pose stage_from_eye;
    Fov fov;
    std::optional<Fov> inset;  // if the session draws insets
};

struct FrameRecord {
    std::uint64_t frame = 0;
    std::int64_t display_time_ns = 0;
    std::int64_t period_ns = 0;
    std::optional<double> gpu_ms;  // if the script sets it
    bool should_render = true;
    std::string session_state;  // "FOCUSED" ...
    std::string blend_mode;     // "OPAQUE" ...
    Pose stage_from_head;
    std::array<LoggedEye, 2> eyes;  // by Side
    std::vector<LoggedLayer> layers;
    std::vector<std::string> events;  // since the line before: "state VISIBLE", "exit", "slow-images 3" ...
    std::string picture;              // the file's name, empty if the frame has none
};

// Events between shown frames: a frame that xrEndFrame refused, or session states that no frame follows.
struct BetweenRecord {
    std::string refused;  // "XR_ERROR_VALIDATION_FAILURE"; empty: no frame was refused
    std::string reason;
    std::int64_t display_time_ns = 0;
    bool should_render = true;  // of a frame that was refused
    std::string session_state;
    std::vector<std::string> events;  // as a frame's
};

// One line without its end; numbers are written so that reading them gives the same number, quaternions as x,
// y, z, w, angles in radians.
[[nodiscard]] std::string makeFrameLine(const FrameRecord& record);
// A line without "frame".
[[nodiscard]] std::string makeBetweenLine(const BetweenRecord& record);

// Lines are flushed at once, so that a program that dies leaves a log of all frames until then.
class FrameLog {
public:
    // Creates the file, which must not exist. Throws std::runtime_error naming it.
    explicit FrameLog(const std::filesystem::path& path);
    void write(const std::string& line);

private:
    std::filesystem::path path_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace simulated
