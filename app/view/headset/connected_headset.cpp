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

}  // namespace binosplat
