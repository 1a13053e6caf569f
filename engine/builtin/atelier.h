// The parts of builtin:atelier, one function per file's idea.
#pragma once

#include "engine/builtin/patch.h"

namespace binosplat::builtin {

void addShell(Draft& draft, const Room& room);      // floor, walls, ceiling, window frame, glass, curtains
void addOutside(Draft& draft, const Room& room);    // hills, trees and sky beyond the window
void addFurniture(Draft& draft, const Room& room);  // table, armchair, shelf with books, sideboard, lamp, pictures
void addStillLife(Draft& draft);                    // what lies on the table and the sideboard: the glazed vase, fruit, books
void addForeground(Draft& draft);                   // close to the eye: a lattice screen on the left, a plant on the right

}  // namespace binosplat::builtin
