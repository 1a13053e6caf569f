// Reads the last frame's results on the host.
#include "engine/frame/stereo_frame.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <bit>
#include <cstddef>

namespace binosplat {
namespace {

// D of a pixel with this word.
float depthOf(gpu::uint word, float alpha) {
    // See lib/moving_pixel.glsl.
    const float inverse_depth = word == 0 ? 0.0f : std::bit_cast<float>(((word >> 6) - 1) << 5);
    return inverse_depth > 0.0f ? alpha / inverse_depth : 0.0f;
}

}  // namespace

template <typename T>
std::vector<T> StereoFrame::readBuffer(const Buffer& buffer, std::uint64_t most_bytes,
                                       std::uint64_t from_byte) {
    const std::uint64_t bytes = std::min(buffer.bytes() - std::min(buffer.bytes(), from_byte), most_bytes);
    if (bytes == 0) { return {}; }
    const Buffer readback(context_, "read-back", bytes, MemoryKind::kReadback);
    finish();
    Commands& commands = flight().commands;
    commands.begin();
    commands.copy(buffer, readback, bytes, from_byte);
    commands.submitAndWait();
    const auto values = readback.mapped<T>();
    return {values.begin(), values.end()};
}

Image StereoFrame::readPicture(int eye) {
    const Picture& source = picture(eye);
    Image result{source.size_px, 4, {}};
    if (!source.half_floats) {
        result.values = readBuffer<float>(source.colours);
        return result;
    }
    for (const gpu::uint pair : readBuffer<gpu::uint>(source.colours)) {
        const glm::vec2 values = glm::unpackHalf2x16(pair);
        result.values.insert(result.values.end(), {values.x, values.y});
    }
    return result;
}
Image StereoFrame::readDepth(int eye) {
    const Picture& source = picture(eye);
    if (source.words.bytes() == 0) { return {source.size_px, 1, readBuffer<float>(source.depths)}; }
    const Image colours = readPicture(eye);
    Image depth{source.size_px, 1, {}};
    for (const gpu::uint word : readBuffer<gpu::uint>(source.words)) {
        depth.values.push_back(depthOf(word, colours.values[4 * depth.values.size() + 3]));
    }
    return depth;
}

std::optional<double> StereoFrame::depthAt(int eye, glm::uvec2 pixel) {
    const Picture& source = picture(eye);
    const std::uint64_t at = std::uint64_t{pixel.y} * source.size_px.x + pixel.x;
    const bool has_words = source.words.bytes() > 0;
    if (!has_words && source.depths.bytes() == 0) { return std::nullopt; }
    const float alpha =
        source.half_floats
            ? glm::unpackHalf2x16(
                  readBuffer<gpu::uint>(source.colours, sizeof(gpu::uint), (2 * at + 1) * sizeof(gpu::uint))
                      .at(0))
                  .y
            : readBuffer<float>(source.colours, sizeof(float), (4 * at + 3) * sizeof(float)).at(0);
    if (alpha < 0.5f) { return std::nullopt; }
    const float depth =
        has_words
            ? depthOf(readBuffer<gpu::uint>(source.words, sizeof(gpu::uint), at * sizeof(gpu::uint)).at(0),
                      alpha)
            : readBuffer<float>(source.depths, sizeof(float), at * sizeof(float)).at(0);
    // An alpha of just under a half may be stored as a half: the surface is none.
    if (!(depth > 0.0f)) { return std::nullopt; }
    return static_cast<double>(depth) / static_cast<double>(alpha);
}

Image StereoFrame::readInverseDepthMoments() {
    return {picture(plan_.firstTarget()).size_px, 2, readBuffer<float>(memory_.moments())};
}

const WarpBuffers* StereoFrame::chosenTiles(int eye) const {
    if (static_cast<std::size_t>(eye) >= plan_.targets.size()) { return nullptr; }
    const TargetPlan& target = plan_.targets[static_cast<std::size_t>(eye)];
    return target.warp || target.history ? &memory_.warp(eye) : nullptr;
}

std::vector<std::uint32_t> StereoFrame::readTileKinds(int eye) {
    const WarpBuffers* choice = chosenTiles(eye);
    if (choice == nullptr) { return {}; }
    return readBuffer<std::uint32_t>(choice->tiles(), choice->tileCount() * sizeof(gpu::uint));
}

std::vector<std::uint32_t> StereoFrame::readTileKinds() {
    const std::optional<int> warped = plan_.warpedTarget();
    if (warped) { return readTileKinds(*warped); }
    // Or that of the single eye that is made from the other.
    const bool of_left = !plan_.targets[kLeft].history.has_value();
    return plan_.eyes == 2 && of_left == plan_.targets[kRight].history.has_value()
               ? readTileKinds(of_left ? kRight : kLeft)
               : std::vector<std::uint32_t>{};
}

std::vector<std::uint8_t> StereoFrame::readPixelClasses() {
    const std::vector<std::uint32_t> words = readBuffer<std::uint32_t>(warpBuffers().classesBuffer());
    if (words.empty()) { return {}; }
    const glm::uvec2 size = warpBuffers().sizePx();
    const std::size_t row_words = tilesOf(size).x;
    std::vector<std::uint8_t> classes(std::size_t{size.x} * size.y);
    for (std::size_t i = 0; i < classes.size(); ++i) {
        const std::size_t x = i % size.x, word = i / size.x * row_words + x / gpu::kTileSize;
        classes[i] = static_cast<std::uint8_t>((words[word] >> (2 * (x % gpu::kTileSize))) & 3);
    }
    return classes;
}

}  // namespace binosplat
