// The runtime's settings in the environment: SIMULATED_OPENXR_SCRIPT and others.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "xr/simulated/system.h"

namespace simulated {

struct Setting {
    std::string variable;  // its full name
    bool is_there = false;
    std::string value;

    [[nodiscard]] bool isSet() const { return !value.empty(); }
};

// `name` is "SCRIPT", "OUT", "CLOCK", "PROFILE", "GPU" or "EXPLAIN".
[[nodiscard]] inline Setting settingOf(const char* name) {
    std::string variable = std::string("SIMULATED_OPENXR_") + name;
    std::optional<std::string> value = readEnvironmentVariable(variable);
    const bool is_there = value.has_value();
    return {std::move(variable), is_there, std::move(value).value_or("")};
}

}  // namespace simulated
