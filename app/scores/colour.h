// Colour spaces a picture is compared in. Luminance 1 is the display's white, D65.
#pragma once

#include <glm/glm.hpp>

namespace binosplat {

// The display's transfer curve, each channel from 0 to 1 (IEC 61966-2-1, section 5.2).
glm::vec3 linearFromEncoded(const glm::vec3& encoded);

// Linear sRGB and CIE XYZ, by the primaries and the white of IEC 61966-2-1, section 4.1; white is XYZ
// (0.9505, 1, 1.0891).
glm::vec3 xyzFromLinear(const glm::vec3& linear);
glm::vec3 linearFromXyz(const glm::vec3& xyz);

// Opponent colours linear in XYZ: Y lightness-like from -16 to 100, Cx red against green, Cz blue against
// yellow (Andersson et al. 2020, section 4.1).
glm::vec3 ycxczFromXyz(const glm::vec3& xyz);
glm::vec3 xyzFromYcxcz(const glm::vec3& ycxcz);

// CIE L*a*b* (CIE 15:2004, section 8.2.1); white is (100, 0, 0).
glm::vec3 labFromXyz(const glm::vec3& xyz);

}  // namespace binosplat
