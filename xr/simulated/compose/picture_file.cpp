// PNG files through libpng's simplified interface; the only place here that knows it.
#include "xr/simulated/compose/picture_file.h"

#include "xr/simulated/system.h"

#include <fmt/format.h>
#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

namespace simulated {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& path, const char* what, std::string reason) {
    for (char& c : reason) {
        if (c == '\n') { c = ' '; }
    }
    throw std::runtime_error(path.string() + ": cannot be " + what + " (" + reason + ")");
}

// Owns libpng's memory for a picture.
struct PngImage : png_image {
    PngImage() : png_image{} { version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(this); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
};

}  // namespace

fs::path nameUnfinishedPicture(const fs::path& path) {
    return path.parent_path() / fmt::format(".{}.unfinished.png", path.stem().string());
}

void writePng(const fs::path& path, const RgbPicture& picture) {
    const fs::path unfinished = nameUnfinishedPicture(path);
    PngImage image;
    image.width = picture.size_px.x;
    image.height = picture.size_px.y;
    image.format = PNG_FORMAT_RGB;
    // Fast compression: a run writes many.
    image.flags = PNG_IMAGE_FLAG_FAST;
    // Exclusively: a file or link that is already there is somebody else's.
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(createFile(unfinished), &std::fclose);
    if (file == nullptr) { refuse(path, "written", std::strerror(errno)); }
    std::error_code error;
    std::string reason;
    if (png_image_write_to_stdio(&image, file.get(), 0, picture.bytes.data(), 0, nullptr) == 0) {
        reason = image.message;
    } else if (std::fclose(file.release()) != 0) {
        reason = std::strerror(errno);
    } else {
        fs::rename(unfinished, path, error);
        if (!error) { return; }
        reason = error.message();
    }
    fs::remove(unfinished, error);
    refuse(path, "written", reason);
}

RgbPicture readPng(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) { refuse(path, "read", std::strerror(errno)); }
    const std::string bytes(std::istreambuf_iterator<char>(file), {});
    PngImage image;
    if (png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()) == 0) {
        refuse(path, "read", image.message);
    }
    if ((image.format & PNG_FORMAT_FLAG_COLOR) == 0) { refuse(path, "read", "not a colour picture"); }
    image.format = PNG_FORMAT_RGB;
    RgbPicture picture{{image.width, image.height},
                       std::vector<std::uint8_t>(std::size_t{3} * image.width * image.height)};
    const png_color black{0, 0, 0};
    if (png_image_finish_read(&image, &black, picture.bytes.data(), 0, nullptr) == 0) {
        refuse(path, "read", image.message);
    }
    return picture;
}

}  // namespace simulated
