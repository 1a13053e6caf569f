// Extreme 3D Gaussians, in front of a wall and among ordinary ones.
#include "app/stability_cases/extreme_scenes.h"
#include "app/stability_cases/stage_builder.h"

#include <algorithm>
#include <cmath>

namespace binosplat::stability {
namespace {

Stage makeGaussians(int count, unsigned seed, const std::function<void(Disc&, Random&, int)>& shape) {
    StageBuilder stage = makeDiscRoom();
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        Disc splat = placeDisc(random);
        turnAnyhow(splat, random);
        shape(splat, random, i);
        stage.add(splat);
    }
    return stage.finishGaussians();
}

// Needles, each along a given direction.
Stage makeNeedlesAlong(double aspect, const std::function<glm::dvec3(const Disc&, int)>& direction) {
    return makeGaussians(40, 41, [&](Disc& splat, Random&, int i) {
        splat.t_u = direction(splat, i);
        splat.scale = 0.03 * glm::dvec2(std::sqrt(aspect), 1.0 / std::sqrt(aspect));
        splat.thickness = splat.scale.y;
    });
}

}  // namespace

Stage makeNeedlesAlongSight(double aspect) {
    return makeNeedlesAlong(aspect, [](const Disc& splat, int) { return glm::normalize(splat.centre); });
}

Stage makeNeedlesAcross(double aspect) {
    return makeNeedlesAlong(
        aspect, [](const Disc&, int i) { return i % 2 == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0); });
}

Stage makeNeedlesDiagonal(double aspect) {
    return makeNeedlesAlong(
        aspect, [](const Disc&, int i) { return glm::normalize(glm::dvec3(1, i % 2 == 0 ? 1 : -1, 0)); });
}

Stage makeSheetsEdgeOn(double angle_rad) {
    return makeGaussians(40, 42, [&](Disc& splat, Random& random, int) {
        splat.scale = {random.between(0.1, 2.0), random.between(0.1, 0.5)};
        layAlongSight(splat, angle_rad);
    });
}

Stage makeLongSheets(double length) {
    return makeGaussians(40, 48, [&](Disc& splat, Random& random, int) {
        splat.scale = length * glm::dvec2(random.between(0.1, 1.0), random.between(0.1, 1.0));
        layAlongSight(splat, 1e-7);
    });
}

Stage makeBeyondNear(double share) {
    const double near = StageBuilder().near;
    return makeGaussians(20, 43, [&](Disc& splat, Random& random, int i) {
        // Each is deeper than the previous one by more than single precision loses, since their order is not
        // what is tested.
        splat.centre *= near * (1.0 + share * (1.0 + 0.2 * i)) / splat.centre.z;
        splat.scale = {random.between(0.5, 5.0), random.between(0.5, 5.0)};
        splat.thickness = random.between(0.0, 0.5);
        splat.opacity = random.between(0.05, 0.3);
    });
}

Stage makeBesideEye(double slope) {
    return makeGaussians(40, 44, [&](Disc& splat, Random& random, int i) {
        splat.centre.z = random.between(0.25, 0.6);
        const double side = i % 2 == 0 ? slope : -slope;
        splat.centre.x = splat.centre.z * (i % 4 < 2 ? side : random.between(-0.3, 0.3));
        splat.centre.y = splat.centre.z * (i % 4 < 2 ? random.between(-0.3, 0.3) : side);
        splat.scale = slope * splat.centre.z * glm::dvec2(random.between(0.2, 0.6), random.between(0.2, 0.6));
        splat.thickness = random.between(0.0, 0.2);
        splat.opacity = random.between(0.1, 0.4);
    });
}

Stage makeGaussianScales(double scale) {
    return makeGaussians(60, 45, [&](Disc& splat, Random& random, int) {
        splat.scale = scale * glm::dvec2(1.0, random.between(0.5, 1.0));
        splat.thickness = scale * random.between(0.1, 0.5);
        splat.opacity = random.between(0.1, 0.5);
    });
}

Stage makeFlatAxes(double count) {
    return makeGaussians(60, 46, [&](Disc& splat, Random& random, int) {
        splat.scale = {count < 3.0 ? 0.2 : 0.0, count < 2.0 ? random.between(0.05, 0.2) : 0.0};
        splat.thickness = 0.0;
    });
}

Stage makeGaussianOpacity(double opacity) { return asGaussians(makeOpacity(opacity)); }

Stage makeBrokenGaussians(double value) {
    Stage stage = asGaussians(makeBrokenAttributes(value));
    Scene& scene = stage.scene;
    scene.positions.push_back(scene.positions[0]);
    scene.rotations.push_back(scene.rotations[0]);
    scene.scales.push_back(scene.scales[0]);
    scene.thicknesses.push_back(static_cast<float>(value));
    scene.opacities.push_back(scene.opacities[0]);
    for (std::size_t channel = 0; channel < 3; ++channel) { scene.sh.push_back(scene.sh[channel]); }
    return stage;
}

Stage asGaussians(Stage stage) {
    Random random(47);
    for (const glm::vec2& scale : stage.scene.scales) {
        // A third of them are sheets.
        const double share = std::max(random.between(-0.5, 1.0), 0.0);
        stage.scene.thicknesses.push_back(
            static_cast<float>(share * static_cast<double>(std::min(scale.x, scale.y))));
    }
    return stage;
}

Stage asDimmed(Stage stage) {
    if (!stage.scene.isGaussian3d()) { stage = asGaussians(std::move(stage)); }
    stage.scene.antialiased = true;
    return stage;
}

}  // namespace binosplat::stability
