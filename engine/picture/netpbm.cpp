// PFM, PPM and PGM files.
#include "engine/picture/netpbm.h"

#include "engine/error.h"

#include <bit>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

static_assert(std::endian::native == std::endian::little, "files are written as they lie in memory");

constexpr std::uint64_t kMaxPixels = std::uint64_t{1} << 30;

void requireWhole(const Image& image, const fs::path& path) {
    check(image.channels == 1 || image.channels == 3, "{}: image has {} channels, must be 1 or 3",
          path.string(), image.channels);
    check(image.values.size() == image.pixelCount() * static_cast<std::size_t>(image.channels),
          "{}: image has {} values, must be {} x {} x {}", path.string(), image.values.size(),
          image.size_px.x, image.size_px.y, image.channels);
}

// A half-written file is removed.
void finish(std::ofstream& file, const fs::path& path) {
    file.close();
    if (!file) {
        const std::string reason = std::strerror(errno);
        std::error_code ignored;
        fs::remove(path, ignored);
        fail("{}: cannot be written ({})", path.string(), reason);
    }
}

struct Header {
    std::string magic;
    glm::uvec2 size_px{0, 0};
    double last = 0.0;  // PFM: scale, whose sign gives the byte order; PNM: largest value
};

// Magic, width, height and one number, separated by white space; then one white space and the values.
Header readHeader(std::ifstream& file, const fs::path& path) {
    check(file.good(), "{}: cannot be read ({}), must be an image file", path.string(), std::strerror(errno));
    Header header;
    std::uint64_t width = 0, height = 0;
    file >> header.magic >> width >> height >> header.last;
    file.get();
    check(file.good() && width > 0 && height > 0 && width <= kMaxPixels / height,
          "{}: header is not that of a PFM, PPM or PGM file", path.string());
    header.size_px = {static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)};
    return header;
}

// Before anything is reserved that the header promises.
void requireBytes(std::ifstream& file, const fs::path& path, std::uint64_t bytes) {
    const std::streamoff begin = file.tellg();
    file.seekg(0, std::ios::end);
    const std::streamoff there = file.tellg() - begin;
    file.seekg(begin);
    check(file.good() && static_cast<std::uint64_t>(there) >= bytes,
          "{}: ends after {} of {} bytes of pixels", path.string(), there, bytes);
}

void readBytes(std::ifstream& file, const fs::path& path, void* target, std::size_t bytes) {
    file.read(static_cast<char*>(target), static_cast<std::streamsize>(bytes));
    check(static_cast<std::size_t>(file.gcount()) == bytes, "{}: cannot be read", path.string());
}

}  // namespace

unsigned char quantize(float value) {
    // Written so that NaN takes the first branch.
    if (!(value > 0.0f)) { return 0; }
    return value >= 1.0f ? 255 : static_cast<unsigned char>(value * 255.0f + 0.5f);
}

Image selectChannels(const Image& image, int first, int count) {
    Image selected{image.size_px, count, {}};
    selected.values.reserve(image.pixelCount() * static_cast<std::size_t>(count));
    for (std::size_t pixel = 0; pixel < image.pixelCount(); ++pixel) {
        const float* values = &image.values[pixel * static_cast<std::size_t>(image.channels)];
        selected.values.insert(selected.values.end(), values + first, values + first + count);
    }
    return selected;
}

void writePfm(const fs::path& path, const Image& image) {
    requireWhole(image, path);
    std::ofstream file(path, std::ios::binary);
    file << (image.channels == 3 ? "PF" : "Pf") << "\n"
         << image.size_px.x << " " << image.size_px.y << "\n-1.0\n";
    const std::size_t row_values = std::size_t{image.size_px.x} * static_cast<std::size_t>(image.channels);
    for (std::size_t y = image.size_px.y; y-- > 0;) {
        file.write(reinterpret_cast<const char*>(&image.values[y * row_values]),
                   static_cast<std::streamsize>(row_values * sizeof(float)));
    }
    finish(file, path);
}

Image readPfm(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const Header header = readHeader(file, path);
    check((header.magic == "PF" || header.magic == "Pf") && header.last < 0.0,
          "{}: must be a little-endian PFM file", path.string());
    Image image{header.size_px, header.magic == "PF" ? 3 : 1, {}};
    const std::size_t row_values = std::size_t{image.size_px.x} * static_cast<std::size_t>(image.channels);
    requireBytes(file, path, std::uint64_t{row_values} * image.size_px.y * sizeof(float));
    image.values.resize(row_values * image.size_px.y);
    for (std::size_t y = image.size_px.y; y-- > 0;) {
        readBytes(file, path, &image.values[y * row_values], row_values * sizeof(float));
    }
    return image;
}

void writePnm(const fs::path& path, const Image& image) {
    requireWhole(image, path);
    std::ofstream file(path, std::ios::binary);
    file << (image.channels == 3 ? "P6" : "P5") << "\n"
         << image.size_px.x << " " << image.size_px.y << "\n255\n";
    std::string bytes(image.values.size(), '\0');
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        bytes[i] = static_cast<char>(quantize(image.values[i]));
    }
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    finish(file, path);
}

Image readPnm(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    const Header header = readHeader(file, path);
    check((header.magic == "P6" || header.magic == "P5") && header.last == 255.0,
          "{}: must be a binary PPM or PGM file of 8 bits", path.string());
    Image image{header.size_px, header.magic == "P6" ? 3 : 1, {}};
    const std::size_t count = image.pixelCount() * static_cast<std::size_t>(image.channels);
    requireBytes(file, path, count);
    std::vector<unsigned char> bytes(count);
    readBytes(file, path, bytes.data(), bytes.size());
    image.values.reserve(bytes.size());
    for (unsigned char byte : bytes) { image.values.push_back(static_cast<float>(byte) / 255.0f); }
    return image;
}

}  // namespace binosplat
