// The window's panel, and the requests made there.
#include "app/desktop/desktop_shell.h"
#include "app/desktop/open_dialog.h"
#include "app/view/panel/measure.h"
#include "app/view/placement/placement.h"
#include "engine/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace binosplat {

void DesktopShell::layOutPanel(const PanelPointer& pointer, double seconds) {
    layouts_due_ = std::max(layouts_due_ - 1, 0);
    requests_.fillStatus(comparison_ && comparison_->is_whole_asked, viewpoints_);
    if (const LoadedScene* const scene = scenes_.get(); scene != nullptr) {
        panel_.status().facts =
            describeFacts(scene->facts, scene->measured.value_or(options_.run.metres_per_unit));
    }
    panel_.showTimes(pictures_.lastFrame(), "", seconds);
    panel_.askFor(files_, state_.settings());
    follow(panel_.layOut(pointer, state_.settings(), seconds));
}

void DesktopShell::follow(const PanelRequests& requests) {
    state_.set(requests.settings);
    ShownWindow& window = *panel_.status().window;
    if (requests.help) {
        window.helps = !window.helps || !state_.settings().panel;
        showPanel();
        ViewSettings settings = state_.settings();
        settings.page = PanelPage::kView;
        state_.set(settings);
        log_.say(window.helps ? "help" : "no help");
    }
    if (requests.fill_screen) {
        window_.toggleFullScreen();
        window.fills_screen = !window.fills_screen;
    }
    if (LoadedScene* const scene = scenes_.get(); scene != nullptr) {
        if (requests.show_whole) { showWhole(); }
        if (requests.reset_scene) { showStart(); }
        changeViewpoints(requests);
        measure(requests);
        if (const std::string said = scene->moveTime(requests.play, requests.frame_step, requests.frame);
            !said.empty()) {
            log_.say(said);
        }
    }
    openAndSave(requests);
    if (requests.quit) { leaving_ = true; }
}

void DesktopShell::changeViewpoints(const PanelRequests& requests) {
    if (requests.viewpoint_step != 0) { goTo(viewpoints_.goBy(requests.viewpoint_step)); }
    if (requests.keep_viewpoint) {
        const OrbitCamera& camera = mover_.camera();
        viewpoints_.keep({camera.position(), camera.centre(), camera.up(), 0.0});
    }
    followViewpoints(requests, panel_.entry(), viewpoints_);
}

void DesktopShell::measure(const PanelRequests& requests) {
    LoadedScene& scene = *scenes_.get();
    if (requests.measure) { say(openRuler(ruler_)); }
    const std::optional<double> measured = takeMeasure(requests, ruler_, scene);
    if (!measured) { return; }
    Similarity placement = state_.sceneFromRoom();
    placement.scale = 1.0 / *measured;
    state_.place(placement);
    notes_.save(scene.name, savedPlace(state_, scene));
}

void DesktopShell::openAndSave(const PanelRequests& requests) {
    if (requests.save && scenes_.get() != nullptr) {
        // Level, for a wearer who stands there later.
        const OrbitCamera& camera = mover_.camera();
        Similarity level = startPlacement({camera.position(), camera.centre(), camera.up(), 0.0},
                                          options_.run.metres_per_unit);
        level.scale = state_.sceneFromRoom().scale;
        state_.place(level);
        notes_.save(scenes_.name(), savedPlace(state_, *scenes_.get()));
    }
    requests_.follow(requests);
    // On the page with the list of scenes, the scene to compare with is chosen from that list.
    const bool chooses = requests.compare && scenes_.comparesNext();
    if (chooses && state_.settings().page != PanelPage::kScenes) { openFile(); }
    if (requests.show_other && comparison_) { comparison_->is_whole_asked = !comparison_->is_whole_asked; }
    if (requests.open_file) { openFile(); }
    if (requests.take_picture && scenes_.get() != nullptr) { writes_picture_ = true, is_refined_ = false; }
}

void DesktopShell::showPanel() {
    ViewSettings settings = state_.settings();
    settings.panel = true;
    state_.set(settings);
}

void DesktopShell::openFile() {
    if (!dialogs_.now().empty()) { return; }  // it is already open
    dialogs_.read("choosing a file", [this]() -> FileWorker::Done {
        return [this, chosen = askForFile([this] { return leaving_.load(); })] {
            if (!chosen.trouble.empty()) { return say(chosen.trouble); }
            if (!chosen.file.empty()) { scenes_.begin(chosen.file); }
        };
    });
}

void DesktopShell::openDropped(const DesktopEvent& event) {
    event.path.ends_with(".viewpoints.json") ? viewpoints_.read(event.path)
                                             : scenes_.begin(event.path, event.second);
}

void DesktopShell::takePicture() {
    const bool both = state_.settings().picture_both_eyes;
    WindowSight sight = windowSight();
    sight.stereo = both ? WindowStereo::kSideBySide : WindowStereo::kMono;
    FrameSettings settings = frameSettingsNow(true);
    settings.mode = both ? Mode::kShared : Mode::kMono;
    settings.keep_classes = false;
    // Of the other one, if it fills the window.
    scenes_.draw(comparison_ && comparison_->is_whole);
    writer_.begin(scenes_.shotOf(scenes_.seenFromDrawn(eyesOf(mover_.camera(), sight, areaPx())), settings),
                  scenes_.drawn()->name);
    scenes_.draw(false);
}

}  // namespace binosplat
