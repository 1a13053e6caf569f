// Finds the scenes in a folder.
#include "app/view/scenes/view_scenes.h"

#include "app/view/scenes/natural_order.h"
#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/files/packed_scene.h"
#include "engine/files/scene_folder.h"
#include "engine/files/scene_series.h"

#include <algorithm>
#include <filesystem>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

// A folder with fewer numbered scenes is an ordinary folder, not a moving scene.
constexpr std::size_t kLeastFrames = 24;

bool looksMoving(const fs::path& folder) {
    return std::ranges::any_of(findNumberedFiles(folder), [](const std::vector<NumberedFile>& group) {
        return group.size() >= kLeastFrames && looksLikeScene(group.front().path);
    });
}

// A single scene, as findOnlyScene finds it, but by its name: nothing is opened. Scenes in nested folders
// could not be reached.
bool holdsOneScene(const fs::path& folder) {
    int files = 0, scenes = 0;
    std::error_code error, ignored;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (entry->path().filename().string().starts_with('.')) { continue; }
        if (entry->is_directory(ignored)) { return false; }
        if (!entry->is_regular_file(ignored)) { continue; }
        scenes += hasSceneName(entry->path());
        if (++files > kMostFilesOpened || scenes > 1) { return false; }
    }
    return scenes == 1;
}

// Hidden ones are left out. The paths begin with `as`.
std::vector<std::string> scenesIn(const fs::path& folder, const fs::path& as) {
    std::vector<std::string> scenes;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
        const fs::path name = entry.path().filename();
        if (!name.string().starts_with('.') && looksLikeScene(entry.path())) {
            scenes.push_back((as / name).string());
        }
    }
    return scenes;
}

}  // namespace

bool looksLikeScene(const fs::path& path) {
    std::error_code ignored;
    if (fs::is_directory(path, ignored)) {
        return fs::exists(path / "meta.json", ignored) || fs::exists(path / "lod-meta.json", ignored) ||
               findTrainingOutput(path) || looksMoving(path) || holdsOneScene(path);
    }
    return hasSceneName(path);
}

std::vector<std::string> scenesBeside(const std::string& scene) {
    std::vector<std::string> scenes;
    if (isBuiltin(scene)) {
        for (const BuiltinInfo& info : listBuiltins()) {
            scenes.push_back("builtin:" + std::string(info.name));
        }
    } else if (isAddress(scene)) {
        scenes.push_back(scene);  // servers do not list what lies beside it
    } else {
        fs::path place = scene;
        if (!place.has_filename()) { place = place.parent_path(); }
        const fs::path folder = place.has_parent_path() ? place.parent_path() : ".";
        scenes = scenesIn(folder, place.parent_path());
        if (std::ranges::find(scenes, place.string()) == scenes.end()) { scenes.push_back(place.string()); }
    }
    std::ranges::sort(scenes, comesBefore);
    return scenes;
}

std::string firstSceneIn(const std::string& scene) {
    std::error_code ignored;
    if (isBuiltin(scene) || isAddress(scene) || !fs::is_directory(scene, ignored)) { return {}; }
    if (looksLikeScene(scene) || isMovingScene(scene) || findOnlyScene(scene)) { return {}; }
    const std::vector<std::string> scenes = scenesIn(scene, scene);
    return scenes.empty() ? "" : *std::ranges::min_element(scenes, comesBefore);
}

std::string sceneBeside(const std::string& scene, int step) {
    const std::vector<std::string> scenes = scenesBeside(scene);
    std::filesystem::path place = scene;
    if (!isBuiltin(scene) && !isAddress(scene) && !place.has_filename()) { place = place.parent_path(); }
    const auto found = std::ranges::find(scenes, place.string());
    const auto count = static_cast<std::ptrdiff_t>(scenes.size());
    if (count == 0) { return scene; }
    const std::ptrdiff_t at = found == scenes.end() ? 0 : found - scenes.begin();
    return scenes[static_cast<std::size_t>(((at + step) % count + count) % count)];
}

}  // namespace binosplat
