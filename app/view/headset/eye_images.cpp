// Swapchains of both eyes.
#include "app/view/headset/eye_images.h"

#include "engine/error.h"
#include "xr/images.h"

namespace binosplat {

vk::Format chooseEyeFormat(const xr::Session& session) {
    using Format = vk::Format;
    const std::array wanted{Format::eR8G8B8A8Srgb, Format::eB8G8R8A8Srgb, Format::eR8G8B8A8Unorm,
                            Format::eB8G8R8A8Unorm};
    const Format format = xr::chooseFormat(session, wanted);
    if (format == Format::eUndefined) {
        throw Error(ExitCode::kNoDevice,
                    session.instance().description() + " has no 8-bit RGBA or BGRA images");
    }
    return format;
}

EyeImages::EyeImages(const xr::Session& session, Presenter& presenter, vk::Format format, glm::uvec2 size_px)
    : presenter_(presenter), size_px_(size_px), part_px_(size_px) {
    const std::array depth_formats{vk::Format::eD32Sfloat};
    const bool depth =
        session.instance().takesDepth() && xr::chooseFormat(session, depth_formats) == vk::Format::eD32Sfloat;
    const auto nameOf = [](std::size_t e) -> std::string {
        return e == kLeft ? "the left eye" : "the right eye";
    };
    for (std::size_t e = 0; e < 2; ++e) {
        colour_[e] = xr::Swapchain(session, nameOf(e), size_px, format, xr::ImageUse::kCopy);
    }
    if (!depth) { return; }
    try {
        for (std::size_t e = 0; e < 2; ++e) {
            depth_[e] = xr::Swapchain(session, nameOf(e) + "'s depth", size_px, vk::Format::eD32Sfloat,
                                      xr::ImageUse::kDepth);
        }
    } catch (const Error&) { dropDepth(); }  // offered, but not available: go on without depth
}

void EyeImages::dropDepth() {
    depth_ = {};
    shows_depth_ = {};
}

void EyeImages::noteIdle() {
    for (std::size_t e = 0; e < 2; ++e) {
        colour_[e].noteIdle();
        depth_[e].noteIdle();
    }
}

void EyeImages::acquire(int eye, bool with_depth) {
    const auto e = static_cast<std::size_t>(eye);
    colour_now_[e] = colour_[e].acquire();
    shows_depth_[e] = with_depth && takesDepth();
    if (shows_depth_[e]) { depth_now_[e] = depth_[e].acquire(); }
}

void EyeImages::present(Commands& commands, int eye, const Picture& image, const WarpBuffers* tinted_by,
                        double near) {
    const auto e = static_cast<std::size_t>(eye);
    presenter_.record(commands, {&image, part_px_, tinted_by, colour_now_[e], depth_now_[e], see_through_},
                      near);
}

void EyeImages::clear(Commands& commands, int eye, const glm::vec4& colour) {
    clearImage(commands.buffer(), colour_now_[static_cast<std::size_t>(eye)], colour);
}

void EyeImages::release() {
    for (std::size_t e = 0; e < 2; ++e) {
        if (std::exchange(colour_now_[e], nullptr)) { colour_[e].release(); }
        if (std::exchange(depth_now_[e], nullptr)) { depth_[e].release(); }
    }
}

xr::LayerEye EyeImages::layerEye(int eye, const xr::EyeView& view, double near_m) const {
    const auto e = static_cast<std::size_t>(eye);
    return {view, &colour_[e], shows_depth_[e] ? &depth_[e] : nullptr, near_m, part_px_};
}

}  // namespace binosplat
