// Where the eyes look, for a frame: where the headset sees them look, or else at the middle of their lenses.
#pragma once

#include "engine/frame/stereo_frame.h"

#include <array>
#include <optional>

namespace binosplat {

// A gaze is forgotten once the way back from it to the lens is done, and nothing of it is written anywhere.
class GazeFollower {
public:
    // So far about a gaze that the headset sees the eye may look by the time that the picture is there: eyes that meet half a metre away
    // turn 3.6 degrees, trackers are off by 1 or 2, and an eye moves on meanwhile.
    static constexpr double kSeenClearRadians = 0.14;
    // How long a gaze that is lost, as by a blink, still counts; how long it then takes back to the lenses; and to a gaze that is found.
    static constexpr double kHoldSeconds = 0.2, kLoseSeconds = 0.6, kFindSeconds = 0.1;

    // `gaze_room`: a direction in the room, empty while none is seen. Without one an eye looks up to `lens_clear_rad` beside its own axis.
    // By Side. `step_seconds` have passed since the frame before.
    std::array<std::optional<Gaze>, 2> update(const std::optional<glm::dvec3>& gaze_room, const std::array<Pose, 2>& room_from_eyes,
                                              double lens_clear_rad, double step_seconds);

private:
    std::array<glm::dvec3, 2> last_{glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 0.0, 1.0)};  // as seen last, in the eyes' axes
    double lost_seconds_ = 0.0;
    double share_ = 0.0;  // on the way from the lens to the gaze
};

}  // namespace binosplat
