// Faces of a cube, and one resampling.
#include "engine/picture/panorama.h"

#include "engine/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace binosplat {
namespace {

constexpr double kPi = std::numbers::pi;
// How far a face reaches: the tangent of the angle from its middle. At 1 the next one begins.
constexpr double kReach = 1.1;
// Pixels of a face per pixel of the panorama, at the face's middle, where they are widest: as many as the
// places that are looked up. Otherwise splats' low-pass, which is narrower towards a face's edge, would limit
// sharpness.
constexpr double kFiner = 2.0;

glm::dquat about(const glm::dvec3& axis, double angle_rad) { return glm::angleAxis(angle_rad, axis); }

// camera_from_face: ahead, left, right, up, down and, for a whole sphere, behind.
std::vector<glm::dquat> turnsOf(const Panorama& panorama) {
    const glm::dvec3 x(1.0, 0.0, 0.0), y(0.0, 1.0, 0.0);
    std::vector<glm::dquat> turns{{1.0, 0.0, 0.0, 0.0},
                                  about(y, -kPi / 2.0),
                                  about(y, kPi / 2.0),
                                  about(x, kPi / 2.0),
                                  about(x, -kPi / 2.0)};
    if (panorama.width_rad > kPi) { turns.push_back(about(y, kPi)); }
    return turns;
}

double focalOf(const Panorama& panorama) {
    return kFiner * static_cast<double>(panorama.size_px.x) / panorama.width_rad;
}

// Catmull and Rom's weights of the four pixels around a place, two of which come before it.
std::array<float, 4> cubicWeights(float t) {
    return {0.5f * t * (t * (2.0f - t) - 1.0f), 0.5f * (t * t * (3.0f * t - 5.0f) + 2.0f),
            0.5f * t * (t * (4.0f - 3.0f * t) + 1.0f), 0.5f * t * t * (t - 1.0f)};
}

glm::vec4 sample(const Image& image, const glm::dvec2& place) {
    const glm::dvec2 whole = glm::floor(place);
    const auto across = cubicWeights(static_cast<float>(place.x - whole.x)),
               down = cubicWeights(static_cast<float>(place.y - whole.y));
    const auto pixelAt = [](double first, int step, std::uint32_t size) {
        return static_cast<std::size_t>(std::clamp(first - 1.0 + step, 0.0, static_cast<double>(size) - 1.0));
    };
    glm::vec4 sum(0.0f);
    for (int j = 0; j < 4; ++j) {
        const std::size_t row = pixelAt(whole.y, j, image.size_px.y) * image.size_px.x;
        glm::vec4 along(0.0f);
        for (int i = 0; i < 4; ++i) {
            const float* p = &image.values[4 * (row + pixelAt(whole.x, i, image.size_px.x))];
            along += across[static_cast<std::size_t>(i)] * glm::vec4(p[0], p[1], p[2], p[3]);
        }
        sum += down[static_cast<std::size_t>(j)] * along;
    }
    return sum;
}

// The weights of two adjacent faces add up to 1 along their edge; a single face has weight 1 where no other
// sees a direction.
float weightOf(double tangent) {
    static const double kWide = std::log(kReach);
    return static_cast<float>(std::clamp((kWide - std::log(tangent)) / (2.0 * kWide), 0.0, 1.0));
}

}  // namespace

Eye panoramaEye(const Panorama& panorama, const Pose& world_from_camera) {
    const glm::dvec2 size(panorama.size_px);
    return {world_from_camera,
            {size.x / panorama.width_rad, size.y / kPi, 0.5 * size.x, 0.5 * size.y},
            panorama.size_px};
}

std::vector<Eye> facesOf(const Panorama& panorama, const Pose& world_from_camera) {
    const auto side = static_cast<std::uint32_t>(std::ceil(2.0 * kReach * focalOf(panorama)));
    const double focal = focalOf(panorama), middle = 0.5 * side;
    std::vector<Eye> faces;
    for (const glm::dquat& camera_from_face : turnsOf(panorama)) {
        faces.push_back({compose(world_from_camera, {camera_from_face, glm::dvec3(0.0)}),
                         {focal, focal, middle, middle},
                         {side, side}});
    }
    return faces;
}

Image panoramaOf(const Panorama& panorama, std::span<const Image> faces) {
    const double focal = focalOf(panorama);
    std::vector<glm::dmat3> face_from_camera;
    for (const glm::dquat& turn : turnsOf(panorama)) {
        face_from_camera.push_back(glm::mat3_cast(glm::conjugate(turn)));
    }
    const auto colourOf = [&](const glm::dvec3& direction) {
        glm::vec4 sum(0.0f);
        float weights = 0.0f;
        for (std::size_t i = 0; i < faces.size(); ++i) {
            const glm::dvec3 ray = face_from_camera[i] * direction;
            const double widest = std::max(std::abs(ray.x), std::abs(ray.y));
            if (ray.z <= 0.0 || widest >= kReach * ray.z) { continue; }
            const float weight = weightOf(widest / ray.z);
            const glm::dvec2 place =
                focal * glm::dvec2(ray) / ray.z + 0.5 * glm::dvec2(faces[i].size_px) - 0.5;
            sum += weight * sample(faces[i], place);
            weights += weight;
        }
        return sum / weights;
    };
    const glm::dvec2 size(panorama.size_px);
    Image picture{panorama.size_px, 4,
                  std::vector<float>(4 * std::size_t{panorama.size_px.x} * panorama.size_px.y)};
    forBlocks(panorama.size_px.y, 16, static_cast<int>(std::thread::hardware_concurrency()),
              [&](std::size_t begin, std::size_t end) {
                  for (std::size_t y = begin; y < end; ++y) {
                      for (std::size_t x = 0; x < panorama.size_px.x; ++x) {
                          glm::vec4 sum(0.0f);
                          for (const glm::dvec2& part :
                               {glm::dvec2(0.25, 0.25), {0.75, 0.25}, {0.25, 0.75}, {0.75, 0.75}}) {
                              const double right =
                                  ((static_cast<double>(x) + part.x) / size.x - 0.5) * panorama.width_rad;
                              const double down = ((static_cast<double>(y) + part.y) / size.y - 0.5) * kPi;
                              sum += colourOf({std::sin(right) * std::cos(down), std::sin(down),
                                               std::cos(right) * std::cos(down)});
                          }
                          for (int c = 0; c < 4; ++c) {
                              picture.values[4 * (y * panorama.size_px.x + x) + static_cast<std::size_t>(c)] =
                                  0.25f * sum[c];
                          }
                      }
                  }
              });
    return picture;
}

}  // namespace binosplat
