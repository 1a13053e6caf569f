// The header of a PLY file: its elements and properties, and their encoding.
#pragma once

#include "engine/files/input_file.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace binosplat::ply {

enum class Encoding { kAscii, kLittleEndian, kBigEndian };

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };
std::size_t typeBytes(Type type);

struct Property {
    std::string name;
    Type type = Type::kFloat32;
    bool is_list = false;
    Type count_type = Type::kUint8;  // for a list
};

struct Element {
    std::string name;
    std::uint64_t count = 0;
    std::vector<Property> properties;

    [[nodiscard]] bool hasList() const;
    [[nodiscard]] std::size_t rowBytes() const;  // binary size of one row, if it has no list
};

struct Header {
    Encoding encoding = Encoding::kLittleEndian;
    std::vector<Element> elements;
    int line_count = 0;
    // From a comment: "SplatRenderMode: mip" (Brush, gsplat), "antialiased 1" or "postshot.anti_aliasing=1"
    // (Postshot); the last one counts.
    bool antialiased = false;
    // 0 or 2, from a comment: "Vertical axis: z". "y" says nothing: Brush writes it into every file
    int vertical_axis = -1;
};

// Reads up to and including the end_header line. Throws Error naming the line at fault.
Header readHeader(InputFile& file);

}  // namespace binosplat::ply
