// Where the camera is in the scene: what the mouse, the panel and a tour do to it, the viewpoints, and the
// true distance of two places.
#pragma once

#include "app/desktop/scene_pictures.h"
#include "app/view/panel/panel_content.h"
#include "app/view/placement/ruler.h"
#include "app/view/scenes/viewpoint_list.h"

#include <map>

namespace binosplat {

class CameraPlace {
public:
    // All must exist while it is used.
    CameraPlace(const RunOptions& options, ScenePictures& pictures, ViewState& state, SceneNotes& notes,
                FileWorker& files, const FrameLog& log, const Say& say);

    [[nodiscard]] const OrbitCamera& camera() const { return mover_.camera(); }
    [[nodiscard]] double angleRad() const { return angle_rad_; }  // of view
    [[nodiscard]] bool isDragged() const { return mover_.isDragging(); }
    [[nodiscard]] bool isOnWay() const { return mover_.isGliding(); }
    [[nodiscard]] const ViewpointList& viewpoints() const { return viewpoints_; }

    // Another scene is shown, or none (null); it must exist until the next call. The camera is where it was
    // in that scene, where the scene was saved, or at its start.
    void show(LoadedScene* scene);
    // Input outside the panel.
    void handle(const DesktopEvent& event, const WindowLayout& layout, TextEntry& entry);
    // Once per turn.
    void pass(const HeldMotion& held, double seconds);
    // Does what was requested; puts the state's placement where somebody will stand who comes later.
    void follow(const PanelRequests& requests, TextEntry& entry);
    // True if a file is of viewpoints: it is read.
    bool takeViewpoints(const std::string& file) { return viewpoints_.take(file); }

private:
    void press(const DesktopEvent& event, const WindowLayout& layout, TextEntry& entry);
    bool isSecondClick(const glm::dvec2& place_px);
    // What is seen at a place or, if nothing is, a point as far away as the centre.
    [[nodiscard]] glm::dvec3 under(const glm::dvec2& place_px, const WindowLayout& layout) const;
    void goTo(const Viewpoint* viewpoint, double within_seconds = 0.35);  // null: stays
    void measure(const PanelRequests& requests);

    const RunOptions& options_;
    ScenePictures& pictures_;
    ViewState& state_;
    SceneNotes& notes_;
    const FrameLog& log_;
    Say say_;
    double angle_rad_;
    CameraMover mover_;
    ViewpointList viewpoints_;
    Ruler ruler_;
    LoadedScene* scene_ = nullptr;
    std::string place_;                        // of that scene
    std::map<std::string, OrbitCamera> left_;  // by place: where another scene replaced this one
    glm::dvec2 pressed_px_{0.0};               // the last press of the left button
    std::chrono::steady_clock::time_point pressed_at_{};
};

}  // namespace binosplat
