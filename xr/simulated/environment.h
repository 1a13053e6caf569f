// What the environment says: SIMULATED_OPENXR_SCRIPT, or as it was called before, BINOSPLAT_SIMULATED_SCRIPT.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "xr/simulated/system.h"

namespace simulated {

struct Setting {
    std::string variable;  // the name that is set
    bool is_there = false;
    std::string value;

    [[nodiscard]] bool isSet() const { return !value.empty(); }
};

// `name` is "SCRIPT", "OUT", "CLOCK", "PROFILE", "GPU" or "EXPLAIN". The new name counts before the old one.
[[nodiscard]] inline Setting settingOf(const char* name) {
    for (const char* const prefix : {"SIMULATED_OPENXR_", "BINOSPLAT_SIMULATED_"}) {
        std::string variable = std::string(prefix) + name;
        if (std::optional<std::string> value = environmentVariable(variable)) { return {std::move(variable), true, std::move(*value)}; }
    }
    return {std::string("SIMULATED_OPENXR_") + name, false, {}};
}

}  // namespace simulated
