// Distinguishes an address on the web from the name of a file.
#pragma once

#include <algorithm>
#include <string_view>

namespace binosplat {

// http:// or https:// and more, in letters of either case. Whether the rest is an address turns out when it is requested.
inline bool isAddress(std::string_view source) {
    const auto beginsWith = [&](std::string_view scheme) {
        return source.size() >= scheme.size() && std::ranges::equal(source.substr(0, scheme.size()), scheme, [](char a, char b) {
                   return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
               });
    };
    return beginsWith("http://") || beginsWith("https://");
}

}  // namespace binosplat
