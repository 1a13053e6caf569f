// After a jump the view comes out of the dark, since eyes that are moved at once make people ill.
#pragma once

#include "engine/similarity.h"

#include <optional>

namespace binosplat {

class Fade {
public:
    // `placed`: where the room lies in the scene in this frame; `is_new`: what is seen has changed by more
    // than a place.
    void update(const Similarity& placed, const Pose& room_from_head, bool is_new, double step_seconds);
    // 0 to 1.
    [[nodiscard]] double darkness() const { return darkness_; }

private:
    std::optional<Similarity> placed_;  // in the frame before
    double darkness_ = 0.0;
};

}  // namespace binosplat
