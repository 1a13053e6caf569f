// Ward's criterion over neighbours along a curve; moments of pairs.
#include "engine/levels/merge.h"

#include "engine/files/sog_pack.h"
#include "engine/scene/pick_splats.h"
#include "engine/scene/sh_basis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

namespace binosplat {

namespace {

// Neighbours are looked for this far along the curve.
constexpr std::size_t kWindow = 12;
// How much the square of a distance (in terms of the area that both cover), that of a distance across the
// surface, and a turn of the normal count next to the squared difference of colours.
constexpr float kDistance = 0.1f, kAcross = 3.0f, kNormals = 0.2f;
// Of the merges that are still needed, this part is done before pairs are looked for again, but at least
// a 16th of all splats.
constexpr std::uint64_t kPartOfRound = 2, kLeastOfRound = 16;
constexpr float kMostCost = 1e38f;

struct Moments {
    glm::dvec3 mean{0.0};
    glm::dmat3 covariance{0.0};
};

Moments momentsOf(const Scene& scene, std::uint32_t splat) {
    const glm::dmat3 axes = glm::mat3_cast(glm::dquat(scene.rotations[splat]));
    const glm::dvec3 scales(scene.scales[splat], scene.isGaussian3d() ? scene.thicknesses[splat] : 0.0f);
    Moments moments{glm::dvec3(scene.positions[splat])};
    for (int i = 0; i < 3; ++i) {
        moments.covariance += scales[i] * scales[i] * glm::outerProduct(axes[i], axes[i]);
    }
    return moments;
}

Moments mix(const Moments& a, const Moments& b, double share_of_b) {
    const glm::dvec3 apart = b.mean - a.mean;
    return {a.mean + share_of_b * apart,
            (1.0 - share_of_b) * a.covariance + share_of_b * b.covariance +
                share_of_b * (1.0 - share_of_b) * glm::outerProduct(apart, apart)};
}

struct Principal {
    glm::dvec3 variances;  // the largest first
    glm::dmat3 axes;       // right-handed
};

// Jacobi's method.
Principal principalOf(glm::dmat3 m) {
    glm::dmat3 axes(1.0);
    for (int sweep = 0; sweep < 12; ++sweep) {
        for (const auto& [p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
            if (std::abs(m[p][q]) <= 1e-15 * (std::abs(m[p][p]) + std::abs(m[q][q]))) { continue; }
            const double theta = 0.5 * (m[q][q] - m[p][p]) / m[p][q];
            const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(theta * theta + 1.0));
            const double c = 1.0 / std::sqrt(t * t + 1.0), s = t * c;
            glm::dmat3 turn(1.0);
            turn[p][p] = turn[q][q] = c;
            turn[q][p] = s, turn[p][q] = -s;
            m = glm::transpose(turn) * m * turn;
            axes = axes * turn;
        }
    }
    std::array<int, 3> order{0, 1, 2};
    std::ranges::sort(order, [&](int a, int b) { return std::pair(-m[a][a], a) < std::pair(-m[b][b], b); });
    Principal found;
    for (int i = 0; i < 3; ++i) {
        const int from = order.at(static_cast<std::size_t>(i));
        found.variances[i] = std::max(m[from][from], 0.0);
        found.axes[i] = glm::normalize(axes[from]);
    }
    found.axes[2] = glm::cross(found.axes[0], found.axes[1]);
    return found;
}

// What a splat covers, seen face on.
double areaOf(const Scene& scene, std::uint32_t splat) {
    const glm::dvec2 scales(scene.scales[splat]);
    return 2.0 * std::numbers::pi * scales.x * scales.y * static_cast<double>(scene.opacities[splat]);
}

}  // namespace

bool SplatMerger::Pair::operator<(const Pair& other) const {
    return std::tie(cost, first, second) < std::tie(other.cost, other.first, other.second);
}

SplatMerger::SplatMerger(Scene scene, std::span<const std::int64_t> weights)
    : scene_(std::move(scene)), weights_(scene_.size()) {
    for (std::size_t i = 0; i < weights_.size(); ++i) {
        weights_[i] = std::max(static_cast<float>(weights[i]), 1.0f);
    }
}

// The squared error if both look like their mean: in colour, and, as far as places and directions matter as
// much as colours do, in these.
float SplatMerger::costOf(const Place& a, const Place& b) {
    const glm::vec3 apart = b.position - a.position, colours = b.colour - a.colour;
    const float off_a = a.flatness * glm::dot(apart, a.normal),
                off_b = b.flatness * glm::dot(apart, b.normal);
    const float turned = a.flatness * b.flatness * (1.0f - std::abs(glm::dot(a.normal, b.normal)));
    const float distance = glm::dot(apart, apart) + kAcross * (off_a * off_a + off_b * off_b);
    const float square =
        glm::dot(colours, colours) + kDistance * distance / (a.area + b.area + 1e-30f) + kNormals * turned;
    const float cost = a.weight * b.weight / (a.weight + b.weight) * square;
    return cost < kMostCost ? cost : kMostCost;  // also if it is not a number
}

std::vector<SplatMerger::Place> SplatMerger::placesAlongCurve(bool shifted) const {
    Scene centres;
    centres.positions = scene_.positions;
    if (shifted) {
        // One more, far outside, so that the curve's cells lie elsewhere.
        glm::vec3 low = centres.positions[0], high = low;
        for (const glm::vec3& position : centres.positions) {
            low = glm::min(low, position);
            high = glm::max(high, position);
        }
        centres.positions.push_back(low - 0.37f * (high - low));
    }
    const auto width = static_cast<std::size_t>(3 * shCoefficientCount(scene_.sh_degree));
    const auto constant_band = static_cast<float>(shBasis({0.0, 0.0, 1.0})[0]);
    std::vector<Place> places;
    places.reserve(scene_.size());
    for (const std::uint32_t splat : mortonOrder(findSogPlaces(centres))) {
        if (splat == scene_.size()) { continue; }
        const glm::vec2 scales = scene_.scales[splat];
        const float* const sh = scene_.sh.data() + splat * width;
        places.push_back(
            {scene_.positions[splat], glm::mat3_cast(scene_.rotations[splat])[2],
             constant_band * glm::vec3(sh[0], sh[1], sh[2]),
             scene_.isGaussian3d()
                 ? 1.0f - std::min(scene_.thicknesses[splat] / std::min(scales.x, scales.y), 1.0f)
                 : 1.0f,
             static_cast<float>(areaOf(scene_, splat)), weights_[splat], splat});
    }
    return places;
}

std::vector<SplatMerger::Pair> SplatMerger::cheapestPairs() const {
    const std::vector<Place> places = placesAlongCurve(round_ % 2 == 1);
    std::vector<std::pair<float, std::uint32_t>> best(places.size(), {2.0f * kMostCost, 0});  // and which
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        const auto end = static_cast<std::uint32_t>(std::min(places.size(), i + 1 + kWindow));
        for (std::uint32_t j = i + 1; j < end; ++j) {
            const float cost = costOf(places[i], places[j]);
            if (cost < best[i].first) { best[i] = {cost, j}; }
            if (cost < best[j].first) { best[j] = {cost, i}; }
        }
    }
    std::vector<Pair> pairs;
    pairs.reserve(places.size());
    for (std::uint32_t i = 0; i < places.size(); ++i) {
        const auto [cost, j] = best[i];
        if (best[j].second == i && j < i) { continue; }
        const auto [first, second] = std::minmax(places[i].splat, places[j].splat);
        pairs.push_back({cost, first, second});
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

void SplatMerger::mergeColours(std::uint32_t into, std::uint32_t other, double share) {
    const auto width = static_cast<std::size_t>(3 * shCoefficientCount(scene_.sh_degree));
    const auto part = static_cast<float>(share);
    for (std::size_t k = 0; k < width; ++k) {
        float& value = scene_.sh[into * width + k];
        value += part * (scene_.sh[other * width + k] - value);
    }
}

// What both cover stays covered, as far as they do not cover the same.
void SplatMerger::merge(std::uint32_t into, std::uint32_t other) {
    const double weight_a = weights_[into], weight_b = weights_[other],
                 share = weight_b / (weight_a + weight_b);
    const Moments a = momentsOf(scene_, into), b = momentsOf(scene_, other);
    const double area_a = areaOf(scene_, into), area_b = areaOf(scene_, other);
    const Principal found = principalOf(mix(a, b, share).covariance);
    const Principal usual = principalOf(0.5 * (a.covariance + b.covariance));
    double apart = 0.0;
    for (int i = 0; i < 2; ++i) {
        const double along = glm::dot(b.mean - a.mean, usual.axes[i]);
        apart += along * along / std::max(usual.variances[i], 1e-30);
    }
    const double new_part = std::min(1.0, apart);
    const double area = std::max(area_a, area_b) + new_part * std::min(area_a, area_b);
    const double opacity_a = scene_.opacities[into], opacity_b = scene_.opacities[other];
    const double both = 1.0 - (1.0 - opacity_a) * (1.0 - opacity_b);
    const double densest = new_part * std::max(opacity_a, opacity_b) + (1.0 - new_part) * both;
    glm::dvec3 scales = glm::sqrt(found.variances);
    const double own = 2.0 * std::numbers::pi * scales.x * scales.y;
    const double least = kFaintest, most = std::max(least, std::min(densest, static_cast<double>(kDensest)));
    const double opacity = std::clamp(area / std::max(own, 1e-30), least, most);
    scales *= std::max(1.0, std::sqrt(area / std::max(own * opacity, 1e-30)));
    scene_.positions[into] = glm::vec3(a.mean + share * (b.mean - a.mean));
    scene_.rotations[into] = glm::quat(glm::normalize(glm::quat_cast(found.axes)));
    scene_.scales[into] = glm::vec2(scales);
    if (scene_.isGaussian3d()) { scene_.thicknesses[into] = static_cast<float>(scales.z); }
    scene_.opacities[into] = static_cast<float>(opacity);
    mergeColours(into, other, share);
    weights_[into] += weights_[other];
}

void SplatMerger::dropMerged(std::span<const std::uint8_t> is_merged) {
    std::vector<std::uint32_t> left;
    std::vector<float> weights;
    for (std::uint32_t i = 0; i < scene_.size(); ++i) {
        if (is_merged[i] != 0) { continue; }
        left.push_back(i);
        weights.push_back(weights_[i]);
    }
    scene_ = pickSplats(scene_, left);
    weights_ = std::move(weights);
}

void SplatMerger::reduceTo(std::uint64_t count) {
    count = std::max<std::uint64_t>(count, 1);
    while (scene_.size() > count) {
        const std::uint64_t needed = scene_.size() - count;
        std::uint64_t most = std::min(
            needed, std::max({needed / kPartOfRound, scene_.size() / kLeastOfRound, std::uint64_t{1}}));
        std::vector<std::uint8_t> is_merged(scene_.size()), is_taken(scene_.size());
        for (const Pair& pair : cheapestPairs()) {
            if (most == 0) { break; }
            if (is_taken[pair.first] != 0 || is_taken[pair.second] != 0) { continue; }
            merge(pair.first, pair.second);
            is_taken[pair.first] = is_taken[pair.second] = is_merged[pair.second] = 1;
            --most;
        }
        dropMerged(is_merged);
        ++round_;
    }
}

}  // namespace binosplat
