// Saves notes about scenes while they are shown: they are written alongside the frames, and a line gives the
// outcome.
#pragma once

#include "app/view/files/file_worker.h"
#include "app/view/scenes/scene_loader.h"
#include "app/view/settings/preferences.h"
#include "engine/picture/image.h"

#include <functional>
#include <string>

namespace binosplat {

using Say = std::function<void(const std::string&)>;

class SceneNotes {
public:
    // Both must outlive this.
    SceneNotes(FileWorker& files, Say say) : files_(files), say_(std::move(say)) {}

    // Records that the scene was shown. `complaint` has already been reported.
    void remember(const std::string& scene, const std::string& complaint);
    void save(const std::string& scene, const ViewSettings& settings);
    // Call in each frame: a setting is saved once it has stayed the same for a second, or `at_once`.
    void keepPreferences(const ViewSettings& now, double step_seconds, bool at_once = false);
    // Marks a scene as a favourite, or unmarks it, and then calls `done`.
    void toggleFavourite(const std::string& scene, std::function<void()> done);
    // Saves a small picture of the scene for the list of scenes, made from what `view` returns on another
    // thread.
    void keepPicture(const LoadedScene& scene, std::function<Image()> view);
    // Finds the scene that was shown before this one, and opens it.
    void openLast(const LoadedScene& now, std::function<void(const std::string&)> open);

private:
    FileWorker& files_;
    Say say_;
    Preferences preferences_;
};

}  // namespace binosplat
