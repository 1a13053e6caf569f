// Colour spaces, from the chromaticities of sRGB.
#include "app/scores/colour.h"

#include <cmath>

namespace binosplat {

namespace {

// XYZ of a colour of luminance 1 with chromaticity (x, y).
glm::dvec3 xyzOf(double x, double y) { return {x / y, 1.0, (1.0 - x - y) / y}; }

const glm::dvec3 kWhite = xyzOf(0.3127, 0.3290);

// The primaries' columns are scaled so that together they make white.
glm::dmat3 makeXyzFromLinear() {
    const glm::dmat3 primaries(xyzOf(0.64, 0.33), xyzOf(0.30, 0.60), xyzOf(0.15, 0.06));
    const glm::dvec3 luminance = glm::inverse(primaries) * kWhite;
    return {primaries[0] * luminance.r, primaries[1] * luminance.g, primaries[2] * luminance.b};
}

const glm::mat3 kXyzFromLinear(makeXyzFromLinear());
const glm::mat3 kLinearFromXyz(glm::inverse(makeXyzFromLinear()));
const glm::vec3 kWhiteXyz(kWhite);

float channelFromEncoded(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

// The cube root or, below (6/29)^3, its tangent at that point.
float compress(float share) {
    constexpr float kKnee = 6.0f / 29.0f;
    return share > kKnee * kKnee * kKnee ? std::cbrt(share) : share / (3.0f * kKnee * kKnee) + 4.0f / 29.0f;
}

}  // namespace

glm::vec3 linearFromEncoded(const glm::vec3& encoded) {
    return {channelFromEncoded(encoded.r), channelFromEncoded(encoded.g), channelFromEncoded(encoded.b)};
}

glm::vec3 xyzFromLinear(const glm::vec3& linear) { return kXyzFromLinear * linear; }

glm::vec3 linearFromXyz(const glm::vec3& xyz) { return kLinearFromXyz * xyz; }

glm::vec3 ycxczFromXyz(const glm::vec3& xyz) {
    const glm::vec3 share = xyz / kWhiteXyz;
    return {116.0f * share.y - 16.0f, 500.0f * (share.x - share.y), 200.0f * (share.y - share.z)};
}

glm::vec3 xyzFromYcxcz(const glm::vec3& ycxcz) {
    const float y = (ycxcz.x + 16.0f) / 116.0f;
    return kWhiteXyz * glm::vec3(y + ycxcz.y / 500.0f, y, y - ycxcz.z / 200.0f);
}

glm::vec3 labFromXyz(const glm::vec3& xyz) {
    const glm::vec3 share = xyz / kWhiteXyz;
    const float x = compress(share.x), y = compress(share.y), z = compress(share.z);
    return {116.0f * y - 16.0f, 500.0f * (x - y), 200.0f * (y - z)};
}

}  // namespace binosplat
