// Places in a scene to go to: the cameras that it was trained from, and those that people kept, with names
// and in an order of their own.
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
    bool is_own = false;  // somebody kept it
};

// Cameras of the scene's cameras.json or of `camera_file`, upright, and then kept viewpoints, all among the
// scene's positions. What cannot be read is left out. `source`: where `scene` is from.
std::vector<Viewpoint> findViewpoints(const Scene& scene, const std::string& source,
                                      const std::filesystem::path& camera_file);

// The own ones of a scene, in the coordinates of its file: kept beside its settings or, if there are none,
// shared beside the scene.
std::vector<Viewpoint> keptViewpoints(const std::string& source);
// Keeps these in their place. Throws Error if that fails.
void keepViewpoints(const std::string& source, const std::vector<Viewpoint>& own);

// A small JSON for others: NAME.viewpoints.json beside the scene or, for one that is not on the disk, among
// the user's pictures.
std::filesystem::path sharedViewpoints(const std::string& source);
void writeViewpoints(const std::filesystem::path& file, const std::vector<Viewpoint>& viewpoints);
// Throws Error with the place of what is wrong.
std::vector<Viewpoint> readViewpoints(const std::filesystem::path& file);

// Puts the eyes at the view's place, level and looking its way, at the same scale; the head's pose in the
// room stays as it is.
Similarity placedAt(const View& view, const Similarity& scene_from_room, const Pose& room_from_head);
// The view of the head as it is now.
View viewOf(const Similarity& scene_from_room, const Pose& room_from_head);

}  // namespace binosplat
