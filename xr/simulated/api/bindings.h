// An application's suggestions in xrSuggestInteractionProfileBindings.
#pragma once

#include <cstdint>
#include <vector>

#include "xr/simulated/openxr.h"

namespace simulated {

struct SuggestedBinding {
    std::uint64_t action;  // its number: the handle may be gone by now
    XrPath path;
};

struct SuggestedProfile {
    XrPath profile;
    std::vector<SuggestedBinding> bindings;
};

}  // namespace simulated
