// Enumerants as the specification spells them; null for values that it does not know.
#pragma once

#include "xr/simulated/openxr.h"

namespace simulated {

const char* nameOf(XrResult result);
const char* nameOf(XrStructureType type);
// "FOCUSED".
const char* wordOf(XrSessionState state);
// "ALPHA_BLEND".
const char* wordOf(XrEnvironmentBlendMode mode);

}  // namespace simulated
