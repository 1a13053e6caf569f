// One check for each type that can be requested.
#include "engine/files/json_node.h"

#include "engine/error.h"
#include "engine/files/input_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binosplat {

nlohmann::json parseJson(std::span<const std::byte> text, const std::string& file, const char* expected,
                         int max_depth) {
    try {
        const char* begin = reinterpret_cast<const char*>(text.data());
        return nlohmann::json::parse(
            begin, begin + text.size(), [&](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
                check(depth <= max_depth, "{}: nested more than {} levels deep, expected {}", file, max_depth,
                      expected);
                return true;
            });
    } catch (const nlohmann::json::exception& error) {
        fail("{}: not JSON ({}), expected {}", file, error.what(), expected);
    }
}

bool startsObject(std::string_view start) {
    start = withoutByteOrderMark(start);
    const std::size_t first = start.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && start[first] == '{';
}

bool JsonNode::has(const char* name) const {
    if (!value.is_object()) { return false; }
    const auto found = value.find(name);
    return found != value.end() && !found->is_null();
}

JsonNode JsonNode::at(const std::string& name) const {
    requireObject();
    const auto found = value.find(name);
    check(found != value.end(), "{}: has no {}, expected one", place(), name);
    return {*found, file, key.empty() ? name : key + "." + name};
}

JsonNode JsonNode::at(std::size_t index) const {
    return {value[index], file, fmt::format("{}[{}]", key, index)};
}

void JsonNode::requireObject() const {
    check(value.is_object(), "{}: is {}, expected an object", place(), value.type_name());
}

std::size_t JsonNode::arraySize() const {
    check(value.is_array(), "{}: is {}, expected an array", place(), value.type_name());
    return value.size();
}

void JsonNode::requireArray(std::size_t size) const {
    check(arraySize() == size, "{}: has {} entries, expected {}", place(), value.size(), size);
}

float JsonNode::number() const {
    check(value.is_number(), "{}: is {}, expected a number", place(), value.type_name());
    const double wide = value.get<double>();
    check(std::abs(wide) <= static_cast<double>(std::numeric_limits<float>::max()),
          "{}: is {}, expected a float32 number", place(), wide);
    return static_cast<float>(wide);
}

std::uint64_t JsonNode::count() const {
    // Some writers have no integers: 608.0. Beyond 2^53 a double may have been rounded.
    const double wide = value.is_number_float() ? value.get<double>() : -1.0;
    if (wide >= 0.0 && wide <= 0x1p53 && wide == std::floor(wide)) {
        return static_cast<std::uint64_t>(wide);
    }
    check(value.is_number_unsigned(), "{}: is {}, expected a whole number from 0 on", place(),
          value.is_number() ? value.dump() : value.type_name());
    return value.get<std::uint64_t>();
}

std::string JsonNode::filePath() const {
    std::string path = text();
    std::ranges::replace(path, '\\', '/');
    while (path.starts_with("./")) { path.erase(0, path.find_first_not_of('/', 1)); }
    return path;
}

std::string JsonNode::text() const {
    check(value.is_string(), "{}: is {}, expected a text", place(), value.type_name());
    return value.get<std::string>();
}

bool JsonNode::flag() const {
    check(value.is_boolean(), "{}: is {}, expected true or false", place(), value.type_name());
    return value.get<bool>();
}

}  // namespace binosplat
