// The view's edge is dark while the wearer moves by stick, since what only the edge sees move makes people ill.
#pragma once

#include "xr/session.h"

#include <array>
#include <optional>

namespace binosplat {

// Of the picture's half width: what lies nearer to its middle than the first is clear, what is farther than the second is dark.
constexpr double kVignetteClear = 0.55, kVignetteDark = 0.95;

class Vignette {
public:
    // Closes while the wearer `moves` and opens again otherwise, each within a moment.
    void update(bool moves, double step_seconds);
    // A square picture straight before the head, `kVignetteMetres` away: how wide it is, so that it covers what both eyes see. The opening
    // in it grows with it: the wider, the less of it is seen. Empty while nothing of it would be.
    [[nodiscard]] std::optional<double> widthMetres(const std::array<xr::EyeView, 2>& views) const;

private:
    double closed_ = 0.0;  // 0 to 1
};
constexpr double kVignetteMetres = 5.0;

}  // namespace binosplat
