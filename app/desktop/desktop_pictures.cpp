// One frame of the window.
#include "app/desktop/desktop_pictures.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace binosplat {

namespace {

// Pictures in motion may take this share of the time between two refreshes, and have at least this resolution
// in each direction.
constexpr double kShareOfRefresh = 0.9, kCoarsest = 0.25, kFirst = 0.5;
// An sRGB format, so that the presenter writes encoded values; the images that receive the bytes do not
// decode them either.
constexpr vk::Format kPresented = vk::Format::eR8G8B8A8Srgb, kBytes = vk::Format::eR8G8B8A8Unorm;
constexpr std::uint32_t kRed = 0xff;  // of these

}  // namespace

MotionScale::MotionScale(bool is_software) : scale_(is_software ? kCoarsest : kFirst) {}

void MotionScale::measure(double scale, double gpu_ms, double refresh_hz) {
    if (!(gpu_ms > 0.0)) { return; }
    const double full_ms = gpu_ms / (scale * scale);
    full_ms_ = full_ms_ == 0.0 ? full_ms : glm::mix(full_ms_, full_ms, 0.3);
    // In steps of half the pixels, since a change of size waits for the frames in flight, and only for a
    // clear gain.
    const double most_ms = 1000.0 * kShareOfRefresh / refresh_hz,
                 steps = std::log2(std::max(full_ms_ / most_ms, 1.0)), now = -2.0 * std::log2(scale_);
    if (std::abs(steps - now) > 0.75) { scale_ = std::max(std::exp2(-0.5 * std::round(steps)), kCoarsest); }
}

DesktopPictures::DesktopPictures(const Context& context)
    : context_(context), presenter_(context, kPresented) {
    presenter_.makeKernels();
}

void DesktopPictures::reserve(Pictures& pictures, glm::uvec2 size_px, std::size_t eyes) {
    auto& [images, memory_px, drawn_px] = pictures;
    const bool fits = size_px.x <= memory_px.x && size_px.y <= memory_px.y;
    if (fits && images.at(eyes - 1)) { return; }
    context_.waitForQueue();
    using Usage = vk::ImageUsageFlagBits;
    if (!fits) { memory_px = size_px; }
    for (std::size_t e = 0; e < images.size(); ++e) {
        images[e].reset();
        if (e < eyes) {
            images[e].emplace(context_, "the window's eye", memory_px, kBytes,
                              Usage::eTransferDst | Usage::eTransferSrc | Usage::eColorAttachment);
        }
    }
}

void DesktopPictures::render(StereoFrame& frame, const std::vector<Eye>& eyes, const FrameSettings& settings,
                             WindowStereo stereo, bool waits) {
    shows_quarters_ = false;
    std::optional<FrameResult> known = render(whole_, frame, eyes, settings, stereo, waits);
    if (known) { last_ = std::move(*known); }
    eyes_ = eyes;
}

void DesktopPictures::renderQuarter(int quarter, StereoFrame& frame, const std::vector<Eye>& eyes,
                                    const FrameSettings& settings, WindowStereo stereo) {
    static_cast<void>(
        render(quarters_.at(static_cast<std::size_t>(quarter)), frame, eyes, settings, stereo, true));
}

std::optional<FrameResult> DesktopPictures::render(Pictures& into, StereoFrame& frame,
                                                   const std::vector<Eye>& eyes,
                                                   const FrameSettings& settings, WindowStereo stereo,
                                                   bool waits) {
    const glm::uvec2 size_px = into.size_px = eyes.front().size_px;
    const glm::uvec2 memory_px = glm::max(settings.most_px, size_px);
    reserve(into, memory_px, eyes.size());
    frame.reserve(eyes, settings);
    presenter_.reserve(memory_px, false);
    const auto present = [&](Commands& commands) {
        for (std::size_t e = 0; e < eyes.size(); ++e) {
            const vk::Image image = *into.images[e]->image;
            const WarpBuffers* const tinted_by =
                settings.keep_classes ? frame.chosenTiles(static_cast<int>(e)) : nullptr;
            presenter_.record(commands,
                              {.picture = &frame.picture(static_cast<int>(e)),
                               .size_px = size_px,
                               .tinted_by = tinted_by,
                               .colour = image,
                               .depth = {},
                               // The right eye's image of an anaglyph has the left one's red.
                               .kept_bits = stereo == WindowStereo::kAnaglyph && e == kRight ? kRed : 0},
                              settings.near);
            changeLayout(commands, image, vk::ImageLayout::eColorAttachmentOptimal,
                         vk::ImageLayout::eTransferSrcOptimal);
        }
    };
    if (!waits) { return frame.renderAhead(eyes, settings, present); }
    static_cast<void>(frame.finish());
    return frame.render(eyes, settings, present);
}

void DesktopPictures::compose(Commands& commands, vk::Image window, const std::vector<EyePart>& parts,
                              double from_share) {
    if (eyes_.empty()) { return; }
    const auto blit = [&](const Pictures& pictures, const EyePart& part, const WindowPart& into,
                          double from) {
        const auto from_x = static_cast<std::uint32_t>(std::lround(from * pictures.size_px.x));
        const std::size_t image = eyes_.size() == 1 ? 0 : static_cast<std::size_t>(part.eye);
        blitInto(commands, *pictures.images[image]->image, pictures.size_px, window, into, from_x);
    };
    for (const EyePart& part : parts) {
        if (!shows_quarters_) {
            blit(whole_, part, {glm::ivec2(part.at_px), glm::ivec2(part.size_px)}, from_share);
            continue;
        }
        for (int quarter = 0; quarter < 4; ++quarter) {
            WindowPart into = quarterOf(part.size_px, quarter);
            const double from = (from_share * part.size_px.x - into.at_px.x) / into.size_px.x;
            into.at_px += glm::ivec2(part.at_px);
            blit(quarters_[static_cast<std::size_t>(quarter)], part, into, std::clamp(from, 0.0, 1.0));
        }
    }
}

}  // namespace binosplat
