// Draws the bent arc into flat pictures.
#include "app/view/room/arc_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace binosplat {

namespace {

constexpr double kHalfWidthMetres = 0.006;
constexpr double kMostGrowth =
    2.0;  // of what is in front of its picture, for an eye that is close to its plane

// Where the eye sees the points in the picture's plane, in metres from its middle.
std::vector<glm::dvec2> seenIn(const Strip& place, std::span<const glm::dvec3> points,
                               const glm::dvec3& eye) {
    const Pose picture_from_room = inverse(place.room_from_strip);
    const glm::dvec3 eye_there = transform(picture_from_room, eye);
    std::vector<glm::dvec2> seen;
    for (const glm::dvec3& point : points) {
        const glm::dvec3 there = transform(picture_from_room, point);
        const double growth = -eye_there.z / std::max(there.z - eye_there.z, -eye_there.z / kMostGrowth);
        seen.push_back(glm::mix(glm::dvec2(eye_there), glm::dvec2(there), growth));
    }
    return seen;
}

double distanceTo(const std::vector<glm::dvec2>& line, const glm::dvec2& at) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const glm::dvec2 along = line[i + 1] - line[i];
        const double t =
            std::clamp(glm::dot(at - line[i], along) / std::max(glm::dot(along, along), 1e-12), 0.0, 1.0);
        least = std::min(least, glm::distance(at, line[i] + t * along));
    }
    return least;
}

// Opaque in its middle, soft at its edges.
double alphaAt(double distance_m) {
    const double t = std::clamp(2.0 - 2.0 * distance_m / kHalfWidthMetres, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

}  // namespace

ArcPicture drawArc(const Arc& arc, const glm::dvec3& eye, const TexelLayout& layout) {
    ArcPicture drawn{{}, {kArcPx, std::vector<std::uint32_t>(std::size_t{kArcPx.x} * kArcPx.y, 0)}};
    for (std::size_t piece = 0; piece < kArcPieces && !arc.points.empty(); ++piece) {
        const auto points = std::span(arc.points).subspan(piece * kPointsOfPiece, kPointsOfPiece + 1);
        std::optional<Strip>& place = drawn.places[piece];
        place = stripBetween(points.front(), points.back(), 2.0 * kHalfWidthMetres, eye);
        if (!place) { continue; }
        const std::vector<glm::dvec2> line = seenIn(*place, points, eye);
        glm::dvec2 half(0.0);
        for (const glm::dvec2& at : line) { half = glm::max(half, glm::abs(at)); }
        // The border has only transparent texels, since filters read beyond it.
        place->size_m =
            2.0 * (half + kHalfWidthMetres) * glm::dvec2(kArcPiecePx) / (glm::dvec2(kArcPiecePx) - 4.0);
        const glm::dvec2 texel_m = place->size_m / glm::dvec2(kArcPiecePx);
        for (std::uint32_t y = 0; y < kArcPiecePx.y; ++y) {
            for (std::uint32_t x = 0; x < kArcPiecePx.x; ++x) {
                const double alpha =
                    alphaAt(distanceTo(line, (glm::dvec2(x, y) + 0.5) * texel_m - 0.5 * place->size_m));
                drawn.picture.texels[std::size_t{y} * kArcPx.x + piece * kArcPiecePx.x + x] =
                    texelOf(arc.is_blocked ? kBlockedLight : kRayLight, alpha, layout);
            }
        }
    }
    return drawn;
}

}  // namespace binosplat
