// Guards against TOML that crashes the library that reads it, toml++ 3.1 to 3.4. Call this before parsing
// anything with it.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace files {

struct UnreadableToml {
    int line;             // from 1
    std::string problem;  // what is wrong and what is expected
};

// The first of: a key of more than 64 parts; a letter outside ASCII that is neither in quotes nor in a
// comment; quotes where no key and no value begins; a string of several lines. If there is none, nullopt:
// toml++ may be given the text, whether it is TOML or not.
std::optional<UnreadableToml> findUnreadableToml(std::string_view text);

}  // namespace files
