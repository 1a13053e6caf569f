// Copies, and what is worth one.
#include "app/view/kept_picture.h"

#include "engine/error.h"
#include "engine/picture/turned.h"

namespace binosplat {

namespace {

// A scene that was shown for less than a third of a second was only passed through.
constexpr std::uint64_t kLeastFramesSeen = 30;

}  // namespace

bool KeptPicture::isWorthIt() const {
    return scenes_.get() != nullptr && frames_ >= kLeastFramesSeen && !scenes_.drawsOther();
}

void KeptPicture::record(Commands& commands) {
    const std::optional<SeenPicture> seen = renderer_.seenPicture();
    if (scenes_.drawsOther() || !seen) { return; }
    copy_.record(commands, scenes_.frame().picture(seen->eye_of_frame), seen->picture, seen->view);
}

bool KeptPicture::isKept() {
    if (!isWorthIt()) {
        copy_.drop();
        return true;
    }
    if (!copy_.ask()) { return false; }
    frames_ = 0;
    if (std::function<Image()> view = copy_.take()) { notes_.keepPicture(*scenes_.get(), std::move(view)); }
    return true;
}

void KeptPicture::keepAtOnce() {
    const std::optional<SeenPicture> seen = renderer_.seenPicture();
    if (!isWorthIt() || !seen) { return; }
    frames_ = 0;
    try {
        context_.waitForQueue();
        notes_.keepPicture(*scenes_.get(),
                           [picture = scenes_.frame().readPicture(seen->eye_of_frame), seen = *seen] {
                               return showTurned(picture, seen.picture, seen.view);
                           });
    } catch (const vk::DeviceLostError&) { throw; } catch (const vk::SystemError&) {
        // A missing picture is not worth a message.
    } catch (const Error&) {}
}

}  // namespace binosplat
