// What the wearer can change while looking, and the config that keeps it.
#pragma once

#include "app/options/options.h"
#include "app/view/governor/governor.h"
#include "engine/similarity.h"

#include <optional>
#include <string>
#include <vector>

namespace binosplat {

enum class PanelPage { kView, kScenes, kMethod, kTime };
// What is seen behind the scene, if not what --background says.
enum class Backdrop { kAsSet, kBlack, kGrey, kWhite };

struct ViewSettings {
    StereoOptions stereo;
    double resolution_scale = 1.0;  // of what the headset recommends, each way
    bool tint = false;              // show what made the affiliated picture
    bool panel = true;
    bool visibility_mask = true;  // ask the runtime what the lenses hide; at the start alone
    bool eye_tracking = false;    // whether the headset may say where the eyes look; at the start alone
    bool foveated_inset = true;   // with half the resolution about it: leave that to a runtime that does it itself; at the start alone
    bool tilt = false;            // whether two hands may tilt the scene
    double refresh_rate = 0.0;    // frames per second; 0: the runtime's choice
    bool hands = true;            // draw them, or what they hold
    bool teleport = false;        // in place of walking
    bool smooth_turn = false;     // in place of turns by 30 degrees
    Backdrop backdrop = Backdrop::kAsSet;
    PanelPage page = PanelPage::kView;
    bool vignette = true;                       // while the wearer moves by stick
    bool passthrough = false;                   // the room in place of the background, where the headset shows it
    Quality quality = Quality::kOff;            // how the frame rate is held
    double last_foveation_deg = 15.0;           // what the panel's box switches on: as far as eyes usually turn before the head does
    std::optional<Similarity> scene_from_room;  // absent: the scene's own view

    bool operator==(const ViewSettings&) const = default;

    // Both eyes are shown the dominant one's picture.
    [[nodiscard]] bool showsOneEye() const { return stereo.mode == Mode::kMono; }
    [[nodiscard]] bool wantsInset() const { return foveated_inset && stereo.half_periphery && stereo.foveation_deg > 0.0; }
};

// The config's [view] over `settings`: the rows of view_settings_table.h, and together scene-position, scene-orientation (w, x, y, z) and
// units-per-metre. Throws Error with file and line.
ViewSettings readViewSettings(const std::vector<SettingsTable>& tables, ViewSettings settings);

// A config that --config takes, also of `render`.
std::string viewSettingsToml(const ViewSettings& settings);

// What differs, as "mode = paper, margin = 16"; placements aside. Empty if nothing does.
std::string describeChange(const ViewSettings& before, const ViewSettings& after);

}  // namespace binosplat
