// A folder's contents, for finding a scene: folders and scenes, in natural order.
#pragma once

#include "app/view/scenes/seen_scenes.h"
#include "engine/platform.h"

#include <filesystem>
#include <string>
#include <vector>

namespace binosplat {

struct SceneEntry {
    std::string name;        // as it is shown
    std::string place;       // the folder to open, or the scene to load
    bool is_folder = false;  // of scenes; false for a folder that is itself a scene
    std::string trouble;     // why it cannot be opened, in a few words; empty: it can
    std::string about{};     // its size and, if it was shown before, its kind
    bool is_favourite = false;
    ScenePicture picture{};  // if it was shown before
};

struct SceneList {
    std::string title;    // the folder, or another title of the list
    std::string above;    // the parent folder; empty: none
    std::string trouble;  // why the folder cannot be read; empty: it can
    std::vector<SceneEntry> entries;
};

// Stands for the built-in scenes, in place of a folder's path.
inline constexpr const char* kBuiltinFolder = "builtin:";

// The full path of the folder that a scene is in, or kBuiltinFolder.
std::string folderOf(const std::string& scene);

// Stands for the drives, if paths begin in several places, in place of a folder's path.
inline constexpr const char* kDrives = "drives:";

// Folders first, then scenes, without hidden files and files that do not look like scenes.
SceneList listFolder(const std::string& folder,
                     const std::vector<std::filesystem::path>& roots = fileSystemRoots());

// Adds what is known about the scenes, and puts favourites first.
void describeScenes(SceneList& list);

// These scenes in this order, by their file names; missing ones are marked as such.
SceneList listScenes(const std::string& title, const std::vector<std::string>& scenes);

}  // namespace binosplat
