// A scene of Gaussian splats on the host, 2D (discs) or 3D, as float32 after the activations of their
// training (docs/how-it-works.md).
#pragma once

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace binosplat {

inline constexpr int kMaxShDegree = 3;

// (degree + 1)^2: SH coefficients per colour channel, including the constant one.
constexpr int shCoefficientCount(int sh_degree) { return (sh_degree + 1) * (sh_degree + 1); }

// Structure of arrays; every vector holds one entry per splat (`sh`: 3 * shCoefficientCount(sh_degree) per
// splat).
struct Scene {
    std::string name;                  // file or builtin:NAME, for messages
    std::vector<glm::vec3> positions;  // centre p, world, scene units
    std::vector<glm::quat> rotations;  // unit; columns of its matrix are t_u, t_v, t_w
    std::vector<glm::vec2> scales;     // s_u, s_v = exp(stored), scene units
    // For 3D Gaussians: s_w, the shortest of the three, along t_w; empty: all splats are discs.
    std::vector<float> thicknesses;
    std::vector<float> opacities;  // o = sigmoid(stored), 0 to 1
    std::vector<float> sh;         // sh[(splat * shCoefficientCount(sh_degree) + k) * 3 + channel]
    // 0 to 3: the highest band with a non-zero coefficient; higher bands are not stored
    int sh_degree = 0;
    // The origin of `positions`, in the file's coordinates: far from 0 float32 would lose their detail. Users
    // give and read file coordinates: the origin is subtracted from input for the scene, and added to output.
    glm::dvec3 origin{0.0};
    // 3D Gaussians: trained with opacities that the low-pass dims (Yu et al. 2024, section 5.2)
    bool antialiased = false;

    bool by_distance = false;  // to be blended by distance, not by depth
    // Up is +y, and the front is seen from +z, as in glTF; otherwise, as in trainings, -y and from -z.
    bool y_up = false;
    // 0 to 2, as the file says; for y, `y_up` then says which way is up; -1: the file does not say
    int vertical_axis = -1;
    bool is_linear = false;  // colours of linear light, to be encoded after blending

    [[nodiscard]] std::size_t size() const { return positions.size(); }
    [[nodiscard]] bool isGaussian3d() const { return !thicknesses.empty(); }
};

// What loading found, for `info`, the report and the user.
struct LoadNotes {
    std::string format;  // of the file; empty for a built-in scene
    std::uint64_t splats_in_file = 0;
    // Splats with a NaN or infinity in position, scale, rotation, opacity or colour.
    std::uint64_t skipped_not_finite = 0;
    std::uint64_t skipped_zero_rotation = 0;  // a quaternion of length zero
    int sh_degree_in_file = 0;                // bands above Scene::sh_degree were all zero and were left out
    bool sh_limited = false;                  // or were left out on request
    bool three_scales = false;                // a 3DGS scene
    double median_flatness = 0.0;             // 3DGS only: median of shortest / second shortest axis
    // The directions of x, y and z and their handedness, from the file; empty: not stated.
    std::string axes;
    std::string colour_space;  // from the file; empty: not stated
    // The splats of each level of detail, the finest first; empty: a scene without levels.
    std::vector<std::uint64_t> level_splats;
    std::uint32_t level = 0;               // the loaded one
    std::uint64_t environment_splats = 0;  // loaded with every level
    // Why a scene from the web may be outdated; empty: it is current.
    std::string stale;
    std::vector<std::string> lines;  // one sentence each, for the user
};

// Called now and then with the share done, 0 to 1.
using Progress = std::function<void(double)>;

// Removes the bands of colours above `sh_degree`, with a line in `notes` if there are any.
void limitShDegree(Scene& scene, int sh_degree, LoadNotes& notes);

// Makes positions relative to another place, without moving anything.
void countFrom(Scene& scene, const glm::dvec3& origin);

// The origin for messages: "500000,4600000,0".
std::string describeOrigin(const Scene& scene);

// Keeps the splats whose centres lie within a sphere, in scene units.
void keepWithin(Scene& scene, const glm::dvec3& centre, double radius);

// Makes discs from 3D Gaussians by dropping the shortest axis of each, with a line in `notes`; discs stay as
// they are.
void flatten(Scene& scene, LoadNotes& notes);

}  // namespace binosplat
