// What image_library.cpp offers, the library of our own that links OpenImageIO and is loaded when the first picture is written or read.
#pragma once

#include "engine/picture/image.h"

#include <filesystem>
#include <span>

namespace binosplat {

// All throw Error naming the file; a failed write leaves none. (With libstdc++ errors pass from one library to another by the name of their
// type.)
struct ImageLibrary {
    // float32, every channel as it is.
    void (*write_exr)(const std::filesystem::path& path, const Image& image);
    // 3 bytes a pixel.
    void (*write_png)(const std::filesystem::path& path, glm::uvec2 size_px, std::span<const unsigned char> rgb);
    // See readPicture.
    void (*read)(const std::filesystem::path& path, Image& image);
};

// The symbol under which the library exports its ImageLibrary.
inline constexpr const char* kImageLibrarySymbol = "binosplat_image_library";

}  // namespace binosplat
