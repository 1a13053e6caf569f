// The panel's widgets: what the wearer can change, which scenes there are, and what the last frame cost.
#pragma once

#include "app/view/panel/panel_widgets.h"
#include "app/view/panel/scene_chooser.h"
#include "app/view/view_settings.h"
#include "engine/frame/stereo_frame.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// What the panel shows.
struct OverlayStatus {
    std::string scene;
    std::string state;                                       // why the headset shows nothing; empty: it does
    bool has_scene = false;                                  // there is something to see
    Order usual_order = Order::kDepth;                       // the scene's, where nobody chose one
    std::optional<double> loading;                           // share done, while a scene is on its way
    const FrameResult* frame = nullptr;                      // the last one; null before the first
    std::vector<float> frame_ms;                             // from frame to frame by the clock on the wall, oldest first
    std::string governor;                                    // what it does about the frame rate, and why
    std::string message;                                     // what came of the last button
    std::string files;                                       // what of them is read or written beside the frames; empty: nothing
    bool can_reload_shaders = false;                         // whether there is a button for it
    bool can_pass_through = false;                           // likewise
    std::vector<double> refresh_rates;                       // that the headset can be asked for; where there are any, a row of them
    std::vector<std::pair<std::string, std::string>> facts;  // of the scene, see describeFacts
};

// What the wearer looks through; none of it is kept.
struct OverlayPages {
    enum class Page { kSettings, kScenes, kFacts };
    Page shown = Page::kSettings;
    SceneChooser chooser;
};

// What was asked for.
struct OverlayActions {
    bool save = false, load = false, reset_scene = false, quit = false, reload_shaders = false, recentre = false, level_scene = false,
         take_picture = false;
    int scene_step = 0;        // to the scene before or after
    std::string chosen_scene;  // empty: none
    WidgetPlaces places;       // of what was drawn
};

// All that a canvas shows of names and messages, as it shows them; see Canvas::bringLetters.
std::string namesOn(const OverlayPages& pages, const OverlayStatus& status);

// Draws the widgets that fill a canvas of `size_px`, between Canvas::begin and record. Changes `settings` and `pages` as the wearer does.
OverlayActions drawOverlay(glm::uvec2 size_px, ViewSettings& settings, OverlayPages& pages, const OverlayStatus& status);

}  // namespace binosplat
