// The mask goes to the device with the commands of its frame.
#include "engine/passes/shown_tiles.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

std::size_t wordsOf(glm::uvec2 size_tiles) { return std::size_t{(size_tiles.x + 31) / 32} * size_tiles.y; }

}  // namespace

void ShownTiles::set(std::span<const std::uint8_t> hidden, glm::uvec2 size_tiles, glm::uvec2 memory_tiles) {
    memory_tiles_ = memory_tiles;
    if (std::ranges::equal(hidden, hidden_) && size_tiles == size_tiles_) { return; }
    hidden_.assign(hidden.begin(), hidden.end());
    size_tiles_ = size_tiles;
    words_.clear();
    if (hidden_.empty()) { return; }
    const std::size_t row_words = (size_tiles.x + 31) / 32;
    words_.resize(wordsOf(size_tiles), 0);
    for (std::size_t y = 0, tile = 0; y < size_tiles.y; ++y) {
        for (std::size_t x = 0; x < size_tiles.x; ++x, ++tile) {
            if (hidden_[tile] == 0) { words_[y * row_words + x / 32] |= 1u << (x % 32); }
        }
    }
}

void ShownTiles::record(Commands& commands) {
    turn_ = 1 - turn_;
    Buffer& mask = masks_[turn_];
    const std::uint64_t bytes = words_.size() * sizeof(gpu::uint),
                        bytes_made = wordsOf(memory_tiles_) * sizeof(gpu::uint);
    // Frames before the last one have finished.
    retired_ = {};
    if (bytes > 0 && mask.madeBytes() != bytes_made) {
        retired_ = std::exchange(mask, Buffer(context_, "shown tiles", bytes_made));
    }
    mask.use(bytes);
    if (bytes > 0) { commands.update(mask, words_.data(), bytes); }
}

void ShownTiles::recordKinds(Commands& commands, const Buffer& kinds, std::uint64_t offset_bytes) const {
    if (!isMasked()) { return; }
    std::vector<gpu::uint> words(hidden_.size());
    std::ranges::transform(hidden_, words.begin(),
                           [](std::uint8_t hidden) { return hidden == 0 ? 0u : gpu::kTileHidden; });
    commands.update(kinds, words.data(), words.size() * sizeof(gpu::uint), offset_bytes);
}

}  // namespace binosplat
