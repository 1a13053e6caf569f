// Checks that the controllers have the inputs that a script moves.
#include "xr/simulated/script/script_profile.h"

#include "xr/simulated/script/script_inputs.h"
#include "xr/simulated/script/script_words.h"

#include <algorithm>

namespace simulated {

namespace {

bool hasInput(const Profile& profile, Side side, std::string_view input) {
    const std::string prefix = "/input/" + std::string(input) + "/";
    const std::string_view user_path = side == kLeft ? "/user/hand/left" : "/user/hand/right";
    return std::ranges::any_of(profile.components, [&](const Component& one) {
        const bool is_of_side = one.user_path.empty() || one.user_path == user_path;
        return is_of_side && one.kind != ComponentKind::kPose && one.path.starts_with(prefix);
    });
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
            if (hasInput(profile, side, input) ||
                std::ranges::any_of(script.later_profiles.changes(), isOfLater)) {
                continue;
            }
            failAt(place, "the {} hand of {} has no {}, must be one of: {}", side == kLeft ? "left" : "right",
                   shown(profile.path.substr(std::string_view("/interaction_profiles/").size())), input,
                   inputsOf(profile, side));
        }
    }
}

}  // namespace simulated
