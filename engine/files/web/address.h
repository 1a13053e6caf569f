// Web addresses, as far as scenes need them (RFC 3986).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace binosplat {

struct Address {
    std::string text;    // as it is requested: without a fragment, and with non-ASCII letters encoded
    std::string folder;  // up to and including its last slash, without what follows a question mark
    std::string server;  // its scheme, host and port
};

// Throws Error if `source` is not an http or https address, or names a user, whose password must not appear
// in messages.
Address parseAddress(const std::string& source);

// The eight groups of a numeric address, an IPv4 one written as IPv6 (::ffff:0:0/96). Empty for anything
// else, such as a name.
std::optional<std::array<std::uint16_t, 8>> parseIp(std::string_view ip);

// True for the numeric address of a machine that is not on the public web: this one, or one on a private
// network or link. An IPv4 address within an IPv6 one (mapped, NAT64, 6to4) counts as the IPv4 address.
bool isPrivateAddress(const std::string& ip);

// The address of the file `name` in the folder of `address`; for an empty name, `address` itself. Throws
// Error if it would lead out of the folder.
std::string addressOf(const Address& address, const std::string& name);

}  // namespace binosplat
