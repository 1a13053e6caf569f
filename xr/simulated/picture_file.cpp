// PNG files through OpenImageIO; the only place here that knows it.
#include "xr/simulated/picture_file.h"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <string>

#ifdef BINOSPLAT_OPENIMAGEIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <OpenImageIO/imageio.h>
#pragma GCC diagnostic pop
#endif

namespace simulated {

namespace fs = std::filesystem;

#ifdef BINOSPLAT_OPENIMAGEIO

namespace {

[[noreturn]] void refuse(const fs::path& path, const char* what, std::string reason) {
    for (char& c : reason) {
        if (c == '\n') { c = ' '; }
    }
    throw std::runtime_error(path.string() + ": cannot be " + what + " (" + reason + ")");
}

}  // namespace

void writePng(const fs::path& path, const RgbPicture& picture) {
    OIIO::ImageSpec spec(static_cast<int>(picture.size_px.x), static_cast<int>(picture.size_px.y), 3, OIIO::TypeDesc::UINT8);
    // Fast to pack: a run writes many.
    spec.attribute("png:compressionLevel", 3);
    // A name that ends in .png, or the library would not know the format.
    const fs::path unfinished = path.parent_path() / fmt::format(".{}.unfinished.png", path.stem().string());
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(unfinished.string());
    if (!output) { refuse(path, "written", OIIO::geterror()); }
    const bool opened = output->open(unfinished.string(), spec);
    const bool written = opened && output->write_image(OIIO::TypeDesc::UINT8, picture.bytes.data());
    std::string reason = written ? "" : output->geterror();
    // Closing flushes: a full disk may show there only.
    const bool closed = output->close();
    std::error_code error;
    if (written && closed) {
        fs::rename(unfinished, path, error);
        if (!error) { return; }
        reason = error.message();
    }
    fs::remove(unfinished, error);
    refuse(path, "written", reason.empty() ? output->geterror() : reason);
}

RgbPicture readPng(const fs::path& path) {
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string());
    if (!input) { refuse(path, "read", OIIO::geterror()); }
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.nchannels < 3) { refuse(path, "read", "not a colour picture"); }
    RgbPicture picture{{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height)}, {}};
    picture.bytes.resize(std::size_t{3} * picture.size_px.x * picture.size_px.y);
    if (!input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, picture.bytes.data())) { refuse(path, "read", input->geterror()); }
    return picture;
}

#else

void writePng(const fs::path& path, const RgbPicture&) {
    throw std::runtime_error(path.string() + ": cannot be written in a build without OpenImageIO");
}
RgbPicture readPng(const fs::path& path) { throw std::runtime_error(path.string() + ": cannot be read in a build without OpenImageIO"); }

#endif

}  // namespace simulated
