// Bringing the mask to the device when it changes.
#include "engine/passes/shown_tiles.h"

#include <algorithm>

namespace binosplat {

void ShownTiles::set(std::span<const std::uint8_t> hidden) {
    if (std::ranges::equal(hidden, hidden_)) { return; }
    hidden_.assign(hidden.begin(), hidden.end());
    hidden_count_ = static_cast<std::uint32_t>(std::ranges::count_if(hidden_, [](std::uint8_t tile) { return tile != 0; }));
    words_ = {};
    upload_ = {};
    if (!hideAny()) { return; }
    std::vector<gpu::uint> words{0}, kinds;
    for (const std::uint8_t tile : hidden_) {
        words.push_back(words.back() + (tile == 0 ? 1 : 0));
        kinds.push_back(tile == 0 ? 0 : gpu::kTileHidden);
    }
    words.insert(words.end(), kinds.begin(), kinds.end());
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
    const std::uint64_t tiles = hidden_.size();
    commands.copy(words_, kinds, tiles * sizeof(gpu::uint), (tiles + 1) * sizeof(gpu::uint), offset_bytes);
}

}  // namespace binosplat
