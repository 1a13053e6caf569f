// The view's edge is dark while the wearer moves by stick, since motion seen only at the edge makes people
// ill.
#pragma once

#include "xr/session.h"

#include <array>
#include <optional>

namespace binosplat {

// In shares of the picture's half width: clear nearer to the middle than the first, dark beyond the second.
constexpr double kVignetteClear = 0.55, kVignetteDark = 0.95;

// The width of a square picture straight ahead of the head, `kVignetteMetres` away, that covers what both
// eyes see.
constexpr double kVignetteMetres = 5.0;
[[nodiscard]] double coverMetres(const std::array<xr::EyeView, 2>& views);

class Vignette {
public:
    // Closes while the wearer `moves` and opens again otherwise, each within a moment.
    void update(bool moves, double step_seconds);
    // The width of its picture, at least coverMetres(). Its opening grows with it: the wider it is, the less
    // of it is seen. Empty while nothing of it would be seen.
    [[nodiscard]] std::optional<double> widthMetres(const std::array<xr::EyeView, 2>& views) const;

private:
    double closed_ = 0.0;  // 0 to 1
};

}  // namespace binosplat
