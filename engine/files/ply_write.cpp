// Writes PLY: inverse activations into blocks.
#include "engine/error.h"
#include "engine/files/ply.h"
#include "engine/files/quantized.h"
#include "engine/part_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>

namespace binosplat {

namespace {

bool isFar(const Scene& scene) { return scene.origin != glm::dvec3(0.0); }

// As two float32 with the same bytes, the lower half first.
std::array<float, 2> halvesOf(double value) {
    const auto bits = std::bit_cast<std::uint64_t>(value);
    return {std::bit_cast<float>(static_cast<std::uint32_t>(bits)),
            std::bit_cast<float>(static_cast<std::uint32_t>(bits >> 32))};
}

std::string makeHeader(const Scene& scene) {
    std::string header = fmt::format("ply\nformat binary_little_endian 1.0\n{}{}element vertex {}\n",
                                     scene.antialiased ? "comment SplatRenderMode: mip\n" : "",
                                     scene.vertical_axis == 0   ? "comment Vertical axis: x\n"
                                     : scene.vertical_axis == 2 ? "comment Vertical axis: z\n"
                                                                : "",
                                     scene.size());
    const auto property = [&header](const std::string& name) { header += "property float " + name + "\n"; };
    for (const char* name : {"x", "y", "z"}) {
        header += fmt::format("property {} {}\n", isFar(scene) ? "double" : "float", name);
    }
    for (const char* name : {"nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2"}) { property(name); }
    for (int i = 0; i < 3 * (shCoefficientCount(scene.sh_degree) - 1); ++i) {
        property(fmt::format("f_rest_{}", i));
    }
    for (const char* name : {"opacity", "scale_0", "scale_1"}) { property(name); }
    if (scene.isGaussian3d()) { property("scale_2"); }
    for (const char* name : {"rot_0", "rot_1", "rot_2", "rot_3"}) { property(name); }
    return header + "end_header\n";
}

// Appends one splat's row; returns the end of it.
float* putRow(const Scene& scene, std::size_t splat, float* row) {
    const auto put = [&row](std::initializer_list<float> values) {
        row = std::copy(values.begin(), values.end(), row);
    };
    const glm::vec3& p = scene.positions[splat];
    const glm::quat& q = scene.rotations[splat];
    const glm::vec3 normal = q * glm::vec3(0.0f, 0.0f, 1.0f);
    const auto coefficients = static_cast<std::size_t>(shCoefficientCount(scene.sh_degree));
    const float* sh = scene.sh.data() + splat * coefficients * 3;
    for (int axis = 0; axis < 3; ++axis) {
        if (isFar(scene)) {
            const std::array<float, 2> halves = halvesOf(scene.origin[axis] + static_cast<double>(p[axis]));
            put({halves[0], halves[1]});
        } else {
            put({p[axis]});
        }
    }
    put({normal.x, normal.y, normal.z, sh[0], sh[1], sh[2]});
    for (std::size_t channel = 0; channel < 3; ++channel) {
        for (std::size_t k = 1; k < coefficients; ++k) { *row++ = sh[3 * k + channel]; }
    }
    put({storedOpacity(scene.opacities[splat]), storedScale(scene.scales[splat].x),
         storedScale(scene.scales[splat].y)});
    if (scene.isGaussian3d()) { put({storedScale(scene.thicknesses[splat])}); }
    put({q.w, q.x, q.y, q.z});
    return row;
}

}  // namespace

void writePly(const Scene& scene, const std::string& path, const Progress& progress) {
    check(!scene.is_linear,
          "{}: cannot hold colours of linear light ({}), must be written from a display-encoded scene", path,
          scene.name);
    PartFile file(path);
    const std::string header = makeHeader(scene);
    file.write(header.data(), header.size());

    constexpr std::size_t kBlockRows = 4096;
    const std::size_t width = (scene.isGaussian3d() ? 17 : 16) + (isFar(scene) ? 3 : 0) +
                              3 * (static_cast<std::size_t>(shCoefficientCount(scene.sh_degree)) - 1);
    std::vector<float> rows(kBlockRows * width);
    for (std::size_t done = 0; done < scene.size();) {
        if (progress) { progress(static_cast<double>(done) / static_cast<double>(scene.size())); }
        const std::size_t end = std::min(scene.size(), done + kBlockRows);
        float* row = rows.data();
        for (; done < end; ++done) { row = putRow(scene, done, row); }
        const auto count = static_cast<std::size_t>(row - rows.data());
        if constexpr (std::endian::native == std::endian::big) {
            for (float& value : rows) {
                auto bytes = std::bit_cast<std::array<std::byte, 4>>(value);
                std::reverse(bytes.begin(), bytes.end());
                value = std::bit_cast<float>(bytes);
            }
        }
        file.write(rows.data(), count * sizeof(float));
    }
    file.commit();
    if (progress) { progress(1.0); }
}

}  // namespace binosplat
