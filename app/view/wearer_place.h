// Where the wearer stands in the scene, and what they do about it on the panel: its size, their height,
// viewpoints, and the true distance of two places.
#pragma once

#include "app/view/panel/panel.h"
#include "app/view/placement/ruler.h"
#include "app/view/scene_pointing.h"
#include "app/view/scenes/scene_notes.h"
#include "app/view/scenes/viewpoint_list.h"
#include "app/view/settings/view_state.h"

namespace binosplat {

class WearerPlace {
public:
    // All must outlive this. `metres_per_unit` is that of scenes whose own is unknown.
    WearerPlace(ViewState& state, SceneNotes& notes, FileWorker& files, double metres_per_unit, Say say,
                Say log)
        : state_(state),
          notes_(notes),
          metres_per_unit_(metres_per_unit),
          say_(say),
          log_(std::move(log)),
          viewpoints_(files, std::move(say)) {}

    // Another scene is shown, or none (null); it must exist until the next call.
    void show(LoadedScene* scene);
    void setHead(const Pose& room_from_head) { room_from_head_ = room_from_head; }
    [[nodiscard]] const Pose& roomFromHead() const { return room_from_head_; }  // as last known

    // While a scene is shown.
    [[nodiscard]] ShownPlace shown() const;
    [[nodiscard]] const ViewpointList& viewpoints() const { return viewpoints_; }
    // Each of these is true if the wearer jumped. The first does what was requested on the panel.
    bool follow(const PanelRequests& requests, TextEntry& entry);
    bool goBy(int step);  // among the viewpoints; ends a tour
    // A wearer must not be moved smoothly, so a tour jumps, with a fade.
    bool passTour(double step_seconds);
    // True if a file is of viewpoints: it is read.
    bool takeViewpoints(const std::string& file) { return viewpoints_.take(file); }
    [[nodiscard]] bool measures() const { return ruler_.isOpen(); }
    // While the ruler is open, a trigger says where the ray meets the scene. True once both places are known.
    bool measure(const std::array<xr::Hand, 2>& hands, const PanelInRoom& panel,
                 const ScenePointing& pointing, TextEntry& entry);

private:
    void grow(double growth);
    bool goTo(const Viewpoint* viewpoint);  // null: stays

    ViewState& state_;
    SceneNotes& notes_;
    double metres_per_unit_;
    Say say_, log_;
    ViewpointList viewpoints_;
    LoadedScene* scene_ = nullptr;
    Pose room_from_head_;
    Ruler ruler_;
    std::array<bool, 2> clicked_{};  // by hand, in the frame before
};

}  // namespace binosplat
