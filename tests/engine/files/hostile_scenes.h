// Small scenes in every format, to be broken.
#pragma once

#include "tests/engine/files/spz_files.h"

namespace binosplat::test {

// A compressed PLY that holds the same words `splats` times; the positions of chunk i go from i to i + 1 on
// x.
struct CompressedPly {
    std::size_t splats = 1;
    // Components of 0.5/1023 sqrt(2), w the largest.
    std::uint32_t position = 0, rotation = 512u << 20 | 512u << 10 | 512u;
    std::uint32_t scale = 0, colour = 0xffffffffu;
    std::vector<int> rest{};
    bool has_colour_bounds = true;

    [[nodiscard]] std::string bytes() const {
        const std::size_t chunks = (splats + 255) / 256;
        PlyText ply;
        ply.header_before = fmt::format("element chunk {}\n", chunks);
        for (const auto& [before, axes] : {std::pair("", "xyz"), {"scale_", "xyz"}, {"", "rgb"}}) {
            if (*axes == 'r' && !has_colour_bounds) { continue; }
            for (const char* end : {"min", "max"}) {
                for (int axis = 0; axis < 3; ++axis) {
                    ply.header_before += fmt::format("property float {}_{}{}\n", end, before, axes[axis]);
                }
            }
        }
        for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
            const double x = static_cast<double>(chunk);
            std::vector<double> bounds{x, -2, 4, x + 1, 2, 8, -6, -5, -4, -2, -1, 0, -0.5, 0, 0, 1.5, 1, 2};
            bounds.resize(has_colour_bounds ? 18 : 12);
            appendLittle(ply.data_before, "float", bounds);
        }
        for (const auto& [name, word] :
             {std::pair("packed_position", position), std::pair("packed_rotation", rotation),
              std::pair("packed_scale", scale), std::pair("packed_color", colour)}) {
            ply.columns.push_back({name, "uint", std::vector<double>(splats, word)});
        }
        if (rest.empty()) { return ply.bytes(); }
        ply.header_after = fmt::format("element sh {}\n", splats);
        for (std::size_t i = 0; i < rest.size(); ++i) {
            ply.header_after += fmt::format("property uchar f_rest_{}\n", i);
        }
        for (std::size_t splat = 0; splat < splats; ++splat) {
            ply.data_after.append(rest.begin(), rest.end());
        }
        return ply.bytes();
    }
};

// Four splats in one chunk, with SH.
inline std::string makeCompressedPly() {
    return CompressedPly{.splats = 4,
                         .position = 2863311530u,
                         .scale = 305419896u,
                         .colour = 0xff8040f0u,
                         .rest = std::vector<int>(9, 0x55)}
        .bytes();
}

inline std::string splatRow(const glm::vec3& position, const glm::vec3& scale,
                            const std::array<int, 8>& colour_and_rotation) {
    std::string row;
    for (const glm::vec3& values : {position, scale}) {
        appendLittle(row, "float", {values.x, values.y, values.z});
    }
    return row.append(colour_and_rotation.begin(), colour_and_rotation.end());
}

inline std::string makeSplatFile() {
    std::string bytes;
    for (int i = 0; i < 6; ++i) {
        bytes +=
            splatRow({i, -2.0f, 0.5f}, {0.1f, 0.2f, 0.01f}, {0x10, 0x80, 0xf0, 0xff, 0x80, 0xff, 0x80, 0x80});
    }
    return bytes;
}

}  // namespace binosplat::test
