// Parsing of PLY headers, one keyword per line.
#include "engine/files/ply_header.h"

#include "engine/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

namespace binosplat::ply {

namespace {

constexpr std::uint64_t kMaxHeaderBytes = std::uint64_t{1} << 20;

constexpr std::array<std::pair<std::string_view, Type>, 16> kTypeNames{{
    {"char", Type::kInt8},
    {"int8", Type::kInt8},
    {"uchar", Type::kUint8},
    {"uint8", Type::kUint8},
    {"short", Type::kInt16},
    {"int16", Type::kInt16},
    {"ushort", Type::kUint16},
    {"uint16", Type::kUint16},
    {"int", Type::kInt32},
    {"int32", Type::kInt32},
    {"uint", Type::kUint32},
    {"uint32", Type::kUint32},
    {"float", Type::kFloat32},
    {"float32", Type::kFloat32},
    {"double", Type::kFloat64},
    {"float64", Type::kFloat64},
}};

std::vector<std::string_view> splitWords(std::string_view line) {
    std::vector<std::string_view> words;
    for (std::size_t at = 0; (at = line.find_first_not_of(" \t", at)) != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(" \t", at), line.size());
        words.push_back(line.substr(at, end - at));
        at = end;
    }
    return words;
}

// A header line with its place, for messages.
struct Line {
    const std::string& file;
    int number;
    std::vector<std::string_view> words;

    template <typename... Args>
    void require(bool condition, fmt::format_string<Args...> format, Args&&... args) const {
        if (!condition) {
            fail("{}: header line {}: {}", file, number, fmt::format(format, std::forward<Args>(args)...));
        }
    }
};

Type parseType(const Line& line, std::string_view name) {
    const auto* found = std::find_if(kTypeNames.begin(), kTypeNames.end(),
                                     [&](const auto& entry) { return entry.first == name; });
    line.require(found != kTypeNames.end(),
                 "unknown type '{}', expected char, uchar, short, ushort, int, uint, float or double", name);
    return found->second;
}

Encoding parseFormat(const Line& line) {
    line.require(line.words.size() == 3, "expected 'format ENCODING 1.0'");
    line.require(line.words[2] == "1.0", "version is '{}', expected 1.0", line.words[2]);
    if (line.words[1] == "ascii") { return Encoding::kAscii; }
    if (line.words[1] == "binary_little_endian") { return Encoding::kLittleEndian; }
    line.require(line.words[1] == "binary_big_endian",
                 "unknown encoding '{}', expected ascii, binary_little_endian or binary_big_endian",
                 line.words[1]);
    return Encoding::kBigEndian;
}

Element parseElement(const Line& line) {
    line.require(line.words.size() == 3, "expected 'element NAME COUNT'");
    Element element;
    element.name = line.words[1];
    const std::string_view count = line.words[2];
    const auto [end, error] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    line.require(error == std::errc{} && end == count.data() + count.size(),
                 "count of element {} is '{}', expected an integer from 0 to 2^64 - 1", element.name, count);
    return element;
}

Property parseProperty(const Line& line) {
    const bool is_list = line.words.size() > 1 && line.words[1] == "list";
    line.require(line.words.size() == (is_list ? 5u : 3u),
                 "expected 'property TYPE NAME' or 'property list TYPE TYPE NAME'");
    Property property;
    property.is_list = is_list;
    if (is_list) { property.count_type = parseType(line, line.words[2]); }
    line.require(!is_list || property.count_type < Type::kFloat32,
                 "a list is counted by '{}', expected an integer type", line.words[2]);
    property.type = parseType(line, line.words[is_list ? 3 : 1]);
    property.name = line.words.back();
    return property;
}

bool equalsIgnoringCase(std::string_view a, std::string_view b) {
    const auto lower = [](char letter) {
        return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
    };
    return std::ranges::equal(a, b, {}, lower, lower);
}

// `words` of a comment line. Unknown comments are ignored.
void readComment(std::span<const std::string_view> words, Header& header) {
    if (words.size() == 2 && words[1].starts_with("postshot.anti_aliasing=")) {
        header.antialiased = words[1].ends_with("=1");
    }
    if (words.size() == 4 && equalsIgnoringCase(words[1], "vertical") &&
        equalsIgnoringCase(words[2], "axis:")) {
        header.vertical_axis = equalsIgnoringCase(words[3], "x")   ? 0
                               : equalsIgnoringCase(words[3], "z") ? 2
                                                                   : -1;
    }
    if (words.size() != 3) { return; }
    if (equalsIgnoringCase(words[1], "SplatRenderMode:")) {
        header.antialiased = equalsIgnoringCase(words[2], "mip");
    }
    if (equalsIgnoringCase(words[1], "antialiased")) { header.antialiased = words[2] == "1"; }
}

}  // namespace

std::size_t typeBytes(Type type) {
    constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};
    return kBytes[static_cast<std::size_t>(type)];
}

bool Element::hasList() const {
    return std::any_of(properties.begin(), properties.end(),
                       [](const Property& property) { return property.is_list; });
}

std::size_t Element::rowBytes() const {
    std::size_t bytes = 0;
    for (const Property& property : properties) { bytes += typeBytes(property.type); }
    return bytes;
}

Header readHeader(InputFile& file) {
    Header header;
    std::optional<Encoding> encoding;
    std::string_view text;
    for (bool magic_seen = false;;) {
        const InputFile::LineEnd end = file.readLine(text);
        check(end == InputFile::LineEnd::kBreak,
              "{}: header: the file ends after line {} without an end_header line", file.name(),
              header.line_count);
        check(file.positionBytes() <= kMaxHeaderBytes, "{}: header: no end_header line within the first MiB",
              file.name());
        const Line line{file.name(), ++header.line_count, splitWords(text)};
        if (!magic_seen) {
            line.require(withoutByteOrderMark(text) == "ply", "expected 'ply'");
            magic_seen = true;
            continue;
        }
        if (!line.words.empty() && line.words[0] == "comment") { readComment(line.words, header); }
        if (line.words.empty() || line.words[0] == "comment" || line.words[0] == "obj_info") { continue; }
        const std::string_view keyword = line.words[0];
        if (keyword == "end_header") { break; }
        if (keyword == "format") {
            line.require(!encoding, "a second format line");
            encoding = parseFormat(line);
        } else if (keyword == "element") {
            header.elements.push_back(parseElement(line));
        } else if (keyword == "property") {
            line.require(!header.elements.empty(), "a property before any element");
            header.elements.back().properties.push_back(parseProperty(line));
        } else {
            line.require(
                false,
                "unknown keyword '{}', expected format, element, property, comment, obj_info or end_header",
                keyword);
        }
    }
    check(encoding.has_value(),
          "{}: header: no format line, expected one of ascii, binary_little_endian or binary_big_endian",
          file.name());
    header.encoding = *encoding;
    return header;
}

}  // namespace binosplat::ply
