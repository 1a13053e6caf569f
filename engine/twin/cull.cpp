// Twin of cull: finds the splats that may touch a pixel. A disc with support function h(n) = n.c + r |(n.a,
// n.b)| lies outside a half-space n.p >= d of the frustum if h(n) < d, where r = sqrt(cut) is how far its
// opacity lets it reach. A 3D Gaussian has a box on the screen.
#include "engine/parallel.h"
#include "engine/twin/splat.h"

namespace binosplat::reference {
namespace {

// Half-spaces n.p >= 0 through the eye and the outermost pixel centres, and the image's bounds, with a small
// margin against rounding.
struct Frustum {
    Frustum(const Eye& eye, double near_depth) : frame(eye), near(near_depth) {
        const Intrinsics& k = eye.intrinsics;
        first = glm::dvec2(0.5) - kSlackPx;
        last = glm::dvec2(eye.size_px) - 0.5 + kSlackPx;
        sides = {glm::dvec3(k.fx, 0.0, k.cx - first.x), glm::dvec3(-k.fx, 0.0, last.x - k.cx),
                 glm::dvec3(0.0, k.fy, k.cy - first.y), glm::dvec3(0.0, -k.fy, last.y - k.cy)};
    }

    // Written so that NaN fails.
    [[nodiscard]] bool mayTouch(const CameraSplat& splat, bool gaussian) const {
        if (gaussian) { return splat.c.z > near && gaussianTouches(splat); }
        const double reach = std::sqrt(splat.cut);
        const auto support = [&](const glm::dvec3& normal) {
            return glm::dot(normal, splat.c) +
                   reach * std::hypot(glm::dot(normal, splat.a), glm::dot(normal, splat.b));
        };
        if (support({0.0, 0.0, 1.0}) >= near && support(sides[0]) >= 0.0 && support(sides[1]) >= 0.0 &&
            support(sides[2]) >= 0.0 && support(sides[3]) >= 0.0) {
            return true;
        }
        return splat.c.z > near && lowPassTouches(splat);
    }

    EyeFrame frame;

private:
    static constexpr double kSlackPx = 1e-6;

    [[nodiscard]] bool lowPassTouches(const CameraSplat& splat) const {
        const glm::dvec2 beyond = beyondPicture(splat);
        return kLowPassFactor * glm::dot(beyond, beyond) <=
               splat.cut * frame.own_pixel_px * frame.own_pixel_px;
    }

    [[nodiscard]] bool gaussianTouches(const CameraSplat& splat) const {
        const ScreenGaussian g = screenGaussian(splat, frame);
        const glm::dvec2 beyond = glm::abs(beyondPicture(splat)),
                         reach = glm::sqrt(splat.cut * glm::dvec2(g.xx, g.yy));
        return beyond.x <= reach.x && beyond.y <= reach.y;
    }

    // From the picture to the projected centre, if that is outside.
    [[nodiscard]] glm::dvec2 beyondPicture(const CameraSplat& splat) const {
        const Intrinsics& k = frame.intrinsics;
        const glm::dvec2 centre(k.fx * splat.c.x / splat.c.z + k.cx, k.fy * splat.c.y / splat.c.z + k.cy);
        return centre - glm::clamp(centre, first, last);
    }

    double near;
    glm::dvec2 first, last;
    std::array<glm::dvec3, 4> sides;
};

}  // namespace

std::vector<std::uint8_t> cull(const Scene& scene, std::span<const Eye> eyes, const Settings& settings) {
    std::vector<Frustum> frusta;
    for (const Eye& eye : eyes) {
        if (eye.size_px.x > 0 && eye.size_px.y > 0) { frusta.emplace_back(eye, settings.near); }
    }
    std::vector<std::uint8_t> visible(scene.size(), 0);
    forBlocks(scene.size(), 8192, settings.threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            for (const Frustum& frustum : frusta) {
                const std::optional<CameraSplat> splat = toCamera(scene, i, frustum.frame);
                if (splat && frustum.mayTouch(*splat, scene.isGaussian3d())) {
                    visible[i] = 1;
                    break;
                }
            }
        }
    });
    return visible;
}

}  // namespace binosplat::reference
