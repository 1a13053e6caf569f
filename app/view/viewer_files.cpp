// What the viewer does with files: scenes, settings, pictures, shaders.
#include "app/view/scenes/recent_scenes.h"
#include "app/view/settings/view_files.h"
#include "app/view/shader_reload.h"
#include "app/view/viewer.h"
#include "engine/error.h"

namespace binosplat {

void Viewer::takeScene() {
    const LoadedScene* before = scenes_.get();
    keepPictureOfScene();
    const std::string complaint = scenes_.take(settings_);
    if (!complaint.empty()) { say(complaint); }
    if (scenes_.get() == before) { return; }
    renderer_.forgetScene();
    viewpoint_.reset();
    frames_of_scene_ = 0;
    remember(complaint);
}

void Viewer::remember(const std::string& complaint) {
    files_.write("remembering the scene", [this, scene = scenes_.name(), complaint]() -> FileWorker::Done {
        try {
            rememberScene(scene);
        } catch (const Error& error) {
            if (error.what() != complaint) {
                return [this, why = std::string(error.what())] { log_.say(why); };
            }
        }
        return {};
    });
}

void Viewer::openAndSave(const PanelRequests& actions) {
    if (actions.save) { save(); }
    if (actions.load) { load(); }
    if (actions.scene_step != 0) { scenes_.beginBeside(actions.scene_step, files_); }
    if (!actions.chosen_scene.empty()) { scenes_.begin(actions.chosen_scene); }
    picture_asked_ = picture_asked_ || actions.take_picture;
    if (actions.last_scene) { goBackToLastScene(); }
    if (!actions.favourite.empty()) {
        files_.write("keeping a favourite", [this, scene = actions.favourite]() -> FileWorker::Done {
            std::string trouble;
            try {
                toggleFavourite(scene);
            } catch (const Error& error) { trouble = error.what(); }
            return [this, trouble] {
                if (!trouble.empty()) { say(trouble); }
                panel_.listAnew();
            };
        });
    }
}

void Viewer::save() {
    ViewSettings saved = settings_;
    saved.scene_from_room = scenes_.scene_from_room;
    files_.write("saving", [this, scene = scenes_.name(), saved]() -> FileWorker::Done {
        return [this, outcome = saveViewSettings(scene, saved)] { say(outcome); };
    });
}

void Viewer::load() {
    files_.read("loading what was saved", [this, scene = scenes_.name()]() -> FileWorker::Done {
        return [this, scene, saved = readSavedSettings(scene)] {
            if (scene != scenes_.name()) { return; }  // another one came meanwhile
            const ViewSettings before = settings_;
            say(takeSavedSettings(saved, settings_));
            scenes_.scene_from_room = settings_.scene_from_room.value_or(scenes_.scene_from_room);
            settings_.scene_from_room.reset();
            settings_.panel = before.panel;  // it was just pressed
            sayChange(before);
        };
    });
}

void Viewer::reloadShaders() {
    LoadedScene* scene = scenes_.get();
    if (scene == nullptr || !panel_.status().can_reload_shaders) { return; }
    // Its thread may be making kernels.
    if (scenes_.isLoading()) {
        say("shaders stay as they are until the next scene is there");
        return;
    }
    say(binosplat::reloadShaders(context_, shaderFolder(options_.shaders), [&] {
        scene->frame.rebuildKernels();
        renderer_.presenter().rebuildKernels();
    }));
}

void Viewer::takePicture() {
    if (scenes_.get() == nullptr || renderer_.lastFrame().counters.targets.empty()) { return; }
    try {
        std::error_code error;
        const std::filesystem::path folder = std::filesystem::current_path(error);
        check(!error, "the picture cannot be written: the working directory is gone");
        sayPicture(pictures_.finish());
        pictures_.begin(scenes_.get()->frame, drawn_.showsOneEye(), folder);
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError& error) {
        say(fmt::format("the picture cannot be read: {}", error.what()));
    } catch (const Error& error) { say(error.what()); }
}

void Viewer::sayPicture(const std::optional<std::string>& outcome) {
    if (outcome) { say(*outcome); }
}

}  // namespace binosplat
