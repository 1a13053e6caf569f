// Addresses on the web, as far as scenes need them (RFC 3986).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace binosplat {

struct Address {
    std::string text;    // as it is requested: without a fragment, and with letters beyond ASCII encoded
    std::string folder;  // up to its last slash, with it and without what follows a question mark
    std::string server;  // its scheme, host and port
};

// Throws Error if `source` is no http or https address, or names a user, whose password no message repeats.
Address parseAddress(const std::string& source);

// The eight groups of an address in numbers; of an IPv4 one as IPv6 has it (::ffff:0:0/96). None for anything else, as a name is.
std::optional<std::array<std::uint16_t, 8>> parseIp(std::string_view ip);

// True for the address of a machine, in numbers, that is not on the public web: this one, or one on a private network or link. An IPv4
// address within an IPv6 one (mapped, NAT64, 6to4) counts as what it is.
bool isPrivateAddress(const std::string& ip);

// The address of the file `name` in the folder of `address`; for the empty name `address` itself. Throws Error if it would lead out.
std::string addressOf(const Address& address, const std::string& name);

}  // namespace binosplat
