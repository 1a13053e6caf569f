// Saves recent scenes, settings, viewpoints and pictures as files.
#include "app/view/scenes/scene_notes.h"

#include "app/view/scenes/recent_scenes.h"
#include "app/view/scenes/seen_scenes.h"
#include "app/view/settings/view_files.h"
#include "engine/error.h"

#include <algorithm>

namespace binosplat {

void SceneNotes::remember(const std::string& scene, const std::string& complaint) {
    files_.write("remembering the scene", [this, scene, complaint]() -> FileWorker::Done {
        try {
            rememberScene(scene);
        } catch (const Error& error) {
            if (error.what() != complaint) {
                return [this, why = std::string(error.what())] { say_(why); };
            }
        }
        return {};
    });
}

void SceneNotes::save(const std::string& scene, const ViewSettings& settings) {
    files_.write("saving", [this, scene, settings]() -> FileWorker::Done {
        return [this, outcome = saveViewSettings(scene, settings)] { say_(outcome); };
    });
}

void SceneNotes::keepPreferences(const ViewSettings& now, double step_seconds, bool at_once) {
    preferences_.note(now, step_seconds);
    const PreferenceLines changes = preferences_.takeChanges(at_once);
    if (changes.empty()) { return; }
    files_.write("keeping preferences", [this, changes]() -> FileWorker::Done {
        try {
            binosplat::keepPreferences(changes);
        } catch (const Error& error) {
            return [this, why = std::string(error.what())] { say_(why); };
        }
        return {};
    });
}

void SceneNotes::toggleFavourite(const std::string& scene, std::function<void()> done) {
    files_.write("keeping a favourite", [this, scene, done = std::move(done)]() -> FileWorker::Done {
        std::string trouble;
        try {
            binosplat::toggleFavourite(scene);
        } catch (const Error& error) { trouble = error.what(); }
        return [this, trouble, done] {
            if (!trouble.empty()) { say_(trouble); }
            done();
        };
    });
}

void SceneNotes::keepPicture(const LoadedScene& scene, std::function<Image()> view) {
    files_.write("keeping a picture of the scene",
                 [name = scene.name, about = describeBriefly(scene.facts),
                  view = std::move(view)]() -> FileWorker::Done {
                     keepSeenScene(name, makeScenePicture(view()), about);
                     return {};
                 });
}

void SceneNotes::openLast(const LoadedScene& now, std::function<void(const std::string&)> open) {
    files_.read("the scene shown last",
                [this, place = now.place, open = std::move(open)]() -> FileWorker::Done {
                    const std::vector<std::string> recent = recentScenes();
                    const auto last = std::ranges::find_if(
                        recent, [&](const std::string& scene) { return placeOf(scene) != place; });
                    if (last == recent.end()) {
                        return [this] { say_("no other scene has been shown yet"); };
                    }
                    return [open, scene = *last] { open(scene); };
                });
}

}  // namespace binosplat
