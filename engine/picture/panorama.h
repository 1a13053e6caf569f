// Pictures of all directions, or of those ahead, on a grid of equal angles (equirectangular), from flat pictures of the faces of a cube.
#pragma once

#include "engine/geometry.h"
#include "engine/picture/image.h"

#include <span>
#include <vector>

namespace binosplat {

// From straight up in the first row to straight down in the last one; the middle column is ahead, and a column further right lies further
// to the right.
struct Panorama {
    double width_rad;  // 2 pi: all around; pi: what lies ahead
    glm::uvec2 size_px;
};

// What a camera at this place with these axes has to see for it: as an eye of the panorama's own, with pixels per radian for intrinsics.
Eye panoramaEye(const Panorama& panorama, const Pose& world_from_camera);

// The flat pictures that the panorama is made of. Each reaches a little over its edges.
std::vector<Eye> facesOf(const Panorama& panorama, const Pose& world_from_camera);

// From pictures of these faces, with four channels: the mean of four places in each pixel, by a cubic kernel. Near an edge faces change
// over into one another, since splats that are wide for their distance do not look alike from two cameras' axes.
Image panoramaOf(const Panorama& panorama, std::span<const Image> faces);

}  // namespace binosplat
