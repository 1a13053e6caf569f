// Chapter 8: the view configurations, stereo and stereo with a foveated inset, and their views.
#pragma once

#include "xr/simulated/api/session.h"

namespace simulated {

// Views 0 and 1 are the eyes; 2 and 3 are their insets.
constexpr std::size_t kMostViews = 2 * kEyes;

// XR_ERROR_VIEW_CONFIGURATION_TYPE_UNSUPPORTED for those that this headset lacks, XR_ERROR_VALIDATION_FAILURE
// for unknown values.
void checkViewConfiguration(const Instance& instance, XrViewConfigurationType type);

constexpr std::size_t countViews(XrViewConfigurationType type) {
    return type == XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO_WITH_FOVEATED_INSET ? kMostViews : kEyes;
}

constexpr Side sideOf(std::size_t view) { return view % kEyes == 0 ? kLeft : kRight; }
constexpr bool isInset(std::size_t view) { return view >= kEyes; }

}  // namespace simulated
