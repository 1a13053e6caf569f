// What a suggested binding means for an action of a given type (chapter 11, "Suggested Bindings").
#pragma once

#include <openxr/openxr.h>

#include <cstddef>
#include <optional>
#include <string>

#include "xr/simulated/script/script.h"

namespace simulated {

struct Instance;
struct Profile;

// A binding of the profile in use, resolved for its action's type.
struct BoundSource {
    XrPath path;
    XrPath user_path;
    std::size_t device = kLeftHand;
    std::string source;     // "trigger": what priorities compare
    std::string component;  // "trigger/value"; "thumbstick" for both axes; "grip/pose"; "haptic"
};

// Nothing if the profile has nothing there for this type of action, which then stays unbound.
std::optional<BoundSource> bindSource(const Instance& instance, const Profile& profile, XrPath path,
                                      XrActionType type);

}  // namespace simulated
