// By hand, since little of the standard is needed and a name must not lead out of its folder.
#include "engine/web/address.h"

#include "engine/error.h"
#include "engine/scene/address.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

namespace binosplat {

namespace {

constexpr std::size_t kLongest = 4096;

std::string encoded(std::string_view text, std::string_view kept) {
    std::string result;
    for (const char letter : text) {
        const bool plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') || (letter >= '0' && letter <= '9') ||
                           kept.find(letter) != std::string_view::npos;
        result += plain ? std::string(1, letter) : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
    }
    return result;
}

}  // namespace

Address parseAddress(const std::string& source) {
    requireNoUser(source);
    check(isAddress(source) && source.size() <= kLongest, "{}: not an http or https address of at most {} bytes", source.substr(0, 200),
          kLongest);
    Address address;
    // Characters that are allowed in an address stay as they are, a percent sign, too.
    address.text = encoded(std::string_view(source).substr(0, source.find('#')), "-._~:/?[]@!$&'()*+,;=%");
    const std::size_t host = address.text.find("//") + 2, host_end = std::min(address.text.find_first_of("/?", host), address.text.size());
    const std::string_view authority = std::string_view(address.text).substr(host, host_end - host);
    check(!authority.empty() && !authority.starts_with(':'), "{}: names no server, expected https://SERVER/FILE", source);
    if (host_end == address.text.size() || address.text[host_end] == '?') { address.text.insert(host_end, "/"); }
    address.server = address.text.substr(0, host_end);
    const std::string path = address.text.substr(0, address.text.find('?'));
    address.folder = path.substr(0, path.rfind('/') + 1);
    return address;
}

bool isPrivateAddress(const std::string& ip) {
    // After RFC 6890. An IPv4 address may be written within an IPv6 one.
    const std::size_t last_colon = ip.rfind(':');
    const bool has_v4 = ip.find('.') != std::string::npos;
    if (!has_v4) {
        if (ip == "::" || ip == "::1") { return true; }
        unsigned first = 0;
        const char* const end = ip.data() + std::min(ip.find(':'), ip.size());
        std::from_chars(ip.data(), end, first, 16);
        return (first & 0xfe00) == 0xfc00 || (first & 0xffc0) == 0xfe80;  // unique local, link-local
    }
    std::array<unsigned, 2> part{};
    const char* at = ip.data() + (last_colon == std::string::npos ? 0 : last_colon + 1);
    for (unsigned& number : part) { at = std::from_chars(at, ip.data() + ip.size(), number).ptr + 1; }
    const auto [a, b] = part;
    return a == 0 || a == 10 || a == 127 || (a == 100 && (b & 0xc0) == 64) || (a == 169 && b == 254) || (a == 172 && (b & 0xf0) == 16) ||
           (a == 192 && b == 168);
}

std::string addressOf(const Address& address, const std::string& name) {
    if (name.empty()) { return address.text; }
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find('/', begin), name.size());
        const std::string_view part = std::string_view(name).substr(begin, end - begin);
        check(!part.empty() && part != "." && part != "..", "{}: names the file '{}', expected one within its folder", address.text, name);
        begin = end + 1;
    }
    return address.folder + encoded(name, "-._~/");
}

}  // namespace binosplat
