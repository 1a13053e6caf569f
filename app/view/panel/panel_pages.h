// The panel's pages, each below the row of tabs.
#pragma once

#include "app/view/panel/panel_content.h"

namespace binosplat {

// Share of a line for pictures and files; next to pictures it says what they show.
inline constexpr float kKeptShare = 0.74f;

// For wearers: sharpness and smoothness, place, size of the scene, and ways to move.
void drawViewPage(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status,
                  PanelRequests& requests);
// The same for a window.
void drawWindowPage(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status,
                    PanelRequests& requests);
// Choice of scene and viewpoint.
void drawScenesPage(PanelWidgets& widgets, SceneChooser& chooser, const PanelStatus& status,
                    PanelRequests& requests);
// For those who study how the pictures are made, and at what cost.
void drawMethodPage(PanelWidgets& widgets, ViewSettings& settings, const PanelStatus& status,
                    PanelRequests& requests);

// For a scene that moves, while status.time has a value.
void drawTimePage(PanelWidgets& widgets, const PanelStatus& status, PanelRequests& requests);

// What hands and controllers do, and the way out.
void drawHelpPage(PanelWidgets& widgets, const PanelStatus& status, PanelRequests& requests);

// In place of any page.
void drawTextEntry(PanelWidgets& widgets, TextEntry& entry, PanelRequests& requests);

// Outcomes and work in progress, below all buttons, since this may take several lines.
void drawSaid(const PanelStatus& status);

}  // namespace binosplat
