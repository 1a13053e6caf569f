// Image files through OpenImageIO, which is used nowhere else.
#include "engine/error.h"
#include "engine/picture/netpbm.h"
#include "engine/picture/picture_files.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <OpenImageIO/imageio.h>
#pragma GCC diagnostic pop

#include <algorithm>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

// The library's messages can span lines; ours must not.
std::string oneLine(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    while (!text.empty() && text.back() == ' ') { text.pop_back(); }
    return text;
}

void writeWithLibrary(const fs::path& path, const OIIO::ImageSpec& spec, OIIO::TypeDesc type,
                      const void* values) {
    const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path.string());
    check(output != nullptr, "{}: cannot be written ({})", path.string(), oneLine(OIIO::geterror()));
    const bool opened = output->open(path.string(), spec);
    // `close` flushes, and a full disk may be noticed only then.
    const bool written = opened && output->write_image(type, values);
    const std::string first_error = written ? "" : output->geterror();
    const bool closed = output->close();
    if (!written || !closed) {
        std::error_code ignored;
        fs::remove(path, ignored);
        fail("{}: cannot be written ({})", path.string(),
             oneLine(written ? output->geterror() : first_error));
    }
}

}  // namespace

bool hasPngAndExr() { return true; }

void writeExr(const fs::path& path, const Image& image) {
    OIIO::ImageSpec spec(static_cast<int>(image.size_px.x), static_cast<int>(image.size_px.y), image.channels,
                         OIIO::TypeDesc::FLOAT);
    if (image.channels == 1) { spec.channelnames = {"D"}; }
    spec.attribute("compression", "zip");
    writeWithLibrary(path, spec, OIIO::TypeDesc::FLOAT, image.values.data());
}

static void writeBytes(const fs::path& path, const Image& rgb) {
    OIIO::ImageSpec spec(static_cast<int>(rgb.size_px.x), static_cast<int>(rgb.size_px.y), 3,
                         OIIO::TypeDesc::UINT8);
    std::vector<unsigned char> bytes(rgb.values.size());
    std::ranges::transform(rgb.values, bytes.begin(), quantize);
    writeWithLibrary(path, spec, OIIO::TypeDesc::UINT8, bytes.data());
}

void writePng(const fs::path& path, const Image& rgb) { writeBytes(path, rgb); }

bool writeJpegFile(const fs::path& path, const Image& rgb) {
    writeBytes(path, rgb);
    return true;
}

Image readPictureFile(const fs::path& path, std::FILE*) {
    OIIO::ImageSpec as_stored;
    as_stored.attribute("oiio:UnassociatedAlpha", 1);  // colours are not multiplied by alpha
    const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path.string(), &as_stored);
    check(input != nullptr, "{}: cannot be read ({}), must be an image file", path.string(),
          oneLine(OIIO::geterror()));
    const OIIO::ImageSpec& spec = input->spec();
    const bool is_flat =
        spec.width > 0 && spec.height > 0 && spec.depth <= 1 && spec.nchannels > 0 && !spec.deep;
    check(is_flat && spec.image_pixels() <= kMostPictureValues / static_cast<std::uint64_t>(spec.nchannels),
          "{}: has {}x{}x{} pixels of {} channels{}, must be a flat picture of up to 2^30 values",
          path.string(), spec.width, spec.height, spec.depth, spec.nchannels, spec.deep ? ", deep" : "");
    Image image{{static_cast<std::uint32_t>(spec.width), static_cast<std::uint32_t>(spec.height)},
                spec.nchannels,
                {}};
    image.values.resize(image.pixelCount() * static_cast<std::size_t>(image.channels));
    const bool read = input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data());
    check(read, "{}: cannot be read ({})", path.string(), oneLine(input->geterror()));
    return image;
}

}  // namespace binosplat
