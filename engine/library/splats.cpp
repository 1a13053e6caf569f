// Turns a program's arrays into a scene, as a file's would be.
#include "engine/files/scene_builder.h"
#include "engine/library/objects.h"

#include <cmath>
#include <limits>

namespace binosplat {
namespace {

class Rows {
public:
    Rows(const bsp_array& array, std::size_t floats, const char* name)
        : bytes_(reinterpret_cast<const unsigned char*>(array.values)),
          stride_(array.stride == 0 ? floats * sizeof(float) : static_cast<std::size_t>(array.stride)) {
        check(array.values != nullptr, "{} of splats are null", name);
        check(stride_ >= floats * sizeof(float) && stride_ % sizeof(float) == 0,
              "{} of splats have a stride of {} bytes, must be {} or more", name, stride_,
              floats * sizeof(float));
    }
    [[nodiscard]] const float* at(std::uint64_t row) const {
        return reinterpret_cast<const float*>(bytes_ + row * stride_);
    }

private:
    const unsigned char* bytes_;
    std::size_t stride_;
};

struct SplatRows {
    explicit SplatRows(const bsp_splats& splats)
        : positions(splats.positions, 3, "positions"),
          rotations(splats.rotations, 4, "rotations"),
          scales(splats.scales, splats.scale_count, "scales"),
          opacities(splats.opacities, 1, "opacities"),
          sh(splats.sh, 3 * static_cast<std::size_t>(shCoefficientCount(static_cast<int>(splats.sh_degree))),
             "sh") {}

    Rows positions, rotations, scales, opacities, sh;
};

void fill(StoredBlock& block, const SplatRows& rows, const bsp_splats& splats, std::uint64_t first) {
    const int coefficients = shCoefficientCount(static_cast<int>(splats.sh_degree));
    for (std::size_t row = 0; row < block.rows; ++row) {
        const std::uint64_t splat = first + row;
        for (int i = 0; i < 3; ++i) {
            block.column(kStoredX + i)[row] = rows.positions.at(splat)[i];
            block.column(kStoredDc0 + i)[row] = rows.sh.at(splat)[i];
            for (int k = 1; k < coefficients; ++k) {
                block.rest(row)[i * (coefficients - 1) + k - 1] = rows.sh.at(splat)[3 * k + i];
            }
        }
        for (int i = 0; i < 4; ++i) { block.column(kStoredRot0 + i)[row] = rows.rotations.at(splat)[i]; }
        for (int i = 0; i < static_cast<int>(splats.scale_count); ++i) {
            const float scale = rows.scales.at(splat)[i];
            block.column(kStoredScale0 + i)[row] = splats.activated != 0 ? std::log(scale) : scale;
        }
        const float opacity = rows.opacities.at(splat)[0];
        const bool is_share = opacity >= 0.0f && opacity <= 1.0f;
        block.column(kStoredOpacity)[row] = splats.activated == 0 ? opacity
                                            : is_share            ? 0.0f
                                                                  : std::numeric_limits<float>::quiet_NaN();
    }
}

// Keeps lengths and opacities as they were given, not as computed from their logarithms.
void keepActivated(ActiveBlock& active, const StoredBlock& block, const SplatRows& rows,
                   const bsp_splats& splats, std::uint64_t first) {
    for (std::size_t i = 0; i < active.count; ++i) {
        const std::uint64_t splat = first + active.source[i];
        const float* scales = rows.scales.at(splat);
        active.opacities[i] = rows.opacities.at(splat)[0];
        active.scales[i] = {scales[0], scales[1]};
        if (splats.scale_count == 2) { continue; }
        std::size_t shortest = 2;  // by the logarithms, as activate() turned the axes
        for (const std::size_t axis : {std::size_t{1}, std::size_t{0}}) {
            const auto log = [&](std::size_t a) {
                return block.column(kStoredScale0 + static_cast<int>(a))[active.source[i]];
            };
            if (log(axis) < log(shortest)) { shortest = axis; }
        }
        active.scales[i] = {scales[(shortest + 1) % 3], scales[(shortest + 2) % 3]};
        active.thicknesses[i] = scales[shortest];
    }
}

}  // namespace

Scene sceneOf(const bsp_splats& splats, LoadNotes& notes) {
    check(splats.scale_count == 2 || splats.scale_count == 3,
          "splats have {} scales, must be 2 (discs) or 3 (Gaussians)", splats.scale_count);
    check(splats.sh_degree <= kMaxShDegree, "splats have SH of degree {}, must be 0 to {}", splats.sh_degree,
          kMaxShDegree);
    check(splats.count <= gpu::kMaxItems, "there are {} splats, at most {} can be shown", splats.count,
          gpu::kMaxItems);
    const glm::dvec3 origin(splats.origin[0], splats.origin[1], splats.origin[2]);
    check(std::isfinite(origin.x + origin.y + origin.z), "origin of splats is not finite");
    const bool three_scales = splats.scale_count == 3;
    SceneBuilder builder("splats", splats.count, static_cast<int>(splats.sh_degree), three_scales);
    StoredBlock block;
    ActiveBlock active;
    for (std::uint64_t first = 0; first < splats.count; first += block.rows) {
        const SplatRows rows(splats);
        block.rows =
            static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, splats.count - first));
        fill(block, rows, splats, first);
        builder.activate(block, active);
        if (splats.activated != 0) { keepActivated(active, block, rows, splats, first); }
        builder.append(block, active);
    }
    Scene scene = builder.finish(notes);
    scene.antialiased = three_scales && splats.antialiased != 0;
    scene.origin = origin;
    return scene;
}

}  // namespace binosplat
