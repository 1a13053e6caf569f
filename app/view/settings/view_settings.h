// The settings that the wearer can change in the headset, and their config.
#pragma once

#include "app/options/options.h"
#include "app/view/governor/governor.h"
#include "engine/similarity.h"

#include <optional>
#include <string>
#include <vector>

namespace binosplat {

enum class PanelPage { kView, kScenes, kMethod, kTime, kHelp };
// The background behind the scene; kAsSet: that of --background.
enum class Backdrop { kAsSet, kBlack, kGrey, kWhite };
inline glm::dvec3 colourOf(Backdrop backdrop) {
    return glm::dvec3(backdrop == Backdrop::kWhite ? 1.0 : backdrop == Backdrop::kGrey ? 0.5 : 0.0);
}
// Whether the first gestures are shown at the start.
enum class FirstStepsShown { kOnce, kAlways, kNever };
// What a window without a headset shows of the two eyes.
enum class WindowStereo { kMono, kSideBySide, kCrossEyed, kTopBottom, kAnaglyph };
// Whether a window's picture gets four samples per pixel once nothing changes; kAuto: on a quick GPU.
enum class SmoothAtRest { kAuto, kOff, kOn };

struct ViewSettings {
    StereoOptions stereo;
    double resolution_scale = 1.0;  // relative to the headset's recommendation, each way
    bool tint = false;              // show how the affiliated picture was made
    bool panel = true;
    bool submit_depth = true;     // give the runtime depth, too; if off at the start, it stays off
    bool visibility_mask = true;  // ask the runtime what the lenses hide; only at the start
    bool eye_tracking = false;    // whether the headset may track the eyes; only at the start
    // With half_periphery: leave that to the runtime if it has insets; only at the start.
    bool foveated_inset = true;
    bool tilt = false;           // whether two hands may tilt the scene
    double refresh_rate = 0.0;   // frames per second; 0: the runtime's choice
    bool hands = true;           // draw them, or the controllers they hold
    bool teleport = false;       // in place of walking
    bool smooth_turn = false;    // in place of turns by 30 degrees
    bool follow_ground = false;  // the wearer stands on the scene's ground
    Backdrop backdrop = Backdrop::kAsSet;
    PanelPage page = PanelPage::kView;
    bool vignette = true;  // while the wearer moves by stick
    FirstStepsShown first_steps = FirstStepsShown::kOnce;
    bool passthrough = false;              // the room in place of the background, if the headset can
    Quality quality = Quality::kBalanced;  // how the frame rate is held
    bool picture_both_eyes = false;        // pictures as files show both, side by side
    // What the panel's box sets; at first, as far as eyes usually turn before the head does.
    double last_foveation_deg = 15.0;
    // Of a window without a headset, see WindowSight.
    WindowStereo window_stereo = WindowStereo::kMono;
    double window_eyes = 0.033, window_plane = 1.0;
    SmoothAtRest window_smooth = SmoothAtRest::kAuto;
    std::optional<Similarity> scene_from_room;  // absent: the scene's own view
    std::optional<double> metres_per_unit;      // of the scene, if somebody has measured it

    bool operator==(const ViewSettings&) const = default;

    // True if both eyes are shown the dominant one's picture.
    [[nodiscard]] bool showsOneEye() const { return stereo.mode == Mode::kMono; }
    [[nodiscard]] bool wantsInset() const {
        return foveated_inset && stereo.half_periphery && stereo.foveation_deg > 0.0;
    }
};

// The config's [view] over `settings`: the rows of view_settings_table.h, and together scene-position,
// scene-orientation (w, x, y, z) and units-per-metre. Throws Error with file and line.
ViewSettings readViewSettings(const std::vector<SettingsTable>& tables, ViewSettings settings);

// A config for --config, also for that of `render`.
std::string viewSettingsToml(const ViewSettings& settings);
// Only what is kept of a scene: where the wearer's room lies in it, and the size of its units.
std::string scenePlaceToml(const ViewSettings& settings);

// A setting as TOML writes it.
struct SettingLine {
    const char* table;  // "stereo" or "view"
    std::string key, value;
    bool operator==(const SettingLine&) const = default;
};
std::vector<SettingLine> settingLines(const ViewSettings& settings);

// The differences, as "mode = paper, margin = 16", except placements. Empty if there are none.
std::string describeChange(const ViewSettings& before, const ViewSettings& after);

}  // namespace binosplat
