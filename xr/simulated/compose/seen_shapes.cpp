// Finds where a pixel's ray leaves a cylinder, a sphere or a cube, and what is seen of its picture there.
#include "xr/simulated/compose/seen_shapes.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace simulated {

namespace {

bool isFinite(double radius_m) { return radius_m > 0.0 && std::isfinite(radius_m); }

// Where a ray leaves the circle or sphere of this radius about the origin: the nearest point ahead on its
// inside. `a`, `b`, `c` are those of a t^2 + 2 b t + c = 0.
std::optional<double> findWayOut(double a, double b, double c) {
    const double root = b * b - a * c;
    if (!(a > 0.0) || root < 0.0) { return std::nullopt; }
    const double t = (-b + std::sqrt(root)) / a;
    return t > 0.0 ? std::optional(t) : std::nullopt;
}

double longitude(const glm::dvec3& place) { return std::atan2(place.x, -place.z); }

Rect wholeOf(const Picture& picture) { return {{0, 0}, picture.size_px}; }

}  // namespace

LayerRays::LayerRays(const EyeView& eye_view, const Pose& stage_from_layer) {
    const Pose layer_from_eye_pose = compose(inverse(stage_from_layer), eye_view.stage_from_eye);
    eye = layer_from_eye_pose.position;
    layer_from_eye = glm::mat3_cast(layer_from_eye_pose.orientation);
}

SeenCylinder::SeenCylinder(const EyeView& eye, const CylinderLayer& layer)
    : sampler_(layer.picture, layer.rect), rays_(eye, layer.stage_from_cylinder), layer_(layer) {}

std::optional<glm::dvec4> SeenCylinder::at(std::uint32_t, std::uint32_t,
                                           const glm::dvec3& direction_eye) const {
    const double radius_m = layer_.radius_m, angle_rad = layer_.central_angle_rad;
    if (!(angle_rad > 0.0)) { return std::nullopt; }
    const glm::dvec3 direction = rays_.layer_from_eye * direction_eye;
    const double level = std::hypot(direction.x, direction.z);
    glm::dvec3 place = level > 0.0 ? direction / level : glm::dvec3(0.0);
    if (!(level > 0.0)) { return std::nullopt; }  // straight up or down
    if (isFinite(radius_m)) {
        const glm::dvec3& from = rays_.eye;
        const auto t = findWayOut(level * level, direction.x * from.x + direction.z * from.z,
                                  from.x * from.x + from.z * from.z - radius_m * radius_m);
        if (!t) { return std::nullopt; }
        place = (from + *t * direction) / radius_m;
    }
    // On the cylinder of radius 1 the picture is as wide as its angle.
    return sampler_.sampleInside(0.5 + longitude(place) / angle_rad,
                                 0.5 - place.y * layer_.aspect_ratio / angle_rad);
}

SeenSphere::SeenSphere(const EyeView& eye, const SphereLayer& layer)
    : sampler_(layer.picture, layer.rect), rays_(eye, layer.stage_from_sphere), layer_(layer) {}

std::optional<glm::dvec4> SeenSphere::at(std::uint32_t, std::uint32_t,
                                         const glm::dvec3& direction_eye) const {
    const double upper_rad = layer_.upper_angle_rad, lower_rad = layer_.lower_angle_rad;
    if (!(layer_.horizontal_angle_rad > 0.0) || !(upper_rad > lower_rad)) { return std::nullopt; }
    const glm::dvec3 direction = rays_.layer_from_eye * direction_eye;
    glm::dvec3 place = direction;
    if (isFinite(layer_.radius_m)) {
        const glm::dvec3& from = rays_.eye;
        const auto t = findWayOut(glm::dot(direction, direction), glm::dot(direction, from),
                                  glm::dot(from, from) - layer_.radius_m * layer_.radius_m);
        if (!t) { return std::nullopt; }
        place = from + *t * direction;
    }
    const double latitude = std::asin(std::clamp(place.y / glm::length(place), -1.0, 1.0));
    return sampler_.sampleInside(0.5 + longitude(place) / layer_.horizontal_angle_rad,
                                 (upper_rad - latitude) / (upper_rad - lower_rad));
}

SeenCube::SeenCube(const EyeView& eye, const CubeLayer& layer) : rays_(eye, {layer.stage_from_cube, {}}) {
    for (const Picture& face : layer.faces) { faces_.emplace_back(face, wholeOf(face)); }
}

std::optional<glm::dvec4> SeenCube::at(std::uint32_t, std::uint32_t, const glm::dvec3& direction_eye) const {
    const glm::dvec3 d = rays_.layer_from_eye * direction_eye, size = glm::abs(d);
    // Vulkan, "Cube Map Face Selection".
    std::size_t face = 0;
    glm::dvec2 st(0.0);
    if (size.x >= size.y && size.x >= size.z) {
        face = d.x > 0.0 ? 0 : 1;
        st = glm::dvec2(d.x > 0.0 ? -d.z : d.z, -d.y) / size.x;
    } else if (size.y >= size.z) {
        face = d.y > 0.0 ? 2 : 3;
        st = glm::dvec2(d.x, d.y > 0.0 ? d.z : -d.z) / size.y;
    } else {
        face = d.z > 0.0 ? 4 : 5;
        st = glm::dvec2(d.z > 0.0 ? d.x : -d.x, -d.y) / size.z;
    }
    return faces_[face].sample(0.5 * (st.x + 1.0), 0.5 * (st.y + 1.0));
}

}  // namespace simulated
