// Joins blocks into a scene, and notes anything unusual about them.
#include "engine/files/scene_builder.h"

#include "engine/error.h"
#include "engine/platform.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace binosplat {

namespace {

// Memory for `count` entries, in large pages if the system has them: small ones take a third of the loading
// time.
template <typename T>
void reserveLarge(std::vector<T>& values, std::size_t count) {
    values.reserve(count);
    preferLargePages(values.data(), count * sizeof(T));
}

}  // namespace

SceneBuilder::SceneBuilder(std::string name, std::uint64_t splats, int sh_degree, bool three_scales) {
    scene_.name = std::move(name);
    notes_.splats_in_file = splats;
    notes_.sh_degree_in_file = sh_degree;
    notes_.three_scales = three_scales;
    // Reserved but not filled: pages of SH bands that turn out to be zero are never touched.
    const std::size_t sh_count = 3 * static_cast<std::size_t>(shCoefficientCount(sh_degree));
    try {
        reserveLarge(scene_.positions, splats);
        reserveLarge(scene_.rotations, splats);
        reserveLarge(scene_.scales, splats);
        reserveLarge(scene_.opacities, splats);
        reserveLarge(scene_.sh, splats * sh_count);
        if (three_scales) { reserveLarge(scene_.thicknesses, splats); }
    } catch (const std::exception&) {
        fail("{}: {} splats need {} MiB of memory, more than this machine gives", scene_.name, splats,
             splats * (10 + (three_scales ? 1 : 0) + sh_count) * sizeof(float) >> 20);
    }
}

void SceneBuilder::expect(const StoredBlock& some) {
    activate(some, active_);
    if (active_.sh_degree > scene_.sh_degree) { growShTo(active_.sh_degree); }
}

void SceneBuilder::append(const StoredBlock& block) {
    activate(block, active_);
    append(block, active_);
}

void SceneBuilder::activate(const StoredBlock& block, ActiveBlock& active) const {
    binosplat::activate(block, notes_.sh_degree_in_file, notes_.three_scales, active);
}

void SceneBuilder::append(const StoredBlock& block, const ActiveBlock& active) {
    const auto appendTo = [&](auto& values, const auto& kept) {
        values.insert(values.end(), kept.data(), kept.data() + active.count);
    };
    appendTo(scene_.positions, active.positions);
    appendTo(scene_.rotations, active.rotations);
    appendTo(scene_.scales, active.scales);
    appendTo(scene_.opacities, active.opacities);
    if (notes_.three_scales) { appendTo(scene_.thicknesses, active.thicknesses); }
    notes_.skipped_not_finite += active.skipped_not_finite;
    notes_.skipped_zero_rotation += active.skipped_zero_rotation;
    appendSh(block, active);
}

namespace {

// A splat's coefficients in the scene's order: by coefficient, with channels together. The file has `in_file`
// per channel.
template <int kCoefficients>
void gatherSh(const StoredBlock& block, std::size_t row, int in_file, float* target) {
    const float* rest = block.rest(row);
    for (int channel = 0; channel < 3; ++channel) {
        target[channel] = block.column(kStoredDc0 + channel)[row];
        for (int k = 1; k < kCoefficients; ++k) {
            target[3 * k + channel] = rest[channel * (in_file - 1) + k - 1];
        }
    }
}

}  // namespace

void SceneBuilder::appendSh(const StoredBlock& block, const ActiveBlock& active) {
    // The highest band that a kept splat uses determines the width of rows from here on.
    if (active.sh_degree > scene_.sh_degree) { growShTo(active.sh_degree); }
    constexpr std::array gathers{gatherSh<1>, gatherSh<4>, gatherSh<9>, gatherSh<16>};
    const auto gather = gathers[static_cast<std::size_t>(scene_.sh_degree)];
    const int in_file = shCoefficientCount(notes_.sh_degree_in_file);
    const auto width = static_cast<std::size_t>(3 * shCoefficientCount(scene_.sh_degree));
    // Row by row through a small array, since growing the vector first would write everything twice.
    std::array<float, 48> splat{};
    for (std::size_t i = 0; i < active.count; ++i) {
        gather(block, active.source[i], in_file, splat.data());
        scene_.sh.insert(scene_.sh.end(), splat.data(), splat.data() + width);
    }
}

// Widens the rows already stored, last first, so that each moves into free space or onto itself.
void SceneBuilder::growShTo(int sh_degree) {
    const auto old_width = static_cast<std::size_t>(3 * shCoefficientCount(scene_.sh_degree));
    const auto new_width = static_cast<std::size_t>(3 * shCoefficientCount(sh_degree));
    const std::size_t rows = scene_.sh.size() / old_width;
    scene_.sh.resize(rows * new_width);
    for (std::size_t row = rows; row-- > 0;) {
        float* target = scene_.sh.data() + row * new_width;
        std::memmove(target, scene_.sh.data() + row * old_width, old_width * sizeof(float));
        std::fill(target + old_width, target + new_width, 0.0f);
    }
    scene_.sh_degree = sh_degree;
}

// From at most a hundred thousand splats, evenly picked, which is enough for a median.
void SceneBuilder::measureFlatness() {
    const std::size_t step = scene_.size() / 100'000 + 1;
    std::vector<float> flatness;
    for (std::size_t i = 0; i < scene_.size(); i += step) {
        const float second = std::min(scene_.scales[i].x, scene_.scales[i].y);
        flatness.push_back(second > 0.0f ? scene_.thicknesses[i] / second : 1.0f);
    }
    if (flatness.empty()) { return; }
    const auto middle = flatness.begin() + static_cast<std::ptrdiff_t>(flatness.size() / 2);
    std::nth_element(flatness.begin(), middle, flatness.end());
    notes_.median_flatness = static_cast<double>(*middle);
}

Scene SceneBuilder::finish(LoadNotes& notes) {
    if (notes_.three_scales) { measureFlatness(); }
    if (notes_.skipped_not_finite > 0) {
        notes_.lines.push_back(fmt::format("{}: {} of {} splats skipped: NaN or infinity in an attribute",
                                           scene_.name, notes_.skipped_not_finite, notes_.splats_in_file));
    }
    if (notes_.skipped_zero_rotation > 0) {
        notes_.lines.push_back(fmt::format("{}: {} of {} splats skipped: rotation of length zero",
                                           scene_.name, notes_.skipped_zero_rotation, notes_.splats_in_file));
    }
    if (scene_.sh_degree < notes_.sh_degree_in_file) {
        notes_.lines.push_back(fmt::format(
            "{}: SH bands above degree {} are all zero and were left out (the file has degree {})",
            scene_.name, scene_.sh_degree, notes_.sh_degree_in_file));
    }
    scene_.sh.shrink_to_fit();
    notes = std::move(notes_);
    return std::move(scene_);
}

double originAbout(double middle) { return std::abs(middle) >= 1e4 ? std::round(middle) : 0.0; }

void setOrigin(Scene& scene, const glm::dvec3& origin, LoadNotes& notes) {
    scene.origin = origin;
    if (origin == glm::dvec3(0.0)) { return; }
    notes.lines.push_back(
        fmt::format("{}: its positions are far from 0: in memory, as float32, they count from {}", scene.name,
                    describeOrigin(scene)));
}

void takeAsDiscs(Scene& scene, LoadNotes& notes) {
    scene.thicknesses = {};
    scene.antialiased = false;
    notes.three_scales = false;
    notes.median_flatness = 0.0;
}

}  // namespace binosplat
