// Some rows of a picture are enough for a small one.
#include "app/view/scenes/picture_copy.h"

#include "engine/picture/turned.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <bit>
#include <utility>
#include <vector>

namespace binosplat {

namespace {

constexpr std::uint64_t kBytes = std::uint64_t{4} << 20;
// A frame waits for the one before the last.
constexpr int kFramesUntilDone = 3;

// Each pixel of what was copied.
Image unpack(const std::vector<gpu::uint>& words, glm::uvec2 size_px, bool half_floats) {
    Image image{size_px, 4, {}};
    for (const gpu::uint word : words) {
        if (half_floats) {
            const glm::vec2 values = glm::unpackHalf2x16(word);
            image.values.insert(image.values.end(), {values.x, values.y});
        } else {
            image.values.push_back(std::bit_cast<float>(word));
        }
    }
    return image;
}

}  // namespace

PictureCopy::PictureCopy(const Context& context)
    : rows_(context, "rows of a picture", kBytes, MemoryKind::kReadback) {}

bool PictureCopy::ask() {
    if (frames_++ == 0) { is_recorded_ = false; }
    const bool is_over = frames_ > kFramesUntilDone || (frames_ > 1 && !is_recorded_);
    if (is_over) { frames_ = 0; }
    return is_over;
}

void PictureCopy::record(Commands& commands, const Picture& picture, const Eye& eye, const Eye& view) {
    if (!isAsked()) { return; }
    const std::uint64_t row_bytes =
        std::uint64_t{picture.size_px.x} * (picture.half_floats ? sizeof(gpu::uvec2) : sizeof(gpu::vec4));
    const auto most_rows =
        static_cast<std::uint32_t>(std::min<std::uint64_t>(kBytes / row_bytes, picture.size_px.y));
    const std::uint32_t step = (picture.size_px.y + most_rows - 1) / most_rows,
                        rows = picture.size_px.y / step;
    std::vector<vk::BufferCopy> parts;
    for (std::uint32_t row = 0; row < rows; ++row) {
        parts.emplace_back(row_bytes * (std::uint64_t{row} * step + step / 2), row_bytes * row, row_bytes);
    }
    commands.copy(picture.colours, rows_, parts);
    // An eye with such long pixels has these rows for a picture.
    eye_ = eye;
    eye_.size_px = {picture.size_px.x, rows};
    eye_.intrinsics.fy /= step;
    eye_.intrinsics.cy = (eye.intrinsics.cy + 0.5 * step - (step / 2 + 0.5)) / step;
    view_ = view;
    half_floats_ = picture.half_floats;
    is_recorded_ = true;
}

std::function<Image()> PictureCopy::take() {
    if (!std::exchange(is_recorded_, false)) { return {}; }
    const auto words = rows_.mapped<gpu::uint>().first(std::size_t{eye_.size_px.x} * eye_.size_px.y *
                                                       (half_floats_ ? 2 : 4));
    return [words = std::vector(words.begin(), words.end()), eye = eye_, view = view_, half = half_floats_] {
        return showTurned(unpack(words, eye.size_px, half), eye, view);
    };
}

}  // namespace binosplat
