// Which of a frame's layers a runtime takes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

namespace binosplat {

struct LayersWanted {
    std::size_t most_things = SIZE_MAX;  // in the room: hands, rays and others
    bool panel = true, room = true;      // the panel; the wearer's room behind the scene
    bool operator==(const LayersWanted&) const = default;
};

// A runtime that refuses a frame does not say because of which layer. So frames with less are tried until it
// takes one: with fewer things, without the panel, without the room, with the eyes alone. `isTaken` submits a
// frame, and is false if it is refused. Empty if all are.
inline std::optional<LayersWanted> findTaken(std::size_t things, bool has_panel, bool has_room,
                                             const std::function<bool(const LayersWanted&)>& isTaken) {
    const auto take = [&](const LayersWanted& wanted) {
        return isTaken(wanted) ? std::optional(wanted) : std::nullopt;
    };
    std::optional<LayersWanted> taken;
    while (!taken && things > 0) { taken = take({--things, true, true}); }
    if (!taken && has_panel) { taken = take({SIZE_MAX, false, true}); }
    if (!taken && has_room) { taken = take({SIZE_MAX, true, false}); }
    return taken ? taken : take({0, false, false});
}

}  // namespace binosplat
