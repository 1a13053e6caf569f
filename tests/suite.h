// SUITE(name) { facts }: the facts of NAME_test.cpp, which are one line of ctest. Inside, all names of
// binosplat and binosplat::test are visible. What suites and their headers share is included here; every
// header of tests includes this one.
#pragma once

#include "engine/error.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <list>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <set>
#include <span>
#include <sstream>
#include <string>
#include <string_view>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

namespace doctest {
template <typename... Values>
struct StringMaker<std::tuple<Values...>> {
    static String convert(const std::tuple<Values...>& all) {
        String text;
        std::apply(
            [&](const auto&... value) { ((text += (text.size() == 0 ? "" : ", ") + toString(value)), ...); },
            all);
        return text;
    }
};
}  // namespace doctest

#define SUITE(name)          \
    TEST_SUITE_BEGIN(#name); \
    namespace binosplat::test::name##_suite

namespace binosplat::test {

namespace fs = std::filesystem;

// For facts that take long and rarely break, TEST_CASE("..." * nightly()): .ci/nightly checks them.
struct nightly : doctest::skip {};

// The whole content of a file, byte by byte.
inline std::string textIn(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::vector<std::string> wordsIn(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

inline std::vector<std::string> linesIn(const std::string& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) { lines.push_back(line); }
    return lines;
}
inline bool isOneLine(const std::string& text) {
    return text.ends_with('\n') && std::ranges::count(text, '\n') == 1;
}
// A message with the backslashes that Windows writes in paths turned into slashes.
inline std::string withSlashes(std::string text) {
    if constexpr (fs::path::preferred_separator != '/') { std::ranges::replace(text, '\\', '/'); }
    return text;
}
inline bool contains(const std::string& text, const std::string& part) {
    return withSlashes(text).find(withSlashes(part)) != std::string::npos;
}

// JSON with some keys set to their expected values: it equals the original if it had those values.
inline nlohmann::json expecting(nlohmann::json json, const nlohmann::json& keys) {
    json.merge_patch(keys);
    return json;
}

// Compares things that belong together and prints both sides: CHECK(these(a.x, a.y) == these(1, 2)). The
// order in which arguments are evaluated is undefined, so calls that affect each other need a CHECK each.
template <typename... Values>
std::tuple<Values...> these(Values&&... values) {
    return std::tuple<Values...>(std::forward<Values>(values)...);
}

// Any value in the range is equal to it: CHECK(share == between(0.1, 0.2)).
struct Range {
    double low, high;
    bool has_ends;

    friend bool operator==(double value, const Range& range) {
        return range.has_ends ? value >= range.low && value <= range.high
                              : value > range.low && value < range.high;
    }
    friend std::ostream& operator<<(std::ostream& stream, const Range& range) {
        return stream << range.low << " to " << range.high;
    }
};
template <typename Low, typename High>
Range between(Low low, High high) {
    return {static_cast<double>(low), static_cast<double>(high), false};
}
// The same, including the ends.
template <typename Low, typename High>
Range within(Low low, High high) {
    return {static_cast<double>(low), static_cast<double>(high), true};
}

// Numbers of four bytes, the highest byte first.
inline std::string bigWord(std::uint32_t value) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0}) { bytes += static_cast<char>(value >> shift); }
    return bytes;
}
inline std::uint32_t bigWordAt(const std::string& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i) {
        value = value << 8 | static_cast<unsigned char>(bytes.at(i));
    }
    return value;
}

// From 0 to 1; the numbers of std::mt19937 are the same everywhere, those of distributions are not.
inline double drawUnit(std::mt19937& random) { return static_cast<double>(random() >> 8) / 16777216.0; }
inline double drawBetween(std::mt19937& random, double low, double high) {
    return low + (high - low) * drawUnit(random);
}

// The message of the Error that `action` throws; empty if it throws none.
inline std::string errorOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const Error& error) { return error.what(); }
    return {};
}

}  // namespace binosplat::test
