// Where paths in the room meet the scene, by the depth of its pictures: three frames late, so that nothing
// has to wait.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/passes/frame_buffers.h"
#include "engine/similarity.h"

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace binosplat {

inline constexpr std::size_t kProbePoints = 24;
// Of both hands, by hand, and points where the ground may be.
inline constexpr std::size_t kProbePaths = 3, kGroundPath = 2;
using ProbePath = std::array<glm::dvec3, kProbePoints>;  // in the room, from a hand on

// Of a path, as an eye sees it.
struct PathSeen {
    // The point at which the path first hits something, with a fraction between points; empty: none, or none
    // that is seen.
    std::optional<double> meets;
    bool is_hidden = false;  // part of it is far behind something
};

struct ProbesSeen {
    std::array<PathSeen, 2> hands;
    std::vector<glm::dvec3> ground;  // what the eye sees in the direction of its points, in the scene
};

// Points along a ray, nearer ones closer together.
ProbePath probeRay(const Pose& room_from_aim);
// How far along that ray a point is, which may be a fraction.
double probeMetres(double point);

// The point at a share of the way along these points.
glm::dvec3 pointAlong(std::span<const glm::dvec3> way, double share);

// From the depths of the points and of what is seen there, in metres; empty: nothing is there, or it is out
// of sight.
PathSeen followPath(const std::array<std::optional<double>, kProbePoints>& points_m,
                    const std::array<std::optional<double>, kProbePoints>& seen_m);

class SceneProbe {
public:
    explicit SceneProbe(const Context& context);

    // Once per frame, before it is recorded: takes this frame's paths, and returns what is known about those
    // of three frames ago.
    ProbesSeen ask(const std::array<std::optional<ProbePath>, kProbePaths>& paths);
    // Another scene is shown: earlier questions no longer matter.
    void forget();
    // Within the frame's commands, after its pictures; may be repeated. `scene_from_room` places the scene,
    // and the picture is that of `eye`. Pictures without depth give no answers.
    void record(Commands& commands, const Picture& picture, const Eye& eye,
                const Similarity& scene_from_room);

private:
    struct Asked {
        explicit Asked(const Context& context);
        Buffer found;
        std::array<std::optional<ProbePath>, kProbePaths> paths;
        Pose scene_from_eye;
        Similarity scene_from_room;
        // Depths of the points themselves, where they are in the picture.
        std::array<std::optional<double>, kProbePaths * kProbePoints> depths_m;
        bool is_recorded = false, half_floats = false, has_words = false;
    };
    [[nodiscard]] static std::optional<double> depthIn(const Asked& asked, std::size_t point);

    std::array<Asked, 4> asked_;
    std::size_t turn_ = 0;
};

}  // namespace binosplat
