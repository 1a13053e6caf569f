// JSON files checked value by value: each value knows its place, "meta.json: means.mins[2]", and says what
// was expected there.
#pragma once

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace binosplat {

// `file` is the name for messages, `expected` what it should be. Throws Error if the text is not JSON or is
// nested deeper than `max_depth`, so that code that walks through it or quotes it cannot overflow the stack.
nlohmann::json parseJson(std::span<const std::byte> text, const std::string& file, const char* expected,
                         int max_depth = 64);

// True if a text that starts like this is an object.
bool startsObject(std::string_view start);

// A value in a document, which must outlive this. A request that the value does not meet throws Error.
struct JsonNode {
    const nlohmann::json& value;
    const std::string& file;
    std::string key = {};  // starting from the document; empty: the document itself

    [[nodiscard]] std::string place() const { return key.empty() ? file : file + ": " + key; }
    // True if it is an object with a `name` that is not null.
    [[nodiscard]] bool has(const char* name) const;
    [[nodiscard]] JsonNode at(const std::string& name) const;
    [[nodiscard]] JsonNode at(std::size_t index) const;  // of an array, less than its size
    void requireObject() const;
    [[nodiscard]] std::size_t arraySize() const;
    void requireArray(std::size_t size) const;
    [[nodiscard]] float number() const;         // finite
    [[nodiscard]] std::uint64_t count() const;  // also as 608.0
    [[nodiscard]] std::string text() const;
    // A text with backslashes replaced by slashes, and without "./" at the beginning.
    [[nodiscard]] std::string filePath() const;
    [[nodiscard]] bool flag() const;
};

}  // namespace binosplat
