// Whole frames in which one eye is reprojected from the other, with everything that they leave.
#pragma once

#include "engine/frame/stereo_frame.h"
#include "tests/engine/frame/gpu_scenes.h"
#include "tests/engine/gpu/gpu_fixture.h"

namespace binosplat::test {

struct AffiliatedFrame {
    FrameResult result;
    std::array<Image, 2> pictures;
    std::vector<std::uint32_t> tile_kinds;
    std::vector<std::uint8_t> pixel_classes;
};

inline AffiliatedFrame makeAffiliated(StereoFrame& frame, const std::array<Eye, 2>& eyes,
                                      FrameSettings settings) {
    settings.keep_classes = true;
    FrameResult result = frame.render(eyes, settings);
    return {std::move(result),
            {frame.readPicture(kLeft), frame.readPicture(kRight)},
            frame.readTileKinds(),
            frame.readPixelClasses()};
}

// A headset's eyes: asymmetric angles, mirrored, with axes turned outwards by `canting_rad`.
inline std::array<Eye, 2> headsetEyes(const Eye& middle, double canting_rad, double eye_distance = 0.063) {
    std::array<Eye, 2> eyes = stereoPair(middle, eye_distance);
    const std::array<ViewAngles, 2> angles{ViewAngles{-0.7, 0.55, 0.6, -0.65},
                                           ViewAngles{-0.55, 0.7, 0.6, -0.65}};
    for (int e = 0; e < 2; ++e) {
        eyes[e] = turned(eyes[e], e == kLeft ? -canting_rad : canting_rad);
        eyes[e].intrinsics = intrinsicsFromAngles(angles[e], eyes[e].size_px);
    }
    return eyes;
}

// Makes splats invisible that either eye's near plane may cut: for these, the device's bounds, and so the
// tiles it counts, are coarser than the twin's.
inline void hideWhatMeetsTheNearPlane(Scene& scene, const std::array<Eye, 2>& eyes) {
    for (std::size_t i = 0; i < scene.size(); ++i) {
        for (const Eye& eye : eyes) {
            const double depth = transform(inverse(eye.world_from_camera), glm::dvec3(scene.positions[i])).z;
            if (depth - 3.4 * static_cast<double>(std::max(scene.scales[i].x, scene.scales[i].y)) < 0.2) {
                scene.opacities[i] = 0.0f;
            }
        }
    }
}

// Only the marked tiles; everything else is black.
inline Image keepTiles(Image image, const std::vector<std::uint32_t>& tile_kinds) {
    for (std::size_t i = 0; i < image.pixelCount(); ++i) {
        if (tile_kinds[tileOf(i, image.size_px)] == 0) {
            std::fill_n(image.values.begin() + static_cast<std::ptrdiff_t>(i) * image.channels,
                        image.channels, 0.0f);
        }
    }
    return image;
}

}  // namespace binosplat::test
