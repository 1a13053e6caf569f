// The parts of builtin:atelier.
#pragma once

#include "engine/builtin/patch.h"

namespace binosplat::builtin {

void addShell(Draft& draft, const Room& room);    // floor, walls, ceiling, window frame, glass, curtains
void addOutside(Draft& draft, const Room& room);  // hills, trees and sky beyond the window
// Table, armchair, shelf with books, sideboard, lamp, pictures.
void addFurniture(Draft& draft, const Room& room);
// What lies on the table and the sideboard: the glazed vase, fruit, books.
void addStillLife(Draft& draft);
// Close to the eye: a lattice screen on the left, a plant on the right.
void addForeground(Draft& draft);

}  // namespace binosplat::builtin
