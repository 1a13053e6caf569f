// Where the eyes look in a frame: according to the headset's eye tracker, or otherwise at the middle of their
// lenses.
#pragma once

#include "engine/frame/stereo_frame.h"

#include <array>
#include <optional>

namespace binosplat {

// A gaze is forgotten once the transition back to the lens is done, and is never written anywhere.
class GazeFollower {
public:
    // How far from the tracked gaze an eye may look by the time the picture is shown: eyes that converge at
    // half a metre turn by 3.6 degrees, trackers are wrong by 1 or 2, and eyes move on meanwhile.
    static constexpr double kSeenClearRadians = 0.14;
    // How long a lost gaze, as in a blink, still counts; how long the transition to the lenses then takes;
    // and how long the one to a new gaze takes.
    static constexpr double kHoldSeconds = 0.2, kLoseSeconds = 0.6, kFindSeconds = 0.1;

    // By Side. `gaze_room`: a direction in the room, empty while none is tracked; an eye then looks up to
    // `lens_clear_rad` off its own axis. `step_seconds` is the time since the previous frame.
    std::array<std::optional<Gaze>, 2> update(const std::optional<glm::dvec3>& gaze_room,
                                              const std::array<Pose, 2>& room_from_eyes,
                                              double lens_clear_rad, double step_seconds);

private:
    // The last tracked directions, in the eyes' axes.
    std::array<glm::dvec3, 2> last_{glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 0.0, 1.0)};
    double lost_seconds_ = 0.0;
    double share_ = 0.0;  // of the transition from the lens to the gaze
};

}  // namespace binosplat
