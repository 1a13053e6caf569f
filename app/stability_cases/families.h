// Curves of the catalogue, and the bounds that most of them satisfy.
#pragma once

#include "app/stability_cases/catalogue.h"

namespace binosplat::stability {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

// One curve: `make` takes the values of the parameter in turn.
struct Family {
    const char* name;
    const char* parameter;
    std::vector<double> values;
    Stage (*make)(double value);
    Bound rendered, moved;
    const char* reason;
    Bound beyond = {0.0, 1.0};      // what is left where the parameter
    double told_from = -kInfinity;  // is below this
    double told_to = kInfinity;     // or above this
};

// Pictures of ordinary scenes agree to 80 dB and more. A threshold across which rounding moves a value costs
// up to 1/255 of a value where alpha falls to 1/255, and few pixels are so near to one.
inline constexpr Bound kRounding{65.0, 0.0005};
// If a reprojected pixel's place rounds to the next pixel, or a tile is chosen in place of one that is
// expected to gain as much, single pixels differ by as much as their neighbours do.
inline constexpr Bound kPlaces{40.0, 0.01, kInfinity, 0.15};
// On the device, discs that cross the near plane are bounded by boxes: it counts some as visible that, as the
// twin knows, do not reach a pixel, and therefore expects errors elsewhere.
inline constexpr Bound kPlacesOfCut{40.0, 0.01, kInfinity, 0.35};

std::vector<Family> makeDiscFamilies();
std::vector<Family> makeGaussianFamilies();

// A case of one stage.
Case standAlone(std::string family, std::function<Stage()> make, std::string reason);
void addGaussianCases(std::vector<Case>& cases);

}  // namespace binosplat::stability
