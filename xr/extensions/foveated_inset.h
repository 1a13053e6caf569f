// XR_VARJO_quad_views, in the core of OpenXR 1.1: besides each eye's view (the context) the program draws an
// inset: a smaller part of it at more pixels per degree, which the runtime moves with the gaze.
#pragma once

#include "xr/instance.h"

#include <glm/glm.hpp>

#include <optional>

namespace binosplat::xr {

inline constexpr auto kStereoWithInset = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_QUAD_VARJO;

// Recommended sizes of an eye's two views, each the larger of both eyes.
struct InsetSizes {
    glm::uvec2 context_px{0, 0}, inset_px{0, 0};
};

// True if insets may follow the gaze (XR_VARJO_foveated_rendering): each call that locates them says so.
[[nodiscard]] bool findsMovingInset(const Instance& instance);

// For the current headset; empty if it has no inset, or InstanceOptions did not ask for one.
[[nodiscard]] std::optional<InsetSizes> findInset(const Instance& instance);

}  // namespace binosplat::xr
