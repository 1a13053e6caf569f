// Guards against TOML that crashes the library that reads it, toml++ 3.1 to 3.4. Whoever parses with it must
// call this first.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace files {

struct UnreadableToml {
    int line;             // from 1
    std::string problem;  // what is wrong and what is expected
};

// The first of: a key of more than 64 parts; a letter outside of ASCII that is neither in quotes nor in a
// comment; quotes where no key and no value begins; a text over several lines. None of them: nullopt, and
// toml++ may have the text, be it TOML or not.
std::optional<UnreadableToml> findUnreadableToml(std::string_view text);

}  // namespace files
