// Pictures of all directions, or of those ahead, on a grid of equal angles (equirectangular), from flat
// pictures of the faces of a cube.
#pragma once

#include "engine/geometry.h"
#include "engine/picture/image.h"

#include <span>
#include <vector>

namespace binosplat {

// The first row is straight up, the last one straight down; the middle column is ahead, and columns further
// right lie further to the right.
struct Panorama {
    double width_rad;  // 2 pi: all around; pi: what lies ahead
    glm::uvec2 size_px;
};

// The eye of a panorama that a camera with this pose takes, with pixels per radian as intrinsics.
Eye panoramaEye(const Panorama& panorama, const Pose& world_from_camera);

// The flat pictures from which the panorama is made. Each extends a little beyond its edges.
std::vector<Eye> facesOf(const Panorama& panorama, const Pose& world_from_camera);

// From pictures of these faces, with four channels: each pixel is the mean of four samples, taken with a
// cubic kernel. Near an edge one face fades into the next, since splats that are wide for their distance look
// different along two cameras' axes.
Image panoramaOf(const Panorama& panorama, std::span<const Image> faces);

}  // namespace binosplat
