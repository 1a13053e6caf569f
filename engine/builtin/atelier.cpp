// builtin:atelier: puts the room together, and says where to stand in it.
#include "engine/builtin/atelier.h"

#include "engine/builtin/builtin.h"

namespace binosplat::builtin {

Scene makeAtelier(std::uint64_t splats, const Progress& progress) {
    const Room room;
    Draft draft;
    addShell(draft, room);
    addOutside(draft, room);
    addFurniture(draft, room);
    addStillLife(draft);
    addForeground(draft);
    return draft.make(splats, room, progress);
}

// Lattice 0.65 to 0.75 m deep on the left, leaves 0.4 to 0.8 m on the right, hills at 40 to 400 m through the
// window.
View atelierView() { return {{0.1, -1.45, 0.35}, {0.02, -1.06, 5.0}, {0.0, -1.0, 0.0}, 70.0}; }

}  // namespace binosplat::builtin
