// Activations, skipped splats, the order of axes, and the SH bands in use.
#include "engine/files/stored_block.h"

#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binosplat {

namespace {

// Any finite number whose exponential is too large for float32.
constexpr float kFarLogarithm = 1000.0f;

// Finds the rows that contain only meaningful numbers: v * 0 is 0 for a finite v and NaN otherwise, and a sum
// keeps a NaN. Two infinities have a meaning, and are replaced by finite numbers first: a logit of +infinity
// is opacity 1; -infinity, the logarithm of length 0, is a third axis without extent. If that is not the
// shortest axis, this is noticed later.
std::array<bool, StoredBlock::kRows> findFiniteRows(const StoredBlock& block, bool three_scales) {
    std::array<float, StoredBlock::kRows> zeros{};
    for (int attribute = 0; attribute < kStoredRest0; ++attribute) {
        if (attribute == kStoredScale2 && !three_scales) { continue; }
        const bool is_scale = attribute >= kStoredScale0 && attribute <= kStoredScale2;
        const float least =
                        three_scales && is_scale ? -kFarLogarithm : -std::numeric_limits<float>::infinity(),
                    most =
                        attribute == kStoredOpacity ? kFarLogarithm : std::numeric_limits<float>::infinity();
        const float* column = block.column(attribute);
        // The value comes first, so that a NaN stays one.
        for (std::size_t row = 0; row < block.rows; ++row) {
            zeros[row] += std::min(std::max(column[row], least), most) * 0.0f;
        }
    }
    std::array<bool, StoredBlock::kRows> finite{};
    for (std::size_t row = 0; row < block.rows; ++row) {
        std::array<float, 16> of_rest{};  // side by side, as a compiler can add them
        const float* rest = block.rest(row);
        for (std::size_t first = 0; first < StoredBlock::kRestStride; first += of_rest.size()) {
            for (std::size_t i = 0; i < of_rest.size(); ++i) { of_rest[i] += rest[first + i] * 0.0f; }
        }
        for (std::size_t half = of_rest.size() / 2; half > 0; half /= 2) {
            for (std::size_t i = 0; i < half; ++i) { of_rest[i] += of_rest[half + i]; }
        }
        finite[row] = zeros[row] + of_rest[0] == 0.0f;
    }
    return finite;
}

// The unit quaternion along (w, x, y, z), in float64 so that neither tiny nor huge lengths are lost; false
// for length zero.
bool normaliseRotation(double w, double x, double y, double z, glm::dquat& unit) {
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    if (!(length > 0.0)) { return false; }
    unit.w = w / length;
    unit.x = x / length;
    unit.y = y / length;
    unit.z = z / length;
    return true;
}

struct Turned {
    glm::dquat rotation;
    float log_scale_u, log_scale_v, log_scale_w;
};

// Makes the shortest of three axes the last. The two others follow it in cyclic order, so (t_u, t_v, t_w) is
// a cyclic permutation of the columns of the rotation: right-handed, with t_w along the shortest axis. Such a
// permutation is a turn by 120 degrees about (1, 1, 1), hence the product with (1/2, +-1/2, +-1/2, +-1/2).
Turned turnShortestLast(const glm::dquat& rotation, const std::array<float, 3>& log_scales) {
    std::size_t shortest = 2;  // ties keep the file's order
    for (const std::size_t axis : {std::size_t{1}, std::size_t{0}}) {
        if (log_scales[axis] < log_scales[shortest]) { shortest = axis; }
    }
    const float u = log_scales[(shortest + 1) % 3], v = log_scales[(shortest + 2) % 3];
    glm::dquat turn = glm::identity<glm::dquat>();
    if (shortest != 2) {
        const double sign = shortest == 0 ? 1.0 : -1.0;
        turn.w = 0.5;
        turn.x = turn.y = turn.z = sign * 0.5;
    }
    return {rotation * turn, u, v, log_scales[shortest]};
}

// The highest band with a non-zero value, over the rows that are kept.
int findUsedDegree(const StoredBlock& block, const ActiveBlock& active, int sh_degree) {
    const int per_channel = shCoefficientCount(sh_degree) - 1;
    // Sums of magnitudes, finite or infinite: 0 if all are 0.
    std::array<float, StoredBlock::kRestStride> seen{};
    for (std::size_t i = 0; i < active.count; ++i) {
        const float* rest = block.rest(active.source[i]);
        for (std::size_t k = 0; k < seen.size(); ++k) { seen[k] += std::abs(rest[k]); }
    }
    int used = 0;
    for (int channel = 0; channel < 3; ++channel) {
        for (int k = 1; k <= per_channel; ++k) {
            while (seen[static_cast<std::size_t>(channel * per_channel + k - 1)] > 0.0f &&
                   shCoefficientCount(used) <= k) {
                ++used;
            }
        }
    }
    return used;
}

}  // namespace

float medianOf(const StoredBlock& block, int attribute) {
    std::vector<float> values;
    for (std::size_t row = 0; row < block.rows; ++row) {
        if (const float value = block.get(attribute, row); std::isfinite(value)) { values.push_back(value); }
    }
    if (values.empty()) { return 0.0f; }
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::ranges::nth_element(values, middle);
    return *middle;
}

void activate(const StoredBlock& block, int sh_degree, bool three_scales, ActiveBlock& active) {
    const std::array<bool, StoredBlock::kRows> finite = findFiniteRows(block, three_scales);
    active.count = active.skipped_not_finite = active.skipped_zero_rotation = 0;
    for (std::size_t row = 0; row < block.rows; ++row) {
        const auto value = [&](int attribute) { return block.column(attribute)[row]; };
        glm::vec2 scale(0.0f);
        if (finite[row]) { scale = {std::exp(value(kStoredScale0)), std::exp(value(kStoredScale1))}; }
        glm::dquat rotation = glm::identity<glm::dquat>();
        const bool turned =
            finite[row] && normaliseRotation(value(kStoredRot0), value(kStoredRot1), value(kStoredRot2),
                                             value(kStoredRot3), rotation);
        float thickness = 0.0f;
        bool usable = finite[row];
        if (turned && three_scales) {
            const Turned axes = turnShortestLast(
                rotation, {value(kStoredScale0), value(kStoredScale1), value(kStoredScale2)});
            rotation = axes.rotation;
            scale = {std::exp(axes.log_scale_u), std::exp(axes.log_scale_v)};
            thickness = std::exp(axes.log_scale_w);
            usable = std::isfinite(axes.log_scale_u + axes.log_scale_v);
        }
        // A logarithm over 88.7 gives an infinite float32 scale.
        if (!usable || !std::isfinite(scale.x + scale.y)) {
            ++active.skipped_not_finite;
            continue;
        }
        if (!turned) {
            ++active.skipped_zero_rotation;
            continue;
        }
        const std::size_t i = active.count++;
        active.source[i] = static_cast<std::uint16_t>(row);
        active.positions[i] = {value(kStoredX), value(kStoredY), value(kStoredZ)};
        active.rotations[i] = glm::quat(rotation);
        active.scales[i] = scale;
        active.opacities[i] = 1.0f / (1.0f + std::exp(-value(kStoredOpacity)));
        active.thicknesses[i] = thickness;
    }
    active.sh_degree = findUsedDegree(block, active, sh_degree);
}

}  // namespace binosplat
