// Tells a web address from the name of a file.
#pragma once

#include "engine/error.h"

#include <algorithm>
#include <string>
#include <string_view>

namespace binosplat {

// `prefix` is in lower case; `source` may have it in either case.
inline bool beginsWith(std::string_view source, std::string_view prefix) {
    return source.size() >= prefix.size() &&
           std::ranges::equal(source.substr(0, prefix.size()), prefix, [](char a, char b) {
               return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
           });
}

inline bool isPlainHttp(std::string_view source) { return beginsWith(source, "http://"); }

// http:// or https:// followed by more, in letters of either case. Whether the rest is an address only turns
// out when it is requested.
inline bool isAddress(std::string_view source) {
    return isPlainHttp(source) || beginsWith(source, "https://");
}

// True for an address that others on the way could read and change: plain http, unless it is this machine's.
inline bool isOpenOnTheWay(std::string_view source) {
    if (!isPlainHttp(source)) { return false; }
    std::string_view host = source.substr(source.find("//") + 2);
    host = host.substr(0, host.find_first_of("/?#"));
    host = host.substr(0, host.starts_with('[') ? host.find(']') : host.find(':'));
    const bool is_number = host.find_first_not_of("0123456789.") == std::string_view::npos;
    const bool is_own = (host.size() == 9 && beginsWith(host, "localhost")) || host == "[::1" ||
                        (is_number && host.starts_with("127."));
    return !is_own;
}

// Throws Error for an address that names a user, perhaps with a password; the message leaves both out.
inline void requireNoUser(std::string_view source) {
    if (!isAddress(source)) { return; }
    const std::size_t host = source.find("//") + 2;
    const std::size_t at = source.substr(0, source.find_first_of("/?#", host)).rfind('@');
    check(at == std::string_view::npos || at < host,
          "{}...{}: names a user, expected an address that anybody may read", source.substr(0, host),
          source.substr(std::min(at, source.size())));
}

}  // namespace binosplat
