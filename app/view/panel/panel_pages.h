// The panel's pages, each below the row of tabs.
#pragma once

#include "app/view/panel/panel_content.h"

namespace binosplat {

// For whoever wears the headset: how sharp and how smooth, where one stands, how large the scene is, how one moves.
void drawViewPage(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status, PanelRequests& requests);
// Which scene, and from where.
void drawScenesPage(PanelWidgets& widgets, SceneChooser& chooser, const PanelStatus& status, PanelRequests& requests);
// For whoever studies how the pictures are made, and what they take.
void drawMethodPage(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status, PanelRequests& requests);

// Of a scene that moves, while status.time has a value.
void drawTimePage(PanelWidgets& widgets, const PanelStatus& status, PanelRequests& requests);

// What came of what was done, and what goes on; it may take several lines, and moves nothing that is pointed at.
void drawSaid(const PanelStatus& status);

}  // namespace binosplat
