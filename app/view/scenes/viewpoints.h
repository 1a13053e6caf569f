// Places in a scene to go to: the cameras that it was trained from, and those that the wearer kept.
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"
#include "engine/similarity.h"

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace binosplat {

struct Viewpoint {
    std::string name;
    View view;  // of the eyes; its angle means nothing
};

// Cameras of the scene's cameras.json or of `camera_file`, upright, and then kept viewpoints, all among the scene's positions. What cannot
// be read is left out. `source`: where `scene` is from.
std::vector<Viewpoint> findViewpoints(const Scene& scene, const std::string& source, const std::filesystem::path& camera_file);

// Saves it, in the file's coordinates, beside the scene's settings. Throws Error if that fails.
void keepViewpoint(const std::string& source, const View& view);
Viewpoint ownViewpoint(std::size_t number, const View& view);
std::vector<View> keptViews(const std::string& source);

// Puts the eyes at the view's place, level and looking its way, at the same scale; the head's pose in the room stays as it is.
Similarity placedAt(const View& view, const Similarity& scene_from_room, const Pose& room_from_head);
// The view of the head as it is now.
View viewOf(const Similarity& scene_from_room, const Pose& room_from_head);

}  // namespace binosplat
