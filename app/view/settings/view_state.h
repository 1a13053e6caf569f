// The wearer's settings and place: hands, the window, the panel and files change them here.
#pragma once

#include "app/view/settings/view_settings.h"

#include <utility>

namespace binosplat {

class ViewState {
public:
    // A placement among the settings is that of the first scene.
    explicit ViewState(ViewSettings settings = {})
        : asked_(std::exchange(settings.scene_from_room, {})),
          settings_(std::move(settings)),
          said_(settings_) {
        settings_.metres_per_unit = said_.metres_per_unit = {};
    }

    // Without a placement.
    [[nodiscard]] const ViewSettings& settings() const { return settings_; }
    [[nodiscard]] const Similarity& sceneFromRoom() const { return scene_from_room_; }
    // Both, in the form in which they are saved.
    [[nodiscard]] ViewSettings withPlacement() const {
        ViewSettings saved = settings_;
        saved.scene_from_room = scene_from_room_;
        saved.scene_from_room->position += origin_;
        return saved;
    }

    // Of the scene that is shown, see Scene: placements among settings are in its file's coordinates.
    void countFrom(const glm::dvec3& origin) { origin_ = origin; }
    void place(const Similarity& scene_from_room) { scene_from_room_ = scene_from_room; }
    // A placement that was requested before there was a scene, in its file's coordinates.
    [[nodiscard]] const std::optional<Similarity>& asked() const { return asked_; }
    // The same in the scene; once.
    [[nodiscard]] std::optional<Similarity> takeAsked() { return inScene(std::exchange(asked_, {})); }
    // Also sets the placement, if there is one among them.
    void set(ViewSettings settings) {
        scene_from_room_ = inScene(std::exchange(settings.scene_from_room, {})).value_or(scene_from_room_);
        settings_ = std::move(settings);
        settings_.metres_per_unit.reset();  // the scene's
    }
    void showPanel() { settings_.panel = true; }
    void togglePanel() { settings_.panel = !settings_.panel; }

    // These settings were drawn, so they fit in memory.
    void keepFitting(const ViewSettings& drawn) { fitting_ = drawn; }
    // Changes since then; empty if there are none, or if nothing was drawn yet.
    [[nodiscard]] std::string changeSinceFitting() const {
        return fitting_ ? describeChange(*fitting_, settings_) : "";
    }
    // Returns to the settings that fit; only if changeSinceFitting() is not empty.
    void goBack() { settings_ = *fitting_; }

    // Changes since the last call, see describeChange.
    [[nodiscard]] std::string takeChange() {
        return describeChange(std::exchange(said_, settings_), settings_);
    }

private:
    [[nodiscard]] std::optional<Similarity> inScene(std::optional<Similarity> placement) const {
        if (placement) { placement->position -= origin_; }
        return placement;
    }

    std::optional<Similarity> asked_;
    ViewSettings settings_, said_;
    Similarity scene_from_room_;
    glm::dvec3 origin_{0.0};
    std::optional<ViewSettings> fitting_;  // of the last frame that fitted in memory
};

}  // namespace binosplat
