// The panel's widgets: where the wearer stands and how things look, which scenes there are, and how the
// pictures are made.
#pragma once

#include "app/view/panel/panel_font.h"
#include "app/view/panel/panel_widgets.h"
#include "app/view/panel/scene_chooser.h"
#include "app/view/panel/text_entry.h"
#include "app/view/scenes/viewpoint_list.h"
#include "app/view/settings/view_settings.h"
#include "app/view/wearer/wearer_tool.h"
#include "engine/frame/stereo_frame.h"
#include "xr/bindings.h"

#include <glm/glm.hpp>

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

// How the scene is placed around the wearer.
struct ShownPlace {
    double size_m = 0.0;  // of the scene as shown, along its longest side; 0: unknown
    double growth = 1.0;  // times its true size
    // The eyes' height above the scene's floor or, if that is unknown, above their start.
    double eyes_m = 0.0;
    bool has_floor = false;           // the floor is known
    std::optional<std::size_t> view;  // the viewpoint gone to last
};

// The rate and resolution that reach the eyes.
struct ShownRate {
    // Frames that the wearer got in the last second, and displays; 0: not known yet.
    double met_hz = 0.0, display_hz = 0.0;
    int late = 0;                    // of these frames
    double resolution = 1.0;         // in each direction, relative to the headset's recommendation
    std::optional<double> budget;    // the most that is rendered, if the method has a budget
    std::optional<double> bound_db;  // in place of it: the errors that are left
    bool is_beaten = false;          // the rate cannot be held even with the lowest settings
};

// The time of a scene that moves.
struct ShownTime {
    std::size_t frame = 0, frames = 1;
    double rate_hz = 1.0;
    bool plays = true;
    std::uint64_t late = 0;  // frames that were not loaded in time
};

// In a window, without a headset.
struct ShownWindow {
    bool helps = false;  // the list of keys is shown
    bool fills_screen = false;
};

// The panel's content.
struct PanelStatus {
    std::string scene;
    bool compares = false;  // there is another scene to compare with
    // The next scene that is chosen will be compared with it.
    bool compares_next = false;
    // The other scene stays in sight without a button being held.
    bool shows_other = false;
    // Why the headset shows nothing; empty: it shows something.
    std::string state;
    bool has_scene = false;              // there is something to see
    std::optional<double> loading;       // share done, while a scene is loading
    const FrameResult* frame = nullptr;  // the last one; null before the first
    // wall-clock time from frame to frame, oldest first
    std::vector<float> frame_ms;
    // What the governor is doing about the frame rate, and why.
    std::string governor;
    std::string message;                               // the outcome of the last button
    std::string files;                                 // the file task in the background; empty: none
    bool can_reload_shaders = false;                   // there is a button for it
    bool takes_depth = false;                          // there is a box for it
    bool can_pass_through = false;                     // there is a box for it
    std::vector<ToolChoice> tools;                     // the tools' choices for the wearer
    std::array<const xr::ProfileBindings*, 2> held{};  // what the hands hold; null: unknown
    // Rates that the headset offers; if there are any, they are shown as a row.
    std::vector<double> refresh_rates;
    std::vector<std::pair<std::string, std::string>> facts;  // of the scene, see describeFacts
    ShownPlace place;
    ShownRate rate;
    std::optional<ShownWindow> window;        // empty: in a headset
    std::optional<ShownTime> time;            // of a scene that moves
    std::size_t viewpoint_count = 0;          // places in the scene to go to
    std::string viewpoint;                    // name of the one gone to last
    bool tours = false;                       // through them
    const PicturePlaces* pictures = nullptr;  // of scenes, in the font's texture; null: none
    TextEntry* entry = nullptr;               // what is typed on the panel; null: typing is not possible
};

// What the wearer asked for.
struct PanelRequests {
    bool save = false, load = false, reset_scene = false, quit = false, reload_shaders = false,
         recentre = false, level_scene = false, take_picture = false, natural_size = false,
         keep_viewpoint = false, last_scene = false, play = false, show_whole = false, open_file = false,
         fill_screen = false, help = false, tour = false, rename_viewpoint = false, forget_viewpoint = false,
         share_viewpoints = false, read_viewpoints = false, measure = false, compare = false,
         show_other = false;
    double growth = 1.0;                          // of the scene, around the wearer's feet
    double rise_m = 0.0;                          // of the wearer
    int scene_step = 0;                           // to the previous or next scene
    int viewpoint_step = 0;                       // to the previous or next viewpoint
    int viewpoint_move = 0;                       // of the current one, in the list
    int frame_step = 0;                           // of a scene that moves
    std::optional<std::size_t> frame, viewpoint;  // to go to
    std::string chosen_scene;                     // empty: none
    std::string favourite;                        // a scene to mark as favourite, or to unmark; empty: none
    // The text that was entered.
    std::optional<std::pair<TextEntry::What, std::string>> entered;
    WidgetPlaces places;    // of what was drawn
    ViewSettings settings;  // as they should be from now on
};

// All names and messages on the canvas, one per line; see PanelFont::want.
std::string namesOn(const ViewSettings& settings, const SceneChooser& chooser, const PanelStatus& status);
// All pictures on it.
std::vector<ScenePicture> picturesOn(const ViewSettings& settings, const SceneChooser& chooser);

// Does what was requested with viewpoints, apart from going to one and keeping one. `entry` asks for a new
// name.
void followViewpoints(const PanelRequests& requests, TextEntry& entry, ViewpointList& viewpoints);

// Draws the widgets that fill a canvas of `size_px`, between Canvas::begin and record. Changes `chooser` as
// the wearer asks.
PanelRequests drawPanel(glm::uvec2 size_px, const ViewSettings& current, SceneChooser& chooser,
                        const PanelStatus& status);

}  // namespace binosplat
