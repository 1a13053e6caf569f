// What the wearer of a named headset notices in both eyes' pictures through its lenses, when the eye sees
// less and less towards their edges.
#pragma once

#include "app/options/camera_options.h"
#include "app/scores/lens_view.h"
#include "app/scores/visible_errors.h"

#include <array>

namespace binosplat {

// Eyes turn this far from a lens's centre before the head follows, so within this angle they see everything.
inline constexpr double kEyesTurn_deg = 15.0;

class SeenThroughLens {
public:
    explicit SeenThroughLens(const Cameras& cameras);

    // Both eyes' pictures as shown, of the cameras' size, through the lenses.
    [[nodiscard]] std::array<Image, 2> show(const std::array<Image, 2>& pictures) const;
    // For pictures from show(). An eye is assumed to resolve as much as in `price` and `tile_ranges`
    // (reference::seenShare), and to look anywhere within kEyesTurn_deg of its lens's centre, whatever the
    // method's foveation.
    [[nodiscard]] VisibleErrors find(const std::array<Image, 2>& pictures,
                                     const std::array<Image, 2>& full) const {
        return findSeenErrors(pictures, full, sights_);
    }

private:
    LensView lens_;
    std::array<Sight, 2> sights_;
};

}  // namespace binosplat
