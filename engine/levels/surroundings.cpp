// Medians of a sample, and how far most of it lies from these.
#include "engine/levels/surroundings.h"

#include "engine/scene/floor_plane.h"

#include <algorithm>
#include <vector>

namespace binosplat {

namespace {

constexpr std::size_t kMostSampled = 100'000;
// A step through three quarters of the scene turns what is this much farther away by at most 7 degrees.
constexpr double kMost = 0.75;
constexpr float kFartherAway = 8.0f;
// Fewer are strays. More would leave the levels too little of a budget; far away, these are coarse anyway.
constexpr std::size_t kFewest = 256, kMostSplats = 128 * 1024, kMostShare = 4;

}  // namespace

std::optional<Surroundings> findSurroundings(std::span<const glm::vec3> centres) {
    Surroundings around;
    const std::size_t step = centres.size() / kMostSampled + 1;
    const auto quantileOf = [&](double share, const auto& value) {
        std::vector<double> values;
        for (std::size_t i = 0; i < centres.size(); i += step) { values.push_back(value(centres[i])); }
        return static_cast<float>(findQuantile(values, share));
    };
    if (centres.size() < kMostShare * kFewest) { return std::nullopt; }
    for (int axis = 0; axis < 3; ++axis) {
        around.middle[axis] = quantileOf(0.5, [&](const glm::vec3& centre) { return centre[axis]; });
    }
    around.beyond = kFartherAway * quantileOf(kMost, [&](const glm::vec3& centre) {
                        return glm::distance(centre, around.middle);
                    });
    const auto outside = static_cast<std::size_t>(
        std::ranges::count_if(centres, [&](const glm::vec3& centre) { return around.has(centre); }));
    const bool is_some = outside >= kFewest && outside <= std::min(kMostSplats, centres.size() / kMostShare);
    return is_some ? std::optional(around) : std::nullopt;
}

}  // namespace binosplat
