// Image files through libpng and OpenEXR, for builds that cannot have OpenImageIO.
#include "engine/error.h"
#include "engine/picture/netpbm.h"
#include "engine/picture/picture_files.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <png.h>
#pragma GCC diagnostic pop

#include <algorithm>
#include <array>
#include <cerrno>
#include <csetjmp>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

// The libraries' messages can span lines; ours must not.
std::string oneLine(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    while (!text.empty() && text.back() == ' ') { text.pop_back(); }
    return text;
}

[[noreturn]] void failToWrite(const fs::path& path, const std::string& reason) {
    std::error_code ignored;
    fs::remove(path, ignored);
    fail("{}: cannot be written ({})", path.string(), oneLine(reason));
}

void requireSize(const fs::path& path, std::uint64_t width, std::uint64_t height, std::uint64_t channels) {
    constexpr std::uint64_t kMostSide = std::uint64_t{1} << 30;  // two of them can be multiplied
    const bool fits = width > 0 && height > 0 && channels > 0 && width <= kMostSide && height <= kMostSide &&
                      width * height <= kMostPictureValues / channels;
    check(fits, "{}: has {}x{} pixels of {} channels, must be a flat picture of up to 2^30 values",
          path.string(), width, height, channels);
}

// OpenEXR finishes a file in a destructor, which cannot report errors, so check for a full disk afterwards.
class ExrOutput final : public Imf::OStream {
public:
    explicit ExrOutput(const fs::path& path) : Imf::OStream("picture"), stream_(path, std::ios::binary) {}

    void write(const char* bytes, int count) override { stream_.write(bytes, count); }
    std::uint64_t tellp() override { return static_cast<std::uint64_t>(stream_.tellp()); }
    void seekp(std::uint64_t place) override { stream_.seekp(static_cast<std::streamoff>(place)); }
    bool isOpen() const { return stream_.is_open(); }
    bool close() {
        const bool written = stream_.good();
        stream_.close();
        return written && stream_.good();
    }

private:
    std::ofstream stream_;
};

class ExrInput final : public Imf::IStream {
public:
    explicit ExrInput(const fs::path& path) : Imf::IStream("picture"), stream_(path, std::ios::binary) {}

    bool read(char* bytes, int count) override {
        if (!stream_.read(bytes, count)) { throw std::runtime_error("ends too soon"); }
        return stream_.peek() != std::ifstream::traits_type::eof();
    }
    std::uint64_t tellg() override { return static_cast<std::uint64_t>(stream_.tellg()); }
    void seekg(std::uint64_t place) override {
        stream_.clear();
        stream_.seekg(static_cast<std::streamoff>(place));
    }
    void clear() override { stream_.clear(); }

private:
    std::ifstream stream_;
};

// Where the values of one channel are. OpenEXR counts from pixel (0,0), which may be outside its window.
Imf::Slice sliceOf(float* first, std::size_t channels, const Imath::Box2i& window) {
    const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
    return Imf::Slice::Make(Imf::FLOAT, first, window, sizeof(float) * channels,
                            sizeof(float) * channels * width);
}

// Colours first, in the usual order; a file has its channels in alphabetical order.
std::vector<std::string> channelsOf(const Imf::Header& header) {
    std::vector<std::string> names;
    for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
        names.emplace_back(channel.name());
    }
    constexpr std::string_view kOrder = "RGBA";
    std::ranges::stable_sort(names, {}, [&](const std::string& name) {
        return name.size() == 1 ? kOrder.find(name) : kOrder.npos;
    });
    return names;
}

Image readExr(const fs::path& path) {
    try {
        ExrInput stream(path);
        Imf::InputFile file(stream);
        const Imath::Box2i window = file.header().dataWindow();
        const std::vector<std::string> names = channelsOf(file.header());
        const std::int64_t width = std::int64_t{window.max.x} - window.min.x + 1,
                           height = std::int64_t{window.max.y} - window.min.y + 1;
        requireSize(path, static_cast<std::uint64_t>(std::max<std::int64_t>(width, 0)),
                    static_cast<std::uint64_t>(std::max<std::int64_t>(height, 0)), names.size());
        Image image{{static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)},
                    static_cast<int>(names.size()),
                    {}};
        image.values.resize(image.pixelCount() * names.size());
        Imf::FrameBuffer target;
        for (std::size_t i = 0; i < names.size(); ++i) {
            target.insert(names[i], sliceOf(image.values.data() + i, names.size(), window));
        }
        file.setFrameBuffer(target);
        file.readPixels(window.min.y, window.max.y);
        return image;
    } catch (const Error&) { throw; } catch (const std::exception& error) {
        fail("{}: cannot be read ({})", path.string(), oneLine(error.what()));
    }
}

struct PngReader {
    png_structp png = nullptr;
    png_infop info = nullptr;
    std::string complaint;

    PngReader() {
        png = png_create_read_struct(
            PNG_LIBPNG_VER_STRING, this,
            [](png_structp failed, png_const_charp message) {
                static_cast<PngReader*>(png_get_error_ptr(failed))->complaint = message;
                png_longjmp(failed, 1);
            },
            [](png_structp, png_const_charp) {});
        info = png != nullptr ? png_create_info_struct(png) : nullptr;
    }
    PngReader(const PngReader&) = delete;
    PngReader& operator=(const PngReader&) = delete;
    ~PngReader() { png_destroy_read_struct(&png, &info, nullptr); }

    // libpng leaves these by longjmp: nothing in them may have a destructor. False: `complaint` says why.
    bool readHeader(std::FILE* file) {
        if (setjmp(png_jmpbuf(png)) != 0) { return false; }
        png_init_io(png, file);
        png_read_info(png, info);
        // Palettes, single bits and transparent colours become bytes of R, G, B, A; two bytes stay two.
        png_set_expand(png);
        png_set_interlace_handling(png);
        png_read_update_info(png, info);
        return true;
    }
    bool readRows(png_bytepp rows) {
        if (setjmp(png_jmpbuf(png)) != 0) { return false; }
        png_read_image(png, rows);
        png_read_end(png, nullptr);
        return true;
    }
};

Image readPng(const fs::path& path, std::FILE* file) {
    PngReader reader;
    check(reader.info != nullptr, "{}: cannot be read (no memory)", path.string());
    check(reader.readHeader(file), "{}: cannot be read ({})", path.string(), oneLine(reader.complaint));
    const png_uint_32 width = png_get_image_width(reader.png, reader.info),
                      height = png_get_image_height(reader.png, reader.info);
    const int channels = png_get_channels(reader.png, reader.info);
    const bool is_wide = png_get_bit_depth(reader.png, reader.info) == 16;
    requireSize(path, width, height, static_cast<std::uint64_t>(channels));
    const std::size_t row_bytes = png_get_rowbytes(reader.png, reader.info);
    std::vector<png_byte> bytes(row_bytes * height);
    std::vector<png_bytep> rows(height);
    for (std::size_t y = 0; y < height; ++y) { rows[y] = bytes.data() + y * row_bytes; }
    check(reader.readRows(rows.data()), "{}: cannot be read ({})", path.string(), oneLine(reader.complaint));
    Image image{{width, height}, channels, {}};
    image.values.resize(image.pixelCount() * static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        image.values[i] = is_wide ? static_cast<float>(bytes[2 * i] * 256 + bytes[2 * i + 1]) / 65535.0f
                                  : static_cast<float>(bytes[i]) / 255.0f;
    }
    return image;
}

}  // namespace

bool writeJpegFile(const fs::path&, const Image&) { return false; }

bool hasPngAndExr() { return true; }

void writeExr(const fs::path& path, const Image& image) {
    const auto channels = static_cast<std::size_t>(image.channels);
    const Imath::Box2i window({0, 0},
                              {static_cast<int>(image.size_px.x) - 1, static_cast<int>(image.size_px.y) - 1});
    try {
        ExrOutput stream(path);
        if (!stream.isOpen()) { fail("{}: cannot be written ({})", path.string(), std::strerror(errno)); }
        {
            Imf::Header header(window, window);
            header.compression() = Imf::ZIP_COMPRESSION;
            Imf::FrameBuffer source;
            for (std::size_t i = 0; i < channels; ++i) {
                const std::string name = channels == 1 ? "D" : std::string(1, "RGBA"[i]);
                header.channels().insert(name, Imf::Channel(Imf::FLOAT));
                source.insert(name, sliceOf(const_cast<float*>(image.values.data()) + i, channels, window));
            }
            Imf::OutputFile file(stream, header);
            file.setFrameBuffer(source);
            file.writePixels(static_cast<int>(image.size_px.y));
        }
        if (!stream.close()) { throw std::runtime_error(std::strerror(errno)); }
    } catch (const Error&) { throw; } catch (const std::exception& error) {
        failToWrite(path, error.what());
    }
}

void writePng(const fs::path& path, const Image& rgb) {
    std::vector<png_byte> pixels(rgb.values.size());
    std::ranges::transform(rgb.values, pixels.begin(), quantize);
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = rgb.size_px.x;
    image.height = rgb.size_px.y;
    image.format = PNG_FORMAT_RGB;
    std::vector<char> bytes(PNG_IMAGE_PNG_SIZE_MAX(image));
    png_alloc_size_t size = bytes.size();
    const bool packed =
        png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) != 0;
    check(packed, "{}: cannot be written ({})", path.string(), oneLine(image.message));
    std::ofstream file(path, std::ios::binary);
    check(file.is_open(), "{}: cannot be written ({})", path.string(), std::strerror(errno));
    file.write(bytes.data(), static_cast<std::streamsize>(size));
    file.close();
    if (!file) { failToWrite(path, std::strerror(errno)); }
}

Image readPictureFile(const fs::path& path, std::FILE* file) {
    std::array<png_byte, 8> start{};
    const std::size_t read = std::fread(start.data(), 1, start.size(), file);
    std::rewind(file);
    if (read == start.size() && png_sig_cmp(start.data(), 0, start.size()) == 0) {
        return readPng(path, file);
    }
    if (read >= 4 && start[0] == 0x76 && start[1] == 0x2f && start[2] == 0x31 && start[3] == 0x01) {
        return readExr(path);
    }
    fail("{}: cannot be read in a build without OpenImageIO, must be PNG, EXR, .pfm, .ppm or .pgm",
         path.string());
}

}  // namespace binosplat
