// A frame for each face.
#include "app/panorama.h"

#include "app/load.h"
#include "app/terminal/interrupt.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

namespace binosplat {

namespace {

// The head's pose with its y axis straight down.
Pose upright(const Pose& world_from_head, const glm::dvec3& up) {
    const glm::dvec3 down = -glm::normalize(up);
    const glm::dvec3 right = glm::cross(down, world_from_head.orientation * glm::dvec3(0.0, 0.0, 1.0));
    if (glm::length(right) < 1e-6) { return world_from_head; }  // straight up or down: no heading
    return lookAt(world_from_head.position, world_from_head.position + glm::cross(right, down), up);
}

// Adds the counts of several frames that make one picture.
void add(FrameResult& sum, FrameResult face) {
    if (sum.counters.targets.empty()) {
        sum = std::move(face);
        return;
    }
    sum.gpu_ms.insert(sum.gpu_ms.end(), face.gpu_ms.begin(), face.gpu_ms.end());
    sum.gpu_total_ms += face.gpu_total_ms;
    sum.sees_nothing = sum.sees_nothing && face.sees_nothing;
    sum.counters.commands += face.counters.commands;
    for (std::size_t eye = 0; eye < sum.counters.targets.size(); ++eye) {
        TargetCounters& all = sum.counters.targets[eye];
        const TargetCounters& one = face.counters.targets[eye];
        all.splats_visible += one.splats_visible;
        all.tile_pairs += one.tile_pairs;
        all.tiles += one.tiles;
        all.pixels += one.pixels;
    }
    sum.peak_gpu_bytes = std::max(sum.peak_gpu_bytes, face.peak_gpu_bytes);
}

}  // namespace

std::optional<Panorama> askedPanorama(const RenderOptions& options) {
    if (options.projection == Projection::kFlat) { return std::nullopt; }
    return Panorama{options.projection == Projection::k360 ? 2.0 * std::numbers::pi : std::numbers::pi,
                    *options.run.camera.size_px};
}

Cameras panoramaCameras(const Cameras& cameras, const Panorama& panorama) {
    Cameras made = cameras;
    const Pose& head = cameras.middle.world_from_camera;
    made.middle = panoramaEye(panorama, cameras.view ? upright(head, cameras.view->up) : head);
    made.eyes = stereoPair(made.middle, cameras.eye_distance);
    return made;
}

EyePictures renderPanorama(StereoFrame& frame, LiveScene* live, const FrameSettings& settings,
                           const Cameras& cameras, const Panorama& panorama) {
    const bool mono = settings.mode == Mode::kMono;
    const std::size_t count = mono ? 1 : 2;
    std::array<std::vector<Eye>, 2> faces;
    std::vector<Eye> all;
    for (std::size_t eye = 0; eye < count; ++eye) {
        faces[eye] = facesOf(panorama, (mono ? cameras.middle : cameras.eyes[eye]).world_from_camera);
        all.insert(all.end(), faces[eye].begin(), faces[eye].end());
    }
    if (live != nullptr) { settle(*live, all); }
    std::array<std::vector<Image>, 2> seen;
    EyePictures made;
    for (std::size_t face = 0; face < faces[0].size(); ++face) {
        stopIfInterrupted();
        std::vector<Eye> eyes{faces[0][face]};
        if (!mono) { eyes.push_back(faces[1][face]); }
        add(made.result, frame.render(eyes, settings));
        for (std::size_t eye = 0; eye < count; ++eye) {
            seen[eye].push_back(frame.readPicture(static_cast<int>(eye)));
        }
    }
    for (std::size_t eye = 0; eye < count; ++eye) {
        made.pictures.push_back(panoramaOf(panorama, seen[eye]));
    }
    return made;
}

}  // namespace binosplat
