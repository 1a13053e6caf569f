// Whether the inputs that a script moves are on the controllers it is written for.
#include "xr/simulated/script/script_profile.h"

#include "xr/simulated/script/script_inputs.h"
#include "xr/simulated/script/script_words.h"

#include <algorithm>

namespace simulated {

namespace {

bool hasInput(const Profile& profile, Side side, std::string_view input) {
    const std::string prefix = "/input/" + std::string(input) + "/";
    const auto holds = [&](std::span<const std::string_view> components) {
        return std::any_of(components.begin(), components.end(), [&](std::string_view component) { return component.starts_with(prefix); });
    };
    return holds(profile.components) || holds(side == kLeft ? profile.left_components : profile.right_components);
}

std::string inputsOf(const Profile& profile, Side side) {
    std::string known;
    for (const auto& [name, kind] : kInputs) {
        if (hasInput(profile, side, name)) { known += (known.empty() ? "" : ", ") + std::string(name); }
    }
    return known;
}

}  // namespace

void checkInputs(const Script& script, const Profile& profile) {
    for (const Side side : kSides) {
        for (const auto& [input, place] : script.hands[side].input_places) {
            const auto isOfLater = [&, &moved = input](const auto& change) {
                return hasInput(*findHandProfile(change.second), side, moved);
            };
            if (hasInput(profile, side, input) || std::ranges::any_of(script.later_profiles.changes(), isOfLater)) { continue; }
            failAt(place, "the {} hand of {} has no {}, must be one of: {}", side == kLeft ? "left" : "right",
                   shown(profile.path.substr(std::string_view("/interaction_profiles/").size())), input, inputsOf(profile, side));
        }
    }
}

}  // namespace simulated
