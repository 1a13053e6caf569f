// The panel's widgets: where the wearer stands and how it looks, which scenes there are, and how the pictures are made.
#pragma once

#include "app/view/panel/panel_font.h"
#include "app/view/panel/panel_widgets.h"
#include "app/view/panel/scene_chooser.h"
#include "app/view/settings/view_settings.h"
#include "app/view/wearer/wearer_tool.h"
#include "engine/frame/stereo_frame.h"

#include <glm/glm.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// How the scene lies about the wearer.
struct ShownPlace {
    double size_m = 0.0;              // of the scene as it is shown, along its longest side; 0: unknown
    double growth = 1.0;              // times as large as it is
    double eyes_m = 0.0;              // the eyes' height over the scene's floor or, where that is unknown, over where they began
    bool has_floor = false;           // it is known
    std::optional<std::size_t> view;  // the viewpoint gone to last
};

// What of the pictures reaches the eyes.
struct ShownRate {
    double met_hz = 0.0, display_hz = 0.0;  // displays that had a new picture, and all; 0: not known yet
    double resolution = 1.0;                // each way, of what the headset recommends
    std::optional<double> budget;           // how much of the pictures is rendered again at most, where the method has such a share
    bool is_beaten = false;                 // the rate is to be held, and nothing that may be given up is enough
};

// Of a scene that moves.
struct ShownTime {
    std::size_t frame = 0, frames = 1;
    double rate_hz = 1.0;
    bool plays = true;
    std::uint64_t late = 0;  // frames that were not there in time
};

// What the panel shows.
struct PanelStatus {
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
    std::vector<ToolChoice> tools;                           // what they let the wearer choose
    std::vector<double> refresh_rates;                       // that the headset can be asked for; where there are any, a row of them
    std::vector<std::pair<std::string, std::string>> facts;  // of the scene, see describeFacts
    ShownPlace place;
    ShownRate rate;
    std::optional<ShownTime> time;            // of a scene that moves
    std::size_t viewpoint_count = 0;          // places in the scene to go to
    std::string viewpoint;                    // name of the one gone to last
    const PicturePlaces* pictures = nullptr;  // of scenes, in the font's texture; null: none
};

// What was asked for.
struct PanelRequests {
    bool save = false, load = false, reset_scene = false, quit = false, reload_shaders = false, recentre = false, level_scene = false,
         take_picture = false, natural_size = false, keep_viewpoint = false, last_scene = false, play = false;
    double growth = 1.0;               // of the scene about the wearer's feet
    double rise_m = 0.0;               // of the wearer
    int scene_step = 0;                // to the scene before or after
    int viewpoint_step = 0;            // to the viewpoint before or after
    int frame_step = 0;                // of a scene that moves
    std::optional<std::size_t> frame;  // to go to
    std::string chosen_scene;          // empty: none
    std::string favourite;             // a scene that is to become a favourite, or to be none any more; empty: none
    WidgetPlaces places;               // of what was drawn
    ViewSettings settings;             // as they are to be from now on
};

// All that a canvas shows of names and messages, a line each; see PanelFont::want.
std::string namesOn(const ViewSettings& settings, const SceneChooser& chooser, const PanelStatus& status);
// Likewise the pictures.
std::vector<ScenePicture> picturesOn(const ViewSettings& settings, const SceneChooser& chooser);

// Draws the widgets that fill a canvas of `size_px`, between Canvas::begin and record. Changes `chooser` as the wearer does.
PanelRequests drawPanel(glm::uvec2 size_px, const ViewSettings& current, SceneChooser& chooser, const PanelStatus& status);

}  // namespace binosplat
