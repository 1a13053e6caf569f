// Twin of project: a splat as one eye sees it: pixel rows, their reduced form, colour and box.
#include "engine/parallel.h"
#include "engine/twin/harmonics.h"
#include "engine/twin/reach.h"

namespace binosplat::reference {
namespace {

// 0.5 + SH(d); if the splat is at the eye itself, d is zero, and only the constant is left.
glm::dvec3 shade(const Scene& scene, std::size_t splat, const EyeFrame& eye) {
    const glm::dvec3 from_eye = glm::dvec3(scene.positions[splat]) - eye.position_world;
    const double distance = glm::length(from_eye);
    const glm::dvec3 direction = distance > 0.0 ? from_eye / distance : glm::dvec3(0.0);
    const std::size_t stride = 3 * static_cast<std::size_t>(shCoefficientCount(scene.sh_degree));
    return 0.5 + evaluateHarmonics(scene.sh.data() + splat * stride, scene.sh_degree, direction);
}

// Linear functions 1/z, u/z and v/z of the pixel about reference_px, with the (u, v) frame turned so that v/z
// does not depend on dx. Computed from a, b, c instead of the rows, which tests compare with it.
void reduce(ProjectedSplat& splat, const CameraSplat& camera, const Intrinsics& k) {
    const glm::dvec3 &a = camera.a, &b = camera.b, &c = camera.c;
    // The ray's direction through the reference, and its change per pixel: (1/fx, 0, 0) and (0, 1/fy, 0). The
    // plane's dual basis b x c, c x a, a x b, over det, maps a direction to (u/z, v/z, 1/z).
    const double det = glm::dot(a, glm::cross(b, c));
    const glm::dmat3 dual(glm::cross(b, c) / det, glm::cross(c, a) / det, glm::cross(a, b) / det);
    const glm::dvec3 ray((splat.reference_px.x - k.cx) / k.fx, (splat.reference_px.y - k.cy) / k.fy, 1.0);
    const glm::dvec3 per_x = glm::dvec3(dual[0].x, dual[1].x, dual[2].x) / k.fx;
    const glm::dvec3 per_y = glm::dvec3(dual[0].y, dual[1].y, dual[2].y) / k.fy;
    const double length = std::hypot(per_x.x, per_x.y);
    const double cosine = length > 0.0 ? per_x.x / length : 1.0, sine = length > 0.0 ? per_x.y / length : 0.0;
    const auto turn = [&](double u, double v) {
        return glm::dvec2(cosine * u + sine * v, cosine * v - sine * u);
    };
    const glm::dvec2 turned_y = turn(per_y.x, per_y.y);
    splat.plane_from_pixel = {length, turned_y.x, turned_y.y};
    splat.perspective = {per_x.z, per_y.z};
    if (splat.low_pass) {
        splat.plane_offset = glm::dvec2(0.0);
        splat.inverse_depth = 1.0 / c.z;
    } else {
        splat.plane_offset = turn(glm::dot(dual[0], ray), glm::dot(dual[1], ray));
        splat.inverse_depth = glm::dot(dual[2], ray);
    }
}

// The ellipse of a 3D Gaussian, and its opacity after dimming. False if it is not visible anywhere.
bool placeGaussian(ProjectedSplat& splat, const CameraSplat& camera, const EyeFrame& eye, bool dimmed) {
    const ScreenGaussian g = screenGaussian(camera, eye);
    if (dimmed) {
        splat.opacity *= std::sqrt(g.sharp_det / g.det);
        splat.cut = 2.0 * std::log(255.0 * splat.opacity);
    }
    if (!(splat.cut > 0.0)) { return false; }
    splat.gaussian = splat.disc = true;
    // rho = (yy dx^2 - 2 xy dx dy + xx dy^2) / det as (A dx + B dy)^2 + (D dy)^2.
    const double a = std::sqrt(g.yy / g.det);
    splat.plane_from_pixel = {a, -g.xy / g.yy * a, 1.0 / std::sqrt(g.yy)};
    splat.plane_offset = glm::dvec2(0.0);
    // The mean of 1/z at a place on the screen: Sigma2^-1 times its covariance with the place.
    splat.perspective = glm::dvec2(g.yy * g.with_depth.x - g.xy * g.with_depth.y,
                                   g.xx * g.with_depth.y - g.xy * g.with_depth.x) /
                        g.det;
    splat.inverse_depth = 1.0 / camera.c.z;
    splat.reach_px = {std::sqrt(splat.cut * g.xx), std::sqrt(splat.cut * g.yy)};
    return true;
}

ProjectedSplat projectOne(const Scene& scene, std::size_t index, const EyeFrame& eye, glm::uvec2 size_px,
                          const Settings& settings) {
    ProjectedSplat splat{};
    const std::optional<CameraSplat> camera = toCamera(scene, index, eye);
    const glm::dvec3 colour = shade(scene, index, eye);
    if (!camera || !isFinite(colour)) { return splat; }
    const glm::dvec3 &a = camera->a, &b = camera->b, &c = camera->c;
    const Intrinsics& k = eye.intrinsics;
    splat.low_pass = c.z > settings.near;
    splat.low_pass_factor = kLowPassFactor / (eye.own_pixel_px * eye.own_pixel_px);
    splat.reference_px =
        splat.low_pass ? glm::dvec2(k.fx * c.x / c.z + k.cx, k.fy * c.y / c.z + k.cy) : 0.5 * eye.size_px;
    splat.disc = std::abs(glm::dot(glm::cross(a, b), c)) >
                 kMinPlaneSine * glm::length(a) * glm::length(b) * glm::length(c);
    splat.depth = c.z;
    splat.cut = camera->cut;
    splat.opacity = static_cast<double>(scene.opacities[index]);
    splat.colour = glm::clamp(colour, 0.0, kMaxHalf);
    splat.row_w = {a.z, b.z, c.z};
    splat.row_u = k.fx * glm::dvec3(a.x, b.x, c.x) + k.cx * splat.row_w;
    splat.row_v = k.fy * glm::dvec3(a.y, b.y, c.y) + k.cy * splat.row_w;
    if (scene.isGaussian3d()) {
        if (!splat.low_pass || !placeGaussian(splat, *camera, eye, scene.antialiased)) { return {}; }
    } else if (splat.disc) {
        reduce(splat, *camera, k);
    }
    splat.box_px = boxOfReach(splat, settings, size_px);
    splat.square_box_tiles = countSquareBoxTiles(splat, settings, size_px);
    return splat;
}

}  // namespace

std::vector<ProjectedSplat> project(const Scene& scene, std::span<const std::uint32_t> order, const Eye& eye,
                                    const Settings& settings) {
    std::vector<ProjectedSplat> projected(order.size());
    const EyeFrame frame(eye);
    forBlocks(order.size(), 4096, settings.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            projected[i] = projectOne(scene, order[i], frame, eye.size_px, settings);
        }
    });
    return projected;
}

}  // namespace binosplat::reference
