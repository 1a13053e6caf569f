// Thousands of broken inputs: how they are made, and what is required of their readers.
#pragma once

#include "tests/suite.h"

#ifndef _WIN32
#include <sys/resource.h>
#endif

#include <cctype>

namespace binosplat::test {

// Reads the input: only Error is thrown, its message is one line, and small files fit into memory.
struct Tally {
    std::size_t inputs = 0, read = 0, refused = 0;

    void attempt(const std::string& what, const std::function<void()>& read_it) {
        ++inputs;
        try {
            read_it();
            ++read;
        } catch (const Error& error) {
            ++refused;
            const std::string message = error.what();
            const bool one_line = message.find_first_of("\n\r") == std::string::npos;
            const bool enough_memory = !contains(message, "than this machine gives");
            if (message.size() < 8 || !one_line || !enough_memory) {
                FAIL_CHECK(what << ": the message is '" << message << "'");
            }
        } catch (const std::exception& error) {
            FAIL_CHECK(what << ": not an Error but '" << error.what() << "'");
        }
    }
};

#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
inline constexpr bool kSanitized = __has_feature(address_sanitizer);
#else
inline constexpr bool kSanitized = false;
#endif
// A sanitizer makes the libraries' start-up many times slower for each file, so one input in eight is tried.
inline constexpr std::size_t kStep = kSanitized ? 8 : 1;

// The peak memory of this process, in MiB; 0 on Windows, or if a sanitizer holds most of it.
inline long peakMebibytes() {
#ifdef _WIN32
    return 0;
#else
    if (kSanitized) { return 0; }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return usage.ru_maxrss / 1024;
#endif
}

using Attempt = std::function<void(const std::string& what, const std::string& bytes)>;

// `good` cut off at every length.
inline void truncate(const std::string& good, const Attempt& attempt) {
    for (std::size_t length = 0; length < good.size(); length += kStep) {
        attempt(fmt::format("the first {} bytes", length), good.substr(0, length));
    }
}

// `count` times one to eight changed bits, the same ones in every run.
inline void flipBits(const std::string& good, int count, const Attempt& attempt) {
    std::mt19937 random(5);
    for (int i = 0; i < count; i += static_cast<int>(kStep)) {
        std::string bytes = good;
        for (auto flips = 1 + random() % 8; flips > 0; --flips) {
            char& byte = bytes[random() % bytes.size()];
            byte = static_cast<char>(static_cast<unsigned char>(byte) ^ 1u << random() % 8);
        }
        attempt(fmt::format("flip {}", i), bytes);
    }
}

// `count` times a few bytes that are cut out, doubled, or overwritten with extreme numbers.
inline void spliceBytes(const std::string& good, int count, const Attempt& attempt) {
    static const std::array<std::string, 10> kExtremes{std::string(8, '\xff'),
                                                       std::string(8, '\0'),
                                                       std::string("\xff\xff\xff\x7f", 4),
                                                       std::string("\0\0\0\x80", 4),
                                                       std::string("\xff\xff\xff\xff\xff\xff\xff\x7f", 8),
                                                       std::string("\0\0\0\0\0\0\0\x80", 8),
                                                       std::string("\0\0\xc0\x7f", 4),  // NaN
                                                       std::string("\0\0\x80\x7f", 4),  // infinity
                                                       std::string("\0\0\x80\xff", 4),  // minus infinity
                                                       std::string("\1\0\0\0", 4)};     // a denormal
    std::mt19937 random(7);
    for (int i = 0; i < count; i += static_cast<int>(kStep)) {
        std::string bytes = good;
        const std::size_t at = random() % bytes.size(), length = 1 + random() % 16;
        const auto kind = static_cast<std::size_t>(random() % 12);
        if (kind < kExtremes.size()) {
            bytes.replace(at, std::min(kExtremes[kind].size(), bytes.size() - at),
                          kExtremes[kind].substr(0, bytes.size() - at));
        } else if (kind == 10) {
            bytes.erase(at, length);
        } else {
            bytes.insert(at, bytes.substr(at, length));
        }
        attempt(fmt::format("splice {}", i), bytes);
    }
}

// Every number in the first `reach` bytes of a text, replaced by each of these.
inline void replaceNumbers(const std::string& good, std::size_t reach, const Attempt& attempt) {
    std::vector<std::string> absurd = wordsIn(
        "-1 0 4294967296 9223372036854775807 9223372036854775808 18446744073709551615 -9223372036854775808 "
        "nan -inf 1e308 1e999 1e-320 0x10 \"7\" 99999999999999999999999");
    absurd.emplace_back();
    const auto isNumber = [](char letter) {
        return std::isdigit(static_cast<unsigned char>(letter)) != 0 || letter == '.' || letter == '-';
    };
    for (std::size_t at = 0; at < std::min(reach, good.size()); ++at) {
        if (!isNumber(good[at]) || (at > 0 && isNumber(good[at - 1]))) { continue; }
        std::size_t end = at;
        while (end < good.size() && isNumber(good[end])) { ++end; }
        for (const std::string& other : absurd) {
            attempt(fmt::format("byte {}: {}", at, other), good.substr(0, at) + other + good.substr(end));
        }
    }
}

// Every line in the first `reach` bytes left out, doubled, and moved to the front.
inline void shuffleLines(const std::string& good, std::size_t reach, const Attempt& attempt) {
    for (std::size_t at = 0; at < std::min(reach, good.size());) {
        const std::size_t end = std::min(good.find('\n', at), good.size() - 1) + 1;
        const std::string line = good.substr(at, end - at);
        attempt(fmt::format("without line at {}", at), good.substr(0, at) + good.substr(end));
        attempt(fmt::format("twice line at {}", at), good.substr(0, end) + line + good.substr(end));
        attempt(fmt::format("first line at {}", at), line + good.substr(0, at) + good.substr(end));
        at = end;
    }
}

}  // namespace binosplat::test
