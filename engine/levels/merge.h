// A scene with fewer splats, each of which stands for several that were near and alike.
#pragma once

#include "engine/scene/scene.h"

#include <cstdint>
#include <span>
#include <vector>

namespace binosplat {

// The least opacity that shows, and the greatest that is still fitted.
inline constexpr float kFaintest = 1.25f / 255.0f, kDensest = 0.999f;

class SplatMerger {
public:
    // `weights`: how much each splat shows, at least 1. Where splats show little, more of them are merged.
    SplatMerger(Scene scene, std::span<const std::int64_t> weights);

    [[nodiscard]] const Scene& scene() const { return scene_; }
    // Merges pairs until at most `count` splats, at least 1, are left: cheapest first, by what the pictures
    // lose if both look like their mean. Repeatable.
    void reduceTo(std::uint64_t count);

private:
    struct Pair {
        float cost = 0.0f;
        std::uint32_t first = 0, second = 0;
        bool operator<(const Pair& other) const;
    };
    // What decides about a pair, in the order of a curve.
    struct Place {
        glm::vec3 position, normal, colour;
        float flatness = 1.0f, area = 0.0f, weight = 0.0f;
        std::uint32_t splat = 0;
    };

    [[nodiscard]] static float costOf(const Place& a, const Place& b);
    [[nodiscard]] std::vector<Place> placesAlongCurve(bool shifted) const;
    [[nodiscard]] std::vector<Pair> cheapestPairs() const;
    void merge(std::uint32_t into, std::uint32_t other);
    void mergeColours(std::uint32_t into, std::uint32_t other, double share);
    void dropMerged(std::span<const std::uint8_t> is_merged);

    Scene scene_;
    std::vector<float> weights_;
    int round_ = 0;
};

}  // namespace binosplat
