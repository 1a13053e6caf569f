// What a folder holds for somebody who looks for a scene: folders and scenes, in the order of people.
#pragma once

#include "app/view/scenes/seen_scenes.h"

#include <string>
#include <vector>

namespace binosplat {

struct SceneEntry {
    std::string name;        // as it is shown
    std::string place;       // folder to look into, or scene to load
    bool is_folder = false;  // of scenes; one that is a scene itself is none
    std::string trouble;     // why it cannot be opened, in a few words; empty: it can
    std::string about{};     // its size and, of one that was shown before, its kind
    bool is_favourite = false;
    ScenePicture picture{};  // of one that was shown before
};

struct SceneList {
    std::string title;    // the folder, or what else these are
    std::string above;    // the folder that holds it; empty: none does
    std::string trouble;  // why nothing of it can be seen; empty: all of it can
    std::vector<SceneEntry> entries;
};

// In place of a folder's path: the built-in scenes.
inline constexpr const char* kBuiltinFolder = "builtin:";

// The folder that a scene lies in, in full, or kBuiltinFolder.
std::string folderOf(const std::string& scene);

// Folders first, then scenes; hidden files and whatever looks like no scene are left out.
SceneList listFolder(const std::string& folder);

// Adds what is known of the scenes, and puts favourites first.
void describeScenes(SceneList& list);

// These scenes in this order, by their file names; what is not there any more can be seen to be so.
SceneList listScenes(const std::string& title, const std::vector<std::string>& scenes);

}  // namespace binosplat
