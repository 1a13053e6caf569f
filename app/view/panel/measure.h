// A scene is measured: two places, a number on the panel, and its true size.
#pragma once

#include "app/view/panel/panel_content.h"
#include "app/view/placement/ruler.h"
#include "app/view/scenes/scene_loader.h"
#include "app/view/settings/view_state.h"

namespace binosplat {

// Each returns what is said about it.
std::string openRuler(Ruler& ruler);
// Somebody has clicked on that place of the scene, or where nothing is; the panel then asks for the distance
// of two.
std::string measureAt(const std::optional<glm::dvec3>& place, Ruler& ruler, double units_per_metre,
                      TextEntry& entry);

// The true metres in a unit, if they were written just now: the scene's from now on.
std::optional<double> takeMeasure(const PanelRequests& requests, const Ruler& ruler, LoadedScene& scene);

// What is saved of a scene.
ViewSettings savedPlace(const ViewState& state, const LoadedScene& scene);

}  // namespace binosplat
