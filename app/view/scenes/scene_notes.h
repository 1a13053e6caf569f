// What is kept about scenes while they are shown: written beside the frames, with the outcome in a line.
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
    // Both outlive this.
    SceneNotes(FileWorker& files, Say say) : files_(files), say_(std::move(say)) {}

    // Records that it was shown. `complaint` has been reported already.
    void remember(const std::string& scene, const std::string& complaint);
    void save(const std::string& scene, const ViewSettings& settings);
    // In each frame: what somebody sets is kept once it stays so for a second, or `at_once`.
    void keepPreferences(const ViewSettings& now, double step_seconds, bool at_once = false);
    // Marks a favourite, or unmarks it, and then calls `done`.
    void toggleFavourite(const std::string& scene, std::function<void()> done);
    // A small picture of the scene, for the list of scenes, of what `view` returns on another thread.
    void keepPicture(const LoadedScene& scene, std::function<Image()> view);
    // Finds the scene that was shown before this one, and opens it.
    void openLast(const LoadedScene& now, std::function<void(const std::string&)> open);

private:
    FileWorker& files_;
    Say say_;
    Preferences preferences_;
};

}  // namespace binosplat
