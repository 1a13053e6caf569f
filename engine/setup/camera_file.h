// cameras.json from 3DGS or 2DGS training.
#pragma once

#include "engine/geometry.h"

#include <filesystem>
#include <string>
#include <vector>

namespace binosplat {

struct FileCamera {
    std::string name;  // img_name, or the index
    Eye eye;
};

// An array of objects: position (camera centre), rotation (3x3, rows, world-from-camera, OpenCV axes), width,
// height, fx, fy in pixels; optional cx, cy (otherwise the middle) and img_name. Throws Error naming file,
// camera and key. Positions become relative to `origin`, the scene's (Scene::origin).
std::vector<FileCamera> readCameraFile(const std::filesystem::path& path, const glm::dvec3& origin);

// The same view with another number of pixels; fx, fy, cx, cy are scaled accordingly.
Eye resize(const Eye& eye, glm::uvec2 size_px);

}  // namespace binosplat
