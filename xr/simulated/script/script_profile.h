// Which controllers a script is written for.
#pragma once

#include "xr/simulated/api/profiles.h"
#include "xr/simulated/script/script.h"

namespace simulated {

// Throws ScriptError for the first input that the script moves and that these controllers do not have on that hand, nor any that the
// script has in their place later on.
void checkInputs(const Script& script, const Profile& profile);

}  // namespace simulated
