// What the environment says: SIMULATED_OPENXR_SCRIPT, or as it was called before, BINOSPLAT_SIMULATED_SCRIPT.
#pragma once

#include <cstdlib>
#include <string>

namespace simulated {

struct Setting {
    std::string variable;         // the name that is set
    const char* value = nullptr;  // null if none is set

    [[nodiscard]] bool isSet() const { return value != nullptr && *value != '\0'; }
};

// `name` is "SCRIPT", "OUT", "CLOCK", "PROFILE", "GPU" or "EXPLAIN". The new name counts before the old one.
[[nodiscard]] inline Setting settingOf(const char* name) {
    for (const char* const prefix : {"SIMULATED_OPENXR_", "BINOSPLAT_SIMULATED_"}) {
        std::string variable = std::string(prefix) + name;
        if (const char* const value = std::getenv(variable.c_str())) { return {std::move(variable), value}; }
    }
    return {std::string("SIMULATED_OPENXR_") + name, nullptr};
}

}  // namespace simulated
