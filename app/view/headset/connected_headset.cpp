// A session and its images.
#include "app/view/headset/connected_headset.h"

namespace binosplat {

ConnectedHeadset::ConnectedHeadset(const xr::Instance& instance, const Context& context, glm::uvec2 panel_px)
    : inset(xr::findInset(instance)),
      session(instance, context, inset ? xr::kStereoWithInset : xr::kStereo),
      format(chooseEyeFormat(session)),
      refresh_rates(session.refreshRates()),
      input(session),
      panel_images(session, "the panel", panel_px, format, xr::ImageUse::kFar),
      things(session, context, format) {}

template <typename Act>
void ConnectedHeadset::forEyes(const Act& act) {
    for (EyeImages* const of : {images.get(), inset ? inset_images.get() : nullptr}) {
        if (of != nullptr) { act(*of); }
    }
}

void ConnectedHeadset::acquireEyes() {
    forEyes([](EyeImages& of) {
        for (const int e : {kLeft, kRight}) { of.acquire(e, false); }
    });
}

void ConnectedHeadset::clearEyes(Commands& commands, const glm::vec4& colour) {
    forEyes([&](EyeImages& of) {
        for (const int e : {kLeft, kRight}) { of.clear(commands, e, colour); }
    });
}

void ConnectedHeadset::releaseEyes() {
    forEyes([](EyeImages& of) { of.release(); });
}

}  // namespace binosplat
