// Stiff discs, in front of a wall and among ordinary ones.
#include "app/stability_cases/extreme_scenes.h"
#include "app/stability_cases/stage_builder.h"

#include <cmath>

namespace binosplat::stability {
namespace {

Stage makeDiscs(int count, unsigned seed, const std::function<void(Disc&, Random&)>& shape) {
    StageBuilder stage = makeDiscRoom();
    Random random(seed);
    for (int i = 0; i < count; ++i) {
        Disc disc = placeDisc(random);
        turnAnyhow(disc, random);
        shape(disc, random);
        stage.add(disc);
    }
    return stage.finish();
}

// Discs that face the eye and hide each other, each deeper than the one before by this share.
void addHidingDiscs(StageBuilder& stage, double separation) {
    Random random(10);
    for (int i = 0; i < 60; ++i) {
        const double depth = 2.0 * (1.0 + separation * i);
        stage.add({.centre = depth * glm::dvec3(random.between(-0.4, 0.4), random.between(-0.3, 0.3), 1.0),
                   .scale = glm::dvec2(0.3),
                   .opacity = 0.9,
                   .colour = random.colour()});
    }
}

}  // namespace

Stage makeEdgeOn(double angle_rad) {
    return makeDiscs(40, 2, [&](Disc& disc, Random& random) {
        disc.scale = {random.between(0.1, 0.5), random.between(0.1, 0.5)};
        layAlongSight(disc, angle_rad);
    });
}

Stage makeHorizon(double angle_rad) {
    // An odd height: the optical axis meets the middle of the middle row.
    StageBuilder stage({kSizePx.x, kSizePx.y + 1});
    stage.addWall();
    Random random(3);
    for (int i = 0; i < 12; ++i) {
        Disc disc{.centre = {random.between(-0.8, 0.8), 0.0, random.between(1.0, 3.0)},
                  .scale = glm::dvec2(0.4),
                  .colour = random.colour()};
        layAlongSight(disc, angle_rad);
        stage.add(disc);
    }
    return stage.finish();
}

Stage makeNeedles(double aspect) {
    return makeDiscs(60, 4, [&](Disc& disc, Random&) {
        disc.scale = 0.03 * glm::dvec2(std::sqrt(aspect), 1.0 / std::sqrt(aspect));
    });
}

Stage makeScales(double scale) {
    return makeDiscs(60, 5, [&](Disc& disc, Random& random) {
        disc.scale = glm::dvec2(scale);
        disc.opacity = random.between(0.1, 0.5);
    });
}

Stage makeThroughEye(double distance) {
    StageBuilder stage = makeDiscRoom();
    Random random(6);
    for (int i = 0; i < 12; ++i) {
        Disc disc;
        turnAnyhow(disc, random);
        const glm::dvec3 normal = glm::normalize(glm::cross(disc.t_u, disc.t_v));
        // The foot of the perpendicular from the eye, and a centre up to 0.7 beside it within the plane.
        const glm::dvec3 in_plane = random.between(-0.5, 0.5) * glm::normalize(disc.t_u) +
                                    random.between(-0.5, 0.5) * glm::normalize(glm::cross(normal, disc.t_u));
        disc.centre = distance * normal + in_plane;
        disc.scale = glm::dvec2(random.between(0.3, 2.0));
        disc.opacity = random.between(0.2, 0.6);
        disc.colour = random.colour();
        stage.add(disc);
    }
    return stage.finish();
}

Stage makeDepthRatio(double ratio) {
    StageBuilder stage;
    stage.near = 5e-4;
    stage.setEyeDistance(2e-5);
    Random random(7);
    for (int i = 0; i < 90; ++i) {
        const double depth = 1e-3 * std::pow(ratio, i / 89.0);
        Disc disc;
        turnAnyhow(disc, random);
        disc.centre = depth * glm::dvec3(random.between(-0.6, 0.6), random.between(-0.4, 0.4), 1.0);
        disc.scale = depth * glm::dvec2(random.between(0.03, 0.3), random.between(0.03, 0.3));
        disc.colour = random.colour();
        stage.add(disc);
    }
    return stage.finish();
}

Stage makeOpacity(double opacity) {
    return makeDiscs(60, 8, [&](Disc& disc, Random& random) {
        disc.scale = {random.between(0.05, 0.4), random.between(0.05, 0.4)};
        disc.opacity = opacity;
    });
}

Stage makeLayers(double count) {
    StageBuilder stage;
    Random random(9);
    const int layers = static_cast<int>(count);
    for (int i = 0; i < layers; ++i) {
        const double depth = 1.0 + 2.0 * i / layers;
        stage.add({.centre = {0.0, 0.0, depth},
                   .scale = glm::dvec2(50.0 * depth),
                   .opacity = 0.01,
                   .colour = random.colour()});
    }
    return stage.finish();
}

Stage makeSeparation(double separation) {
    StageBuilder stage;
    addHidingDiscs(stage, separation);
    return stage.finish();
}

Stage makeEqualDepths() {
    StageBuilder stage;
    stage.middle.world_from_camera = {};
    stage.setEyeDistance(0.063);
    addHidingDiscs(stage, 0.0);
    return stage.finish();
}

Stage makeBrokenAttributes(double value) {
    Stage stage = makeDiscs(20, 11, [](Disc& disc, Random&) { disc.scale = glm::dvec2(0.2); });
    Scene& scene = stage.scene;
    const auto bad = static_cast<float>(value);
    // Copies of a splat in view, each with another attribute broken.
    const auto copy = [&] {
        const std::size_t i = scene.size() % 20;
        scene.positions.push_back(scene.positions[i]);
        scene.rotations.push_back(scene.rotations[i]);
        scene.scales.push_back(scene.scales[i]);
        scene.opacities.push_back(scene.opacities[i]);
        for (std::size_t channel = 0; channel < 3; ++channel) {
            scene.sh.push_back(scene.sh[3 * i + channel]);
        }
    };
    for (int axis = 0; axis < 3; ++axis) {
        copy();
        scene.positions.back()[axis] = bad;
        copy();
        scene.sh[scene.sh.size() - 3 + static_cast<std::size_t>(axis)] = bad;
    }
    for (int part = 0; part < 4; ++part) {
        copy();
        scene.rotations.back()[part] = bad;
    }
    for (int axis = 0; axis < 2; ++axis) {
        copy();
        scene.scales.back()[axis] = bad;
    }
    copy();
    scene.opacities.back() = bad;
    return stage;
}

Stage makeQuaternions(double length) {
    Stage stage = makeDiscs(40, 12, [](Disc& disc, Random&) { disc.scale = {0.3, 0.1}; });
    for (std::size_t i = 0; i < stage.scene.size(); i += 2) {
        glm::quat& q = stage.scene.rotations[i];
        const glm::dquat scaled = glm::dquat(q) * length;
        q = glm::quat(scaled);
    }
    return stage;
}

Stage makeHarmonics(double amplitude) {
    Stage stage = makeDiscs(40, 13, [](Disc& disc, Random&) { disc.scale = glm::dvec2(0.2); });
    Random random(14);
    Scene& scene = stage.scene;
    scene.sh_degree = kMaxShDegree;
    scene.sh.clear();
    for (std::size_t i = 0; i < scene.size() * 3 * static_cast<std::size_t>(shCoefficientCount(kMaxShDegree));
         ++i) {
        scene.sh.push_back(static_cast<float>(amplitude * random.between(-1.0, 1.0)));
    }
    return stage;
}

}  // namespace binosplat::stability
