// Which controllers a script is written for.
#pragma once

#include "xr/simulated/api/profiles.h"
#include "xr/simulated/script/script.h"

namespace simulated {

// Throws ScriptError for the first input that the script moves but that these controllers lack on that hand,
// as do all those that the script replaces them with later.
void checkInputs(const Script& script, const Profile& profile);

}  // namespace simulated
