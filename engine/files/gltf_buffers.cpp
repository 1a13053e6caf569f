// Files by InputFile; URIs as in RFC 3986, as far as glTF uses them.
#include "engine/files/gltf_buffers.h"

#include "engine/error.h"
#include "engine/files/scene_files.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string_view>
#include <utility>

namespace binosplat {

namespace {

// %20 and the like; empty if a % is not followed by two digits.
std::optional<std::string> decodePercents(const std::string& uri) {
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] != '%') {
            text += uri[i];
            continue;
        }
        unsigned letter = 0;
        if (i + 2 >= uri.size() ||
            std::from_chars(uri.data() + i + 1, uri.data() + i + 3, letter, 16).ptr != uri.data() + i + 3) {
            return std::nullopt;
        }
        text += static_cast<char>(letter);
        i += 2;
    }
    return text;
}

// RFC 4648, section 4; empty if it is anything else.
std::optional<std::vector<std::byte>> decodeBase64(std::string_view text) {
    constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    if (text.size() % 4 != 0) { return std::nullopt; }
    for (int padding = 0; padding < 2 && text.ends_with('='); ++padding) { text.remove_suffix(1); }
    std::array<int, 256> values{};
    values.fill(-1);
    for (std::size_t i = 0; i < kLetters.size(); ++i) {
        values[static_cast<unsigned char>(kLetters[i])] = static_cast<int>(i);
    }
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char letter : text) {
        const int value = values[static_cast<unsigned char>(letter)];
        if (value < 0) { return std::nullopt; }
        bits = bits << 6 | static_cast<std::uint32_t>(value);
        if ((count += 6) < 8) { continue; }
        count -= 8;
        bytes.push_back(static_cast<std::byte>(bits >> count & 0xff));
    }
    return bytes;
}

// The bytes within a data URI of any type (RFC 2397); empty if they are not base64.
std::optional<std::vector<std::byte>> decodeDataUri(std::string_view uri) {
    const std::size_t comma = uri.find(',');
    if (comma == std::string_view::npos || !uri.substr(0, comma).ends_with(";base64")) {
        return std::nullopt;
    }
    return decodeBase64(uri.substr(comma + 1));
}

}  // namespace

GltfBuffer::GltfBuffer(std::unique_ptr<InputFile> file)
    : own_(std::move(file)), file_(own_.get()), size_bytes_(own_->sizeBytes()) {}
GltfBuffer::GltfBuffer(std::vector<std::byte> bytes) : bytes_(std::move(bytes)), size_bytes_(bytes_.size()) {}

void GltfBuffer::read(std::uint64_t offset, std::span<std::byte> target) const {
    if (file_ == nullptr) {
        std::memcpy(target.data(), bytes_.data() + offset, target.size());
        return;
    }
    check(file_->readAt(offset_ + offset, target) == target.size(),
          "{}: ends at byte {}, {} more were expected", file_->name(), offset_ + offset, target.size());
}

void GltfBuffer::requireUnchanged() const {
    if (own_) { own_->requireUnchanged(); }
}

GltfBuffer openGltfUri(const InputFile& file, const std::string& uri, const std::string& place) {
    if (uri.starts_with("data:")) {
        std::optional<std::vector<std::byte>> bytes = decodeDataUri(uri);
        check(bytes.has_value(),
              "{}: uri begins with '{}', expected data:application/octet-stream;base64, and base64", place,
              uri.substr(0, 40));
        return GltfBuffer(std::move(*bytes));
    }
    namespace fs = std::filesystem;
    const std::optional<std::string> name = decodePercents(uri);
    const fs::path path = name ? fs::path(*name) : fs::path();
    const bool within = name && !name->empty() && !path.has_root_path() &&
                        name->find_first_of(std::string_view("\\:\0", 3)) == std::string::npos &&
                        std::find(path.begin(), path.end(), "..") == path.end();
    check(within, "{}: uri is '{}', expected a path within the folder of the file", place,
          uri.substr(0, 200));
    if (file.others() != nullptr) {
        return GltfBuffer(file.others()->open(path.lexically_normal().generic_string()));
    }
    return GltfBuffer(std::make_unique<InputFile>((fs::path(file.name()).parent_path() / path).string()));
}

}  // namespace binosplat
