// A smooth arc in the room: a picture for each of its pieces, which hangs along the piece and faces the eye.
#pragma once

#include "app/view/room/sprites.h"

#include <array>
#include <optional>
#include <span>

namespace binosplat {

// As few as leave room for everything else among the 16 layers that every runtime takes.
inline constexpr std::size_t kArcPieces = 6, kPointsOfPiece = 8;
inline constexpr glm::uvec2 kArcPiecePx(48, 128), kArcPx(kArcPieces*kArcPiecePx.x, kArcPiecePx.y);

// Of something thrown.
struct Arc {
    std::vector<glm::dvec3> points;  // from the hand on; kArcPieces * kPointsOfPiece + 1 of them, or none
    bool is_blocked = false;         // something stands in its way, or before its end
};

struct ArcPicture {
    std::array<std::optional<Strip>, kArcPieces> places;  // empty: the eye looks along that piece
    TexelPicture picture;                                 // the pieces side by side, as `eye` sees them
};
ArcPicture drawArc(const Arc& arc, const glm::dvec3& eye, const TexelLayout& layout);

}  // namespace binosplat
