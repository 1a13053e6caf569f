// Activations of DESIGN's "what a pixel is", block by block.
#include "engine/scene/scene_builder.h"

#include "engine/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <sys/mman.h>

namespace binosplat {

namespace {

// Which rows hold only finite numbers: v * 0 is 0 for a finite v and NaN otherwise, and a sum keeps a NaN.
std::array<bool, StoredBlock::kRows> findFiniteRows(const StoredBlock& block, int sh_degree, bool three_scales) {
    std::array<float, StoredBlock::kRows> zeros{};
    const int rest_count = 3 * (shCoefficientCount(sh_degree) - 1);
    for (int attribute = 0; attribute < kStoredRest0 + rest_count; ++attribute) {
        if (attribute == kStoredScale2 && !three_scales) { continue; }
        const float* column = block.column(attribute);
        for (std::size_t row = 0; row < block.rows; ++row) { zeros[row] += column[row] * 0.0f; }
    }
    std::array<bool, StoredBlock::kRows> finite{};
    for (std::size_t row = 0; row < block.rows; ++row) { finite[row] = zeros[row] == 0.0f; }
    return finite;
}

// The unit quaternion along (w, x, y, z), in float64 so that neither tiny nor huge lengths are lost; false for length zero.
bool normaliseRotation(double w, double x, double y, double z, glm::dquat& unit) {
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    if (!(length > 0.0)) { return false; }
    unit.w = w / length;
    unit.x = x / length;
    unit.y = y / length;
    unit.z = z / length;
    return true;
}

struct Flattened {
    glm::dquat rotation;
    float log_scale_u, log_scale_v;
    float flatness;
};

// Drops the shortest of three axes. The two others follow it in cyclic order, so (t_u, t_v, t_w) is a cyclic permutation of
// the columns of the rotation: right-handed, with t_w along the dropped axis. Such a permutation is a turn by 120 degrees about
// (1, 1, 1), hence the product with (1/2, +-1/2, +-1/2, +-1/2).
Flattened dropShortestAxis(const glm::dquat& rotation, const std::array<float, 3>& log_scales) {
    std::size_t shortest = 2;  // ties keep the order of the file
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
    return {rotation * turn, u, v, std::exp(log_scales[shortest] - std::min(u, v))};
}

// Room for `count` entries, in large pages where the system has them: small ones take a third of the time of loading.
template <typename T>
void reserveLarge(std::vector<T>& values, std::size_t count) {
    values.reserve(count);
#ifdef MADV_HUGEPAGE
    constexpr std::uintptr_t kPage = std::uintptr_t{1} << 21;
    const auto begin = reinterpret_cast<std::uintptr_t>(values.data()), end = begin + count * sizeof(T);
    const std::uintptr_t first = (begin + kPage - 1) / kPage * kPage, last = end / kPage * kPage;
    if (first < last) { ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE); }  // advice: failing is fine
#endif
}

}  // namespace

SceneBuilder::SceneBuilder(std::string name, std::uint64_t splats, int sh_degree, bool three_scales) {
    scene_.name = std::move(name);
    notes_.splats_in_file = splats;
    notes_.sh_degree_in_file = sh_degree;
    notes_.three_scales = three_scales;
    // Reserved, not filled: pages of SH bands that turn out to be zero are never touched.
    const std::size_t sh_count = 3 * static_cast<std::size_t>(shCoefficientCount(sh_degree));
    try {
        reserveLarge(scene_.positions, splats);
        reserveLarge(scene_.rotations, splats);
        reserveLarge(scene_.scales, splats);
        reserveLarge(scene_.opacities, splats);
        reserveLarge(scene_.sh, splats * sh_count);
        if (three_scales) { flatness_.reserve(splats); }
    } catch (const std::exception&) {
        fail("{}: {} splats need {} MiB of memory, more than this machine gives", scene_.name, splats,
             splats * (10 + sh_count) * sizeof(float) >> 20);
    }
}

void SceneBuilder::append(const StoredBlock& block) {
    std::array<bool, StoredBlock::kRows> kept = findFiniteRows(block, notes_.sh_degree_in_file, notes_.three_scales);
    const std::size_t first_new = scene_.size();
    for (std::size_t row = 0; row < block.rows; ++row) {
        const auto value = [&](int attribute) { return block.column(attribute)[row]; };
        glm::vec2 scale(0.0f);
        if (kept[row]) { scale = {std::exp(value(kStoredScale0)), std::exp(value(kStoredScale1))}; }
        glm::dquat rotation = glm::identity<glm::dquat>();
        const bool turned =
            kept[row] && normaliseRotation(value(kStoredRot0), value(kStoredRot1), value(kStoredRot2), value(kStoredRot3), rotation);
        float flatness = 0.0f;
        if (turned && notes_.three_scales) {
            const Flattened flat = dropShortestAxis(rotation, {value(kStoredScale0), value(kStoredScale1), value(kStoredScale2)});
            rotation = flat.rotation;
            scale = {std::exp(flat.log_scale_u), std::exp(flat.log_scale_v)};
            flatness = flat.flatness;
        }
        if (!kept[row] || !std::isfinite(scale.x + scale.y)) {  // a logarithm over 88.7 is an infinite float32 scale
            kept[row] = false;
            ++notes_.skipped_not_finite;
            continue;
        }
        if (!turned) {
            kept[row] = false;
            ++notes_.skipped_zero_rotation;
            continue;
        }
        scene_.positions.emplace_back(value(kStoredX), value(kStoredY), value(kStoredZ));
        scene_.rotations.emplace_back(rotation);
        scene_.scales.push_back(scale);
        scene_.opacities.push_back(1.0f / (1.0f + std::exp(-value(kStoredOpacity))));
        if (notes_.three_scales) { flatness_.push_back(flatness); }
    }
    appendSh(block, kept, first_new);
}

void SceneBuilder::appendSh(const StoredBlock& block, const std::array<bool, StoredBlock::kRows>& kept, std::size_t first_new) {
    // The highest band any kept splat uses decides how wide the rows are from here on.
    const int file_coefficients = shCoefficientCount(notes_.sh_degree_in_file);
    int used_degree = scene_.sh_degree;
    for (int k = shCoefficientCount(used_degree); k < file_coefficients; ++k) {
        bool any = false;
        for (int channel = 0; channel < 3; ++channel) {
            const float* column = block.column(kStoredRest0 + channel * (file_coefficients - 1) + k - 1);
            for (std::size_t row = 0; row < block.rows; ++row) { any |= kept[row] && column[row] != 0.0f; }
        }
        while (any && shCoefficientCount(used_degree) <= k) { ++used_degree; }
    }
    if (used_degree > scene_.sh_degree) { growShTo(used_degree); }

    const int coefficients = shCoefficientCount(scene_.sh_degree);
    std::array<const float*, 48> sources{};  // in the scene's order: coefficient by coefficient, channels together
    for (int k = 0; k < coefficients; ++k) {
        for (int channel = 0; channel < 3; ++channel) {
            const int attribute = k == 0 ? kStoredDc0 + channel : kStoredRest0 + channel * (file_coefficients - 1) + k - 1;
            sources[static_cast<std::size_t>(3 * k + channel)] = block.column(attribute);
        }
    }
    const auto width = static_cast<std::size_t>(3 * coefficients);
    scene_.sh.resize(scene_.size() * width);
    float* target = scene_.sh.data() + first_new * width;
    for (std::size_t row = 0; row < block.rows; ++row) {
        if (!kept[row]) { continue; }
        for (std::size_t i = 0; i < width; ++i) { *target++ = sources[i][row]; }
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

Scene SceneBuilder::finish(LoadNotes& notes) {
    if (notes_.three_scales) {
        if (!flatness_.empty()) {
            const auto middle = flatness_.begin() + static_cast<std::ptrdiff_t>(flatness_.size() / 2);
            std::nth_element(flatness_.begin(), middle, flatness_.end());
            notes_.median_flatness = *middle;
        }
        notes_.lines.push_back(
            fmt::format("{}: three scales per splat (3DGS): the shortest axis of each was dropped; the median splat is {:.2f} times as "
                        "thick as its second axis, "
                        "so surfaces may show a little more translucent than as trained",
                        scene_.name, notes_.median_flatness));
        flatness_ = {};
    }
    if (notes_.skipped_not_finite > 0) {
        notes_.lines.push_back(fmt::format("{}: {} of {} splats skipped: NaN or infinity in an attribute", scene_.name,
                                           notes_.skipped_not_finite, notes_.splats_in_file));
    }
    if (notes_.skipped_zero_rotation > 0) {
        notes_.lines.push_back(fmt::format("{}: {} of {} splats skipped: rotation of length zero", scene_.name,
                                           notes_.skipped_zero_rotation, notes_.splats_in_file));
    }
    if (scene_.sh_degree < notes_.sh_degree_in_file) {
        notes_.lines.push_back(fmt::format("{}: SH bands above degree {} are all zero and were left out (the file has degree {})",
                                           scene_.name, scene_.sh_degree, notes_.sh_degree_in_file));
    }
    scene_.sh.shrink_to_fit();
    notes = std::move(notes_);
    return std::move(scene_);
}

}  // namespace binosplat
