// Small scenes in every format, to be broken.
#pragma once

#include "tests/engine/scene/ply_files.h"
#include "tests/engine/scene/spz_files.h"

namespace binosplat::test {

// Four splats in one chunk, with SH.
inline std::string makeCompressedPly() {
    PlyText ply;
    ply.header_before = "element chunk 1\n";
    for (const char* end : {"min", "max"}) {
        for (const char* axis : {"x", "y", "z", "scale_x", "scale_y", "scale_z", "r", "g", "b"}) {
            ply.header_before += fmt::format("property float {}_{}\n", end, axis);
            appendTyped(ply.data_before, "float", end[1] == 'i' ? -2.0 : 1.0, Encoding::kLittle);
        }
    }
    for (const char* name : {"packed_position", "packed_rotation", "packed_scale", "packed_color"}) {
        ply.columns.push_back({name, "uint", {0.0, 4294967295.0, 2863311530.0, 305419896.0}});
    }
    ply.header_after = "element sh 4\n";
    for (int i = 0; i < 9; ++i) { ply.header_after += fmt::format("property uchar f_rest_{}\n", i); }
    ply.data_after = std::string(36, '\x55');
    return ply.bytes();
}

inline std::string makeSplatFile() {
    std::string bytes;
    for (int i = 0; i < 6; ++i) {
        for (const double value : {1.0 * i, -2.0, 0.5, 0.1, 0.2, 0.01}) { appendTyped(bytes, "float", value, Encoding::kLittle); }
        bytes += std::string("\x10\x80\xf0\xff\x80\xff\x80\x80", 8);
    }
    return bytes;
}

}  // namespace binosplat::test
