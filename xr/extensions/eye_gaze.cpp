// The gaze as an action.
#include "xr/extensions/eye_gaze.h"

#include <array>

namespace binosplat::xr {

bool findsGaze(const Instance& instance) {
    if (!instance.hasExtension(XR_EXT_EYE_GAZE_INTERACTION_EXTENSION_NAME)) { return false; }
    auto eyes = structure<XrSystemEyeGazeInteractionPropertiesEXT>(
        XR_TYPE_SYSTEM_EYE_GAZE_INTERACTION_PROPERTIES_EXT);
    instance.troubles().tryFor("eye tracking", [&] { instance.readProperties(&eyes); });
    return eyes.supportsEyeGazeInteraction == XR_TRUE;
}

void EyeGaze::bind() {
    const Instance& instance = session_.instance();
    if (!instance.tracksEyes()) { return; }
    const bool made = instance.troubles().tryFor("eye tracking", [&] {
        action_ = actions_.make("gaze", "Sharp where you look", XR_ACTION_TYPE_POSE_INPUT);
        const std::array bindings{
            XrActionSuggestedBinding{action_, instance.path("/user/eyes_ext/input/gaze_ext/pose")}};
        checkResult(actions_.suggest("ext/eye_gaze_interaction", bindings),
                    "xrSuggestInteractionProfileBindings");
    });
    if (!made) { action_ = XR_NULL_HANDLE; }
}

void EyeGaze::makeSpace() {
    if (action_ == XR_NULL_HANDLE) { return; }
    const auto make = [&] { space_ = actions_.makeSpace(action_); };
    if (!session_.instance().troubles().tryFor("eye tracking", make)) { action_ = XR_NULL_HANDLE; }
}

std::optional<glm::dvec3> EyeGaze::find() {
    if (action_ == XR_NULL_HANDLE) { return std::nullopt; }
    std::optional<Pose> pose;
    const auto find = [&] {
        pose = actions_.locate(action_, XR_NULL_PATH, space_, Actions::kKnown | Actions::kTracked);
    };
    if (!session_.instance().troubles().tryFor("eye tracking", find)) { action_ = XR_NULL_HANDLE; }
    if (!pose) { return std::nullopt; }
    return pose->orientation * glm::dvec3(0.0, 0.0, 1.0);
}

}  // namespace binosplat::xr
