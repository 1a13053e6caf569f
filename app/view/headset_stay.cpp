// A session and its images.
#include "app/view/headset_stay.h"

namespace binosplat {

namespace {

constexpr glm::uvec2 kRayPx(8, 8);
constexpr glm::vec4 kRayColour(1.0f, 0.7f, 0.1f, 1.0f);

}  // namespace

HeadsetStay::HeadsetStay(const xr::Instance& instance, const Context& context, glm::uvec2 panel_px)
    : session(instance, context),
      format(chooseEyeFormat(session)),
      input(session),
      panel_images(session, "the panel", panel_px, format, xr::ImageUse::kDraw),
      ray_image(session, "the ray", kRayPx, format, xr::ImageUse::kDraw) {
    Commands commands(context);
    commands.begin();
    commands.clearImage(ray_image.acquire(), kRayColour);
    commands.submitAndWait();
    ray_image.release();
}

}  // namespace binosplat
