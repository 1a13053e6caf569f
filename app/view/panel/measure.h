// Measures a scene: two places, a number on the panel, and its true size.
#pragma once

#include "app/view/panel/panel_content.h"
#include "app/view/placement/ruler.h"
#include "app/view/scenes/scene_loader.h"
#include "app/view/settings/view_state.h"

namespace binosplat {

// Each returns a message about it.
std::string openRuler(Ruler& ruler);
// The user has clicked on that place in the scene, or on nothing; the panel then asks for the distance
// between two places.
std::string measureAt(const std::optional<glm::dvec3>& place, Ruler& ruler, double units_per_metre,
                      TextEntry& entry);

// The true number of metres in a unit, if it has just been entered; it is the scene's from now on.
std::optional<double> takeMeasure(const PanelRequests& requests, const Ruler& ruler, LoadedScene& scene);

// What is saved about a scene.
ViewSettings savedPlace(const ViewState& state, const LoadedScene& scene);

}  // namespace binosplat
