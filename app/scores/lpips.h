// LPIPS: how different two pictures look to a network that was trained on photographs. Zhang, Isola, Efros,
// Shechtman, Wang, "The Unreasonable Effectiveness of Deep Features as a Perceptual Metric", CVPR 2018,
// section 3; version 0.1 on SqueezeNet 1.1. Papers mostly print the AlexNet or the VGG variant: figures of
// this one are comparable only with each other.
#pragma once

#include "app/scores/squeezenet.h"
#include "engine/picture/image.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace binosplat {

// The smallest side that leaves the network a pixel.
inline constexpr std::uint32_t kLpipsLeastSide_px = SqueezeNet::kLeastSide_px;

// R, G and B as they are encoded, clamped to 0 to 1 (0 where not finite), scaled and shifted as the network
// was trained:
// (2 value - 1 - mean) / deviation of its channel. Further channels are left out.
Image scaleForNetwork(const Image& picture);

class Lpips {
public:
    // Values in a file of weights: those of SqueezeNet, then a head for each of its stages, one weight per
    // channel.
    static constexpr std::size_t kValues = 724'736;

    // `file`: kValues float32, little endian. Throws Error naming the file if it cannot be read, has another
    // size, or holds a value that is not finite or a negative head.
    explicit Lpips(const std::filesystem::path& file);

    // 0 (alike) or more; below 1 for all but the strangest pictures. After each stage every pixel's features
    // are scaled to length 1; squared differences are weighted by the stage's head, added over channels and
    // averaged over pixels; the stages are added. Symmetric. Infinite where a value of either picture is not
    // finite. Beside the two pictures it holds at most 160 bytes for each pixel of one: 160 MiB at 1024x1024,
    // which takes two cores one to two seconds (6 billion multiplications per picture). The result does not
    // depend on the number of threads. Throws Error if sizes differ, a side is less than kLpipsLeastSide_px,
    // or a picture has fewer than three channels.
    [[nodiscard]] double measure(const Image& a, const Image& b, int threads = 2) const;

    [[nodiscard]] const SqueezeNet& network() const { return network_; }

private:
    Lpips(const std::vector<float>& values, const std::string& file);

    SqueezeNet network_;
    std::array<std::vector<float>, SqueezeNet::kStageChannels.size()> heads_;
    std::string file_;
};

}  // namespace binosplat
