// Written by hand, since little of the standard is needed and a name must not lead out of its folder.
#include "engine/files/web/address.h"

#include "engine/address.h"
#include "engine/error.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <span>
#include <system_error>
#include <vector>

namespace binosplat {

namespace {

constexpr std::size_t kLongest = 4096;

std::string encoded(std::string_view text, std::string_view kept) {
    std::string result;
    for (const char letter : text) {
        const bool plain = (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
                           (letter >= '0' && letter <= '9') || kept.find(letter) != std::string_view::npos;
        result += plain ? std::string(1, letter) : fmt::format("%{:02X}", static_cast<unsigned char>(letter));
    }
    return result;
}

std::optional<std::uint16_t> parseNumber(std::string_view text, int base, std::uint16_t most) {
    std::uint16_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number, base);
    return error == std::errc() && end == text.data() + text.size() && number <= most ? std::optional(number)
                                                                                      : std::nullopt;
}

using Ipv4 = std::array<std::uint16_t, 2>;  // halves

std::optional<Ipv4> parseIpv4(std::string_view ip) {
    std::array<std::uint16_t, 4> bytes{};
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t end = i < 3 ? ip.find('.') : ip.size();
        const auto byte =
            end == std::string_view::npos ? std::nullopt : parseNumber(ip.substr(0, end), 10, 255);
        if (!byte) { return std::nullopt; }
        bytes[i] = *byte;
        ip.remove_prefix(std::min(end + 1, ip.size()));
    }
    return Ipv4{static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]),
                static_cast<std::uint16_t>(bytes[2] << 8 | bytes[3])};
}

// After RFC 6890.
bool isPrivateIpv4(Ipv4 ip) {
    const int a = ip[0] >> 8, b = ip[0] & 0xff;
    return a == 0 || a == 10 || a == 127 || (a == 100 && (b & 0xc0) == 64) || (a == 169 && b == 254) ||
           (a == 172 && (b & 0xf0) == 16) || (a == 192 && b == 168);
}

}  // namespace

Address parseAddress(const std::string& source) {
    requireNoUser(source);
    check(isAddress(source) && source.size() <= kLongest,
          "{}: not an http or https address of at most {} bytes", source.substr(0, 200), kLongest);
    Address address;
    // Characters that are allowed in an address stay as they are, including a percent sign.
    address.text = encoded(std::string_view(source).substr(0, source.find('#')), "-._~:/?[]@!$&'()*+,;=%");
    const std::size_t host = address.text.find("//") + 2,
                      host_end = std::min(address.text.find_first_of("/?", host), address.text.size());
    const std::string_view authority = std::string_view(address.text).substr(host, host_end - host);
    check(!authority.empty() && !authority.starts_with(':'),
          "{}: names no server, expected https://SERVER/FILE", source);
    if (host_end == address.text.size() || address.text[host_end] == '?') {
        address.text.insert(host_end, "/");
    }
    address.server = address.text.substr(0, host_end);
    const std::string path = address.text.substr(0, address.text.find('?'));
    address.folder = path.substr(0, path.rfind('/') + 1);
    return address;
}

std::optional<std::array<std::uint16_t, 8>> parseIp(std::string_view ip) {
    ip = ip.substr(0, ip.find('%'));  // a link's name
    if (ip.find(':') == std::string_view::npos) {
        const auto v4 = parseIpv4(ip);
        return v4 ? std::optional(std::array<std::uint16_t, 8>{0, 0, 0, 0, 0, 0xffff, (*v4)[0], (*v4)[1]})
                  : std::nullopt;
    }
    std::vector<std::uint16_t> groups;
    std::optional<std::size_t> gap;  // ::
    if (ip.starts_with("::")) {
        gap = 0;
        ip.remove_prefix(2);
    }
    while (!ip.empty() && groups.size() < 8) {
        const std::size_t end = std::min(ip.find(':'), ip.size());
        if (const auto v4 = end == ip.size() ? parseIpv4(ip) : std::nullopt) {
            groups.insert(groups.end(), v4->begin(), v4->end());
        } else {
            const auto group = parseNumber(ip.substr(0, end), 16, 0xffff);
            if (!group) { return std::nullopt; }
            groups.push_back(*group);
        }
        ip.remove_prefix(end);
        if (ip.starts_with("::") && !gap) {
            gap = groups.size();
            ip.remove_prefix(2);
        } else if (ip.size() > 1) {
            ip.remove_prefix(1);
        }
    }
    if (!ip.empty() || groups.size() > 8 || (groups.size() == 8) == gap.has_value()) { return std::nullopt; }
    if (gap) { groups.insert(groups.begin() + static_cast<std::ptrdiff_t>(*gap), 8 - groups.size(), 0); }
    std::array<std::uint16_t, 8> address{};
    std::ranges::copy(groups, address.begin());
    return address;
}

bool isPrivateAddress(const std::string& ip) {
    const auto address = parseIp(ip);
    if (!address) { return false; }
    const auto& group = *address;
    const auto begins = [&](std::initializer_list<std::uint16_t> start) {
        return std::ranges::equal(start, std::span(group).first(start.size()));
    };
    if (begins({0x2002})) { return isPrivateIpv4({group[1], group[2]}); }
    if (begins({0, 0, 0, 0, 0, 0}) || begins({0, 0, 0, 0, 0, 0xffff}) || begins({0x64, 0xff9b, 0, 0, 0, 0}) ||
        begins({0x64, 0xff9b, 1})) {
        return isPrivateIpv4({group[6], group[7]});
    }
    return (group[0] & 0xfe00) == 0xfc00 || (group[0] & 0xffc0) == 0xfe80;  // unique local, link-local
}

std::string addressOf(const Address& address, const std::string& name) {
    if (name.empty()) { return address.text; }
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find('/', begin), name.size());
        const std::string_view part = std::string_view(name).substr(begin, end - begin);
        check(!part.empty() && part != "." && part != "..",
              "{}: names the file '{}', expected one within its folder", address.text, name);
        begin = end + 1;
    }
    return address.folder + encoded(name, "-._~/");
}

}  // namespace binosplat
