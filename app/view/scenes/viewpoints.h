// Places in a scene to go to: the cameras that it was trained from, and those that the wearer kept.
#pragma once

#include "engine/scene/procedural.h"
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

// Those of the scene's cameras.json or of `camera_file`, upright, and then those that were kept. Whatever cannot be read is left out.
std::vector<Viewpoint> findViewpoints(const std::string& source, const std::filesystem::path& camera_file);

// Beside the scene's settings. Throws Error where it cannot be kept.
void keepViewpoint(const std::string& source, const View& view);
Viewpoint ownViewpoint(std::size_t number, const View& view);
std::vector<View> keptViews(const std::string& source);

// The eyes are there and look that way, level in the room, a metre as long as before; the head stays as it is in the room.
Similarity placedAt(const View& view, const Similarity& scene_from_room, const Pose& room_from_head);
// What the eyes see as they stand now.
View viewOf(const Similarity& scene_from_room, const Pose& room_from_head);

}  // namespace binosplat
