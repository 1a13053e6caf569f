// Typed values from settings. Every error is one line: the place, the value, the allowed range.
#pragma once

#include "engine/setup/settings.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace binosplat {

// The largest picture side; a side of 0 is an error too.
inline constexpr std::uint32_t kMaxSide = 16384;

// A finite number of the C locale, nothing around it.
std::optional<double> parseNumber(std::string_view text);

double readNumber(const Setting& setting, double least, double most);
double readShare(const Setting& setting);  // 0 to 1, also in per cent: 20%
double readPositive(const Setting& setting);
std::uint64_t readCount(const Setting& setting, std::uint64_t least, std::uint64_t most);
glm::dvec3 readVector(const Setting& setting);
glm::dvec3 readDirection(const Setting& setting);  // of any length but 0
glm::dvec3 readColour(const Setting& setting);
glm::dvec4 readSphere(const Setting& setting);  // centre and radius, which is over 0
glm::uvec2 readSize(const Setting& setting);    // WIDTHxHEIGHT, or one number for both
bool readFlag(const Setting& setting);
std::string readText(const Setting& setting);

// One of `names`.
std::string readChoice(const Setting& setting, const std::vector<std::string_view>& names);

}  // namespace binosplat
