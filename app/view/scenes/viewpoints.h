// Places in a scene to go to: the cameras that it was trained from, and those that users have kept, with
// names and in an order of their choice.
#pragma once

#include "engine/geometry.h"
#include "engine/scene/scene.h"
#include "engine/similarity.h"

#include <filesystem>
#include <string>
#include <vector>

namespace binosplat {

struct Viewpoint {
    std::string name;
    View view;            // of the eyes; its angle means nothing
    bool is_own = false;  // the user has kept it
};

// Cameras from the scene's cameras.json or from `camera_file`, upright, and then kept viewpoints, all in the
// coordinates of the scene's positions. What cannot be read is skipped. `source`: where `scene` is from.
std::vector<Viewpoint> findViewpoints(const Scene& scene, const std::string& source,
                                      const std::filesystem::path& camera_file);

// The user's own viewpoints in a scene, in the coordinates of its file: those kept with its settings or, if
// there are none, those shared next to the scene.
std::vector<Viewpoint> keptViewpoints(const std::string& source);
// Saves these in their place. Throws Error if that fails.
void keepViewpoints(const std::string& source, const std::vector<Viewpoint>& own);

// A small JSON file for others: NAME.viewpoints.json next to the scene or, for a scene that is not on the
// disk, in the user's pictures folder.
std::filesystem::path sharedViewpoints(const std::string& source);
void writeViewpoints(const std::filesystem::path& file, const std::vector<Viewpoint>& viewpoints);
// Throws Error that says where the fault is.
std::vector<Viewpoint> readViewpoints(const std::filesystem::path& file);

// Puts the eyes at the view's place, level and looking in its direction, at the same scale; the head's pose
// in the room stays as it is.
Similarity placedAt(const View& view, const Similarity& scene_from_room, const Pose& room_from_head);
// The view of the head as it is now.
View viewOf(const Similarity& scene_from_room, const Pose& room_from_head);

}  // namespace binosplat
