// The most important gestures, shown in front of the eyes when the viewer is first started.
#pragma once

#include "app/view/files/file_worker.h"
#include "app/view/room/sprites.h"
#include "app/view/settings/view_settings.h"

#include <optional>

namespace binosplat {

// Walking and turning; teleporting; the panel.
inline constexpr std::size_t kGestures = 3;
// A gesture's text next to a small drawing of it; see drawMessage.
TexelPicture drawGesture(std::size_t gesture, const TexelLayout& layout);

// Shows them one after another. A file in the user's folder records that they were shown.
class FirstSteps {
public:
    static constexpr double kSecondsEach = 7.0;

    // `files` checks whether they were shown before, and records that they were; it must outlive this.
    FirstSteps(FileWorker& files, FirstStepsShown shown) : files_(files), shown_(shown) {}
    FirstSteps(const FirstSteps&) = delete;
    FirstSteps& operator=(const FirstSteps&) = delete;

    // Once a frame, while nothing else is shown there: the gesture that begins in it, if any.
    std::optional<std::size_t> update(double step_seconds);
    [[nodiscard]] bool areShown() const { return seconds_left_ > 0.0; }

private:
    void look();

    FileWorker& files_;
    FirstStepsShown shown_;
    bool has_looked_ = false;
    std::size_t next_ = kGestures;  // until it is known that they are wanted
    double seconds_left_ = 0.0;     // for the gesture that is shown
};

}  // namespace binosplat
