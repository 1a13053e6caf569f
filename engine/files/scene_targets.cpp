// A table of writers.
#include "engine/files/scene_targets.h"

#include "engine/error.h"
#include "engine/files/ply.h"
#include "engine/files/sog.h"
#include "engine/files/spz.h"

#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <vector>

namespace binosplat {

namespace {

void addAxis(const Scene& scene, std::vector<std::string>& losses) {
    if (scene.vertical_axis == 0 || scene.vertical_axis == 2) {
        losses.emplace_back(fmt::format("that {} is vertical", "xyz"[scene.vertical_axis]));
    }
}

// Properties that none of the formats can store.
void addUnsaid(const Scene& scene, std::vector<std::string>& losses) {
    if (scene.by_distance) {
        losses.emplace_back("that splats are blended by distance (render it with --order distance)");
    }
    if (scene.y_up) { losses.emplace_back("that y is up (render it with --up 0,1,0)"); }
}

// Notes about formats without float64.
void addOrigin(const Scene& scene, std::vector<std::string>& losses) {
    if (scene.origin != glm::dvec3(0.0)) {
        losses.push_back("that its positions count from " + describeOrigin(scene));
    }
}

std::string describePlyLoss(const Scene& scene) {
    std::vector<std::string> losses;
    addUnsaid(scene, losses);
    return losses.empty() ? "nothing" : fmt::format("{}", fmt::join(losses, "; "));
}

std::string describeSpzLoss(const Scene& scene) {
    std::vector<std::string> losses{fmt::format("positions in steps of {:.3g} units, scales of 6 %",
                                                std::ldexp(1.0, -spzFractionalBits(scene))),
                                    "colours and opacities of 8 bits", "rotations of 10 bits a component"};
    if (scene.sh_degree > 0) { losses.emplace_back("harmonics from -1 to 1 in steps of 1/128"); }
    if (!scene.isGaussian3d()) {
        losses.emplace_back("that its splats are discs (render it with --flatten)");
    }
    addAxis(scene, losses);
    addOrigin(scene, losses);
    addUnsaid(scene, losses);
    return fmt::format("{}", fmt::join(losses, "; "));
}

std::string describeSogLoss(const Scene& scene) {
    std::vector<std::string> losses{
        "the order of the splats", "positions of 16 bits over the logarithm of the scene's extent",
        "scales and colours of 256 values each", "rotations and opacities of 8 bits"};
    if (scene.sh_degree > 0) {
        losses.emplace_back(
            fmt::format("harmonics of {} rows at most for {} splats", sogPaletteSize(scene), scene.size()));
    }
    addAxis(scene, losses);
    addOrigin(scene, losses);
    addUnsaid(scene, losses);
    return fmt::format("{}", fmt::join(losses, "; "));
}

constexpr std::array<SceneTarget, 3> kTargets{{
    {".ply", writePly, describePlyLoss},
    {".spz", writeSpz, describeSpzLoss},
    {".sog", writeSog, describeSogLoss},
}};

}  // namespace

const SceneTarget& findSceneTarget(const std::filesystem::path& file) {
    for (const SceneTarget& target : kTargets) {
        if (file.extension() == target.extension) { return target; }
    }
    fail("{}: must be a file whose name ends in .ply, .spz or .sog", file.string());
}

}  // namespace binosplat
