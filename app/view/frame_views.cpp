// Where the headset says that the eyes are.
#include "app/view/frame_views.h"

#include "app/view/placement/view_eyes.h"

namespace binosplat {

std::optional<FrameViews> locateViews(xr::Session& session) {
    const std::optional<std::array<xr::EyeView, 2>> located = session.locateEyes();
    if (!located) { return std::nullopt; }
    const std::array<xr::EyeView, 2> eyes = withoutNoise(*located);
    const std::array<Pose, 2> room_from_eyes = roomFromEyes(eyes);
    FrameViews views{eyes, room_from_eyes, roomFromHead(room_from_eyes), {}, {}, eyes};
    if (const auto& insets = session.insets()) {
        views.insets = withoutNoise({xr::EyeView{eyes[kLeft].pose, (*insets)[kLeft]},
                                     xr::EyeView{eyes[kRight].pose, (*insets)[kRight]}});
    }
    return views;
}

}  // namespace binosplat
