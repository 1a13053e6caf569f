// Conversions between light and display-encoded values, from 0 up (IEC 61966-2-1).
#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace binosplat {

inline double lightOf(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
inline double encodedOf(double light) {
    return light <= 0.0031308 ? 12.92 * light : 1.055 * std::pow(light, 1.0 / 2.4) - 0.055;
}

inline glm::dvec3 lightOf(const glm::dvec3& encoded) {
    return {lightOf(encoded.r), lightOf(encoded.g), lightOf(encoded.b)};
}
inline glm::dvec3 encodedOf(const glm::dvec3& light) {
    return {encodedOf(light.r), encodedOf(light.g), encodedOf(light.b)};
}

}  // namespace binosplat
