// Uploading the mask when it changes.
#include "engine/passes/shown_tiles.h"

#include <algorithm>

namespace binosplat {

bool ShownTiles::isOf(std::span<const std::uint8_t> hidden, glm::uvec2 size_tiles) const {
    return std::ranges::equal(hidden, hidden_) && (hidden.empty() || size_tiles == size_tiles_);
}

void ShownTiles::set(std::span<const std::uint8_t> hidden, glm::uvec2 size_tiles) {
    if (isOf(hidden, size_tiles)) { return; }
    hidden_.assign(hidden.begin(), hidden.end());
    size_tiles_ = size_tiles;
    hidden_count_ = static_cast<std::uint32_t>(std::ranges::count_if(hidden_, [](std::uint8_t tile) { return tile != 0; }));
    words_ = {};
    upload_ = {};
    if (!hideAny()) { return; }
    const std::size_t row_words = (size_tiles.x + 31) / 32;
    mask_words_ = row_words * size_tiles.y;
    std::vector<gpu::uint> words(mask_words_, 0);
    for (std::size_t tile = 0; tile < hidden_.size(); ++tile) {
        const std::size_t x = tile % size_tiles.x, y = tile / size_tiles.x;
        if (hidden_[tile] == 0) { words[y * row_words + x / 32] |= 1u << (x % 32); }
        words.push_back(hidden_[tile] == 0 ? 0 : gpu::kTileHidden);
    }
    const std::uint64_t bytes = words.size() * sizeof(gpu::uint);
    words_ = Buffer(context_, "shown tiles", bytes);
    upload_ = Buffer(context_, "shown tiles on their way", bytes, MemoryKind::kUpload);
    std::ranges::copy(words, upload_.mapped<gpu::uint>().begin());
}

void ShownTiles::record(Commands& commands) {
    if (upload_.bytes() > 0) { commands.copy(upload_, words_, upload_.bytes()); }
}

void ShownTiles::recordKinds(Commands& commands, const Buffer& kinds, std::uint64_t offset_bytes) const {
    if (!hideAny()) { return; }
    commands.copy(words_, kinds, hidden_.size() * sizeof(gpu::uint), mask_words_ * sizeof(gpu::uint), offset_bytes);
}

}  // namespace binosplat
