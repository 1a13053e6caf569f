// The two controllers, whatever they are.
#pragma once

#include "engine/geometry.h"
#include "xr/session.h"

#include <array>
#include <optional>

namespace binosplat::xr {

// One hand at the time of a frame, in room axes (ours: x right, y down, z forward).
struct Hand {
    std::optional<Pose> aim;              // the ray goes along its z
    std::optional<Pose> grip;             // where the hand is
    double trigger = 0.0, squeeze = 0.0;  // 0 to 1
    glm::dvec2 stick{0.0};                // right and up are positive
    bool menu = false;
};

class Input {
public:
    // Suggests bindings for the controllers of Oculus, Valve, Microsoft, HTC and Khronos' simple one, and attaches them.
    explicit Input(const Session& session);
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;
    ~Input();

    // Both hands, [kLeft] and [kRight], at the open frame's display time; at rest while the input goes to somebody else.
    [[nodiscard]] std::array<Hand, 2> read() const;

private:
    [[nodiscard]] XrAction makeAction(const char* name, const char* description, XrActionType type);
    void suggestBindings() const;
    [[nodiscard]] double readNumber(XrAction action, XrPath hand) const;
    [[nodiscard]] std::optional<Pose> locate(XrAction action, XrPath hand, XrSpace space) const;

    const Session& session_;
    XrActionSet set_ = XR_NULL_HANDLE;
    XrAction aim_ = XR_NULL_HANDLE, grip_ = XR_NULL_HANDLE, trigger_ = XR_NULL_HANDLE, squeeze_ = XR_NULL_HANDLE, stick_ = XR_NULL_HANDLE,
             menu_ = XR_NULL_HANDLE;
    std::array<XrPath, 2> hands_{};
    std::array<XrSpace, 2> aim_spaces_{}, grip_spaces_{};
};

}  // namespace binosplat::xr
