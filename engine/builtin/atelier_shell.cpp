// The room itself: boards, plaster over panelling, the window with its frame, glass and curtains.
#include "engine/builtin/atelier.h"
#include "engine/builtin/noise.h"
#include "engine/builtin/shapes.h"

#include <array>
#include <cmath>
#include <vector>

namespace binosplat::builtin {

namespace {

constexpr float kDadoHeight = 0.92f;  // top of the wooden panelling
const glm::vec3 kWhitePaint(0.80f, 0.79f, 0.75f);

// Boards along z, 14 cm wide and about 1.6 m long, each with its own tone; grain along the board, dark
// joints.
Material woodenFloor(const glm::vec3& p) {
    const float column = std::floor(p.x / 0.14f);
    const std::uint32_t column_seed =
        hash(static_cast<std::uint32_t>(static_cast<std::int32_t>(column)), 11u);
    const float along = p.z / 1.6f + unitFloat(column_seed);
    const std::uint32_t board =
        hash(column_seed, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(along))));
    const float tone = unitFloat(board);
    const float grain = fractalNoise({p.x * 55.0f + 31.0f * tone, p.z * 2.2f}, board & 1023u);
    glm::vec3 colour = glm::mix(glm::vec3(0.33f, 0.175f, 0.085f), glm::vec3(0.52f, 0.31f, 0.16f),
                                0.25f + 0.45f * tone + 0.5f * (grain - 0.5f));
    const float x = p.x / 0.14f - column, z = along - std::floor(along);
    const float joint = std::min({x, 1.0f - x, 11.0f * z, 11.0f * (1.0f - z)}) * 0.14f;
    colour *= glm::mix(0.35f, 1.0f, glm::smoothstep(0.0f, 0.006f, joint));
    return {colour, glm::vec3(0.0f), 0.98f};
}

// Sage plaster above a rail, painted panels below, a skirting at the floor. `along` is the coordinate along
// the wall.
Material wall(float along, float y) {
    const float height = -y;
    if (height > kDadoHeight) {
        const float rail = 1.0f - glm::smoothstep(0.0f, 0.012f, height - kDadoHeight);
        // A small damask-like repeat, barely lighter than the ground.
        const glm::vec2 cell(along / 0.22f, height / 0.22f);
        const glm::vec2 f = glm::fract(glm::vec2(cell.x + 0.5f * std::floor(cell.y), cell.y)) - 0.5f;
        const float petals = glm::length(f) * (1.0f + 0.35f * std::cos(4.0f * std::atan2(f.y, f.x)));
        const float ornament = 1.0f - glm::smoothstep(0.20f, 0.26f, petals);
        const float blotch = fractalNoise({along * 2.3f, y * 2.3f}, 5u) - 0.5f;
        glm::vec3 colour =
            glm::mix(glm::vec3(0.36f, 0.43f, 0.36f), glm::vec3(0.43f, 0.50f, 0.41f), ornament) *
            (1.0f + 0.12f * blotch);
        return {glm::mix(colour, 0.55f * kWhitePaint, rail), glm::vec3(0.0f), 0.98f};
    }
    float shade = 1.0f;
    if (height < 0.12f) {
        shade = 0.94f - 0.4f * (1.0f - glm::smoothstep(0.0f, 0.01f, 0.12f - height));
    } else if (height < kDadoHeight - 0.05f) {
        // Panels 62 cm wide; the moulding is lit from above, so its upper inner edge is dark and its lower
        // one bright.
        const float u = along / 0.62f - std::floor(along / 0.62f);
        const float side = std::min(u, 1.0f - u) * 0.62f - 0.05f, top = kDadoHeight - 0.12f - height,
                    bottom = height - 0.19f;
        const auto line = [](float distance) {
            return 1.0f - glm::smoothstep(0.004f, 0.014f, std::abs(distance));
        };
        if (side > -0.02f && top > -0.02f && bottom > -0.02f) {
            shade += 0.16f * line(bottom) - 0.30f * line(top) - 0.18f * line(side);
        }
        if (side > 0.0f && top > 0.0f && bottom > 0.0f) { shade *= 0.96f; }
    } else {
        shade = 1.05f - 0.35f * (1.0f - glm::smoothstep(0.0f, 0.012f, height - (kDadoHeight - 0.05f)));
    }
    return {kWhitePaint * shade, glm::vec3(0.0f), 0.98f};
}

// The rug: a border of triangles around a field of nested diamonds. `at` in its own metres from its middle.
Material rugPattern(const glm::vec2& at, const glm::vec2& half) {
    const glm::vec3 red(0.27f, 0.04f, 0.03f), navy(0.045f, 0.06f, 0.15f), sand(0.62f, 0.50f, 0.33f),
        rust(0.40f, 0.13f, 0.045f);
    const glm::vec2 edge = half - glm::abs(at);
    const float inset = std::min(edge.x, edge.y);
    glm::vec3 colour;
    if (inset < 0.05f) {
        colour = navy;
    } else if (inset < 0.20f) {
        const float along = edge.x < edge.y ? at.y : at.x;
        const float tooth = std::abs(glm::fract(along / 0.15f) - 0.5f) * 0.3f;
        colour = inset - 0.05f < tooth ? sand : rust;
    } else if (inset < 0.235f) {
        colour = sand;
    } else {
        const glm::vec2 cell = glm::fract(at / glm::vec2(0.52f, 0.44f) + 0.5f) - 0.5f;
        const float diamond = std::abs(cell.x) + std::abs(cell.y);
        colour = diamond < 0.10f   ? sand
                 : diamond < 0.20f ? navy
                 : diamond < 0.27f ? sand
                 : diamond < 0.42f ? rust
                                   : red;
    }
    const float pile = fractalNoise(at * 60.0f, 3u);
    return {colour * (0.8f + 0.4f * pile), glm::vec3(0.0f), 0.97f};
}

void addFloorAndRug(Draft& draft, const Room& room) {
    const glm::vec3 size = room.max - room.min;
    const glm::vec2 rug_min(-1.45f, 1.45f), rug_max(1.55f, 3.75f);  // x, z
    const Quad floor{{room.min.x, room.max.y, room.min.z},
                     {size.x, 0.0f, 0.0f},
                     {0.0f, 0.0f, size.z},
                     {0.0f, -100.0f, 2.5f}};
    const std::array<glm::vec4, 1> hole{glm::vec4((rug_min.x - room.min.x) / size.x, rug_min.y / size.z,
                                                  (rug_max.x - room.min.x) / size.x, rug_max.y / size.z)};
    addQuadAround(
        draft, floor, hole, [](const glm::vec3& p, const glm::vec2&) { return woodenFloor(p); }, 1.3f);
    const glm::vec2 middle = 0.5f * (rug_min + rug_max), half = 0.5f * (rug_max - rug_min);
    addQuad(
        draft,
        {{rug_min.x, -0.012f, rug_min.y},
         {2.0f * half.x, 0.0f, 0.0f},
         {0.0f, 0.0f, 2.0f * half.y},
         floor.towards},
        [=](const glm::vec3& p, const glm::vec2&) { return rugPattern(glm::vec2(p.x, p.z) - middle, half); },
        2.2f);
}

void addWalls(Draft& draft, const Room& room) {
    const glm::vec3 size = room.max - room.min, middle = 0.5f * (room.min + room.max);
    const glm::vec3 across(size.x, 0.0f, 0.0f), down(0.0f, size.y, 0.0f), deep(0.0f, 0.0f, size.z);
    const MaterialAt by_x = [](const glm::vec3& p, const glm::vec2&) { return wall(p.x, p.y); };
    const MaterialAt by_z = [](const glm::vec3& p, const glm::vec2&) { return wall(p.z, p.y); };

    const auto holeOn = [&](float u0, float v0, float u1, float v1, float u_size) {
        return glm::vec4(u0 / u_size, v0 / size.y, u1 / u_size, v1 / size.y);
    };
    const std::array<glm::vec4, 2> far_holes{
        holeOn(room.window_min.x - room.min.x, room.window_min.y - room.min.y, room.window_max.x - room.min.x,
               room.window_max.y - room.min.y, size.x),
        // The window, and the picture of addFurniture.
        holeOn(4.47f, 0.72f, 5.43f, 1.88f, size.x)};
    addQuadAround(draft, {{room.min.x, room.min.y, room.max.z}, across, down, middle}, far_holes, by_x, 1.0f);
    const std::array<glm::vec4, 1> left_holes{holeOn(2.3f, 0.5f, 4.5f, 2.8f, size.z)};  // the shelf
    addQuadAround(draft, {room.min, deep, down, middle}, left_holes, by_z, 0.9f);
    // The large picture.
    const std::array<glm::vec4, 1> right_holes{holeOn(2.1f, 0.62f, 3.7f, 1.72f, size.z)};
    addQuadAround(draft, {{room.max.x, room.min.y, room.min.z}, deep, down, middle}, right_holes, by_z, 0.9f);
    addQuad(draft, {room.min, across, down, middle}, by_x, 0.15f);
    // Four beams carry the ceiling.
    const MaterialAt beam = [](const glm::vec3& p, const glm::vec2&) {
        const float grain = fractalNoise({(p.x + p.y) * 38.0f, p.z * 1.6f}, 13u);
        return Material{glm::mix(glm::vec3(0.17f, 0.10f, 0.055f), glm::vec3(0.34f, 0.215f, 0.125f), grain),
                        glm::vec3(0.0f), 0.98f};
    };
    constexpr float kBeams[] = {-2.25f, -0.75f, 0.75f, 2.25f}, kHalfBeam = 0.065f;
    std::vector<glm::vec4> beam_holes;
    for (const float x : kBeams) {
        addBox(draft, {{x, -2.72f, 2.5f}, {kHalfBeam, 0.08f, 2.5f}, 0.0f, true}, beam, 1.8f);
        beam_holes.emplace_back((x - kHalfBeam - room.min.x) / size.x, 0.0f,
                                (x + kHalfBeam - room.min.x) / size.x, 1.0f);
    }
    const MaterialAt lime = [](const glm::vec3& p, const glm::vec2&) {
        return Material{
            glm::vec3(0.82f, 0.81f, 0.78f) * (0.97f + 0.05f * fractalNoise({p.x * 1.7f, p.z * 1.7f}, 9u)),
            glm::vec3(0.0f), 0.98f};
    };
    addQuadAround(draft, {room.min, across, deep, middle}, beam_holes, lime, 0.35f);
}

void addWindow(Draft& draft, const Room& room) {
    const glm::vec2 low = room.window_min, high = room.window_max, middle = 0.5f * (low + high),
                    half = 0.5f * (high - low);
    const float z = room.max.z;
    const MaterialAt paint = plain(kWhitePaint);
    // Reveal: the wall is 18 cm thick.
    const glm::vec3 inside(middle, z + 0.09f);
    addQuad(draft, {{low.x, low.y, z}, {0.0f, 0.0f, 0.18f}, {0.0f, 2.0f * half.y, 0.0f}, inside}, paint,
            3.0f);
    addQuad(draft, {{high.x, low.y, z}, {0.0f, 0.0f, 0.18f}, {0.0f, 2.0f * half.y, 0.0f}, inside}, paint,
            3.0f);
    addQuad(draft, {{low.x, low.y, z}, {2.0f * half.x, 0.0f, 0.0f}, {0.0f, 0.0f, 0.18f}, inside}, paint,
            3.0f);
    // Sill and architrave.
    addBox(draft, {{middle.x, high.y + 0.02f, z - 0.07f}, {half.x + 0.12f, 0.02f, 0.16f}, 0.0f}, paint, 3.0f);
    for (const float side : {-1.0f, 1.0f}) {
        addBox(draft,
               {{middle.x + side * (half.x + 0.04f), middle.y, z - 0.015f},
                {0.04f, half.y + 0.08f, 0.015f},
                0.0f},
               paint, 3.0f, false);
    }
    addBox(draft, {{middle.x, low.y - 0.04f, z - 0.02f}, {half.x, 0.04f, 0.02f}, 0.0f}, paint, 3.0f, false);
    // Bars between the panes, and the frame round them, 10 cm behind the wall's face. Their shadows are in
    // sunThroughWindow.
    for (int i = 0; i <= static_cast<int>(room.window_panes.x); ++i) {
        const float x = low.x + 2.0f * half.x * static_cast<float>(i) / room.window_panes.x;
        addBox(draft, {{x, middle.y, z + 0.10f}, {0.03f, half.y, 0.022f}, 0.0f}, paint, 4.0f, false);
    }
    for (int i = 0; i <= static_cast<int>(room.window_panes.y); ++i) {
        const float y = low.y + 2.0f * half.y * static_cast<float>(i) / room.window_panes.y;
        addBox(draft, {{middle.x, y, z + 0.10f}, {half.x, 0.026f, 0.02f}, 0.0f}, paint, 4.0f, false);
    }
    // Glass: a faint cool tint.
    Patch glass;
    glass.point = [=](const glm::vec2& uv) { return glm::vec3(low + uv * (high - low), z + 0.105f); };
    glass.material = [](const glm::vec3&, const glm::vec2& uv) {
        const float streak = glm::smoothstep(0.45f, 0.5f, glm::fract(uv.x * 1.5f + uv.y * 0.6f)) *
                             (1.0f - glm::smoothstep(0.6f, 0.66f, glm::fract(uv.x * 1.5f + uv.y * 0.6f)));
        return Material{glm::vec3(0.0f), glm::vec3(0.62f, 0.75f, 0.82f), 0.03f + 0.06f * streak};
    };
    glass.size_m = high - low;
    glass.detail = 0.5f;
    glass.lit = false;
    draft.add(std::move(glass));
}

// Linen, gathered in folds at both sides of the window, letting some light through.
void addCurtains(Draft& draft, const Room& room) {
    for (const float side : {-1.0f, 1.0f}) {
        const float start = side < 0.0f ? room.window_min.x - 0.32f : room.window_max.x + 0.32f;
        Patch curtain;
        curtain.point = [=](const glm::vec2& uv) {
            const float spread = 0.62f - 0.10f * std::sin(kPi * uv.y);  // tied in the middle
            const float fold = 0.045f * std::sin(2.0f * kPi * (7.0f * uv.x + 0.15f * std::sin(4.0f * uv.y))) *
                               (0.6f + 0.4f * uv.y);
            return glm::vec3(start - side * spread * uv.x, -2.52f + 2.44f * uv.y, 4.86f + fold);
        };
        curtain.material = [](const glm::vec3&, const glm::vec2& uv) {
            const float weave = fractalNoise(uv * glm::vec2(60.0f, 220.0f), 21u);
            return Material{glm::vec3(0.80f, 0.74f, 0.62f) * (0.86f + 0.2f * weave),
                            glm::vec3(0.05f, 0.045f, 0.035f), 0.72f};
        };
        curtain.size_m = {1.0f, 2.44f};
        curtain.detail = 2.0f;
        curtain.two_sided = true;
        draft.add(std::move(curtain));
    }
    addRod(draft, {room.window_min.x - 0.5f, -2.55f, 4.86f}, {room.window_max.x + 0.5f, -2.55f, 4.86f},
           0.014f, plain({0.20f, 0.13f, 0.07f}), 6.0f);
}

// A dark hull of few large splats a metre outside the walls, so that the two or three percent that shine
// through a wall do not depend on the sky behind it. So far out, none of its splats is in front of a wall's;
// it cannot be seen through the window.
void addHull(Draft& draft, const Room& room) {
    const glm::vec3 low = room.min - 1.0f, high(room.max.x + 1.0f, room.max.y + 1.0f, room.max.z - 0.5f),
                    size = high - low;
    const glm::vec3 x(size.x, 0.0f, 0.0f), y(0.0f, size.y, 0.0f), z(0.0f, 0.0f, size.z);
    const auto add = [&](const glm::vec3& origin, const glm::vec3& a, const glm::vec3& b) {
        Patch patch;
        patch.point = [=](const glm::vec2& uv) { return origin + uv.x * a + uv.y * b; };
        patch.material = [](const glm::vec3&, const glm::vec2&) {
            return Material{glm::vec3(0.0f), glm::vec3(0.12f, 0.11f, 0.09f), 0.98f};
        };
        patch.size_m = {glm::length(a), glm::length(b)};
        patch.detail = 0.02f;
        patch.lit = false;
        draft.add(std::move(patch));
    };
    add(low, x, y);
    add(low, z, y);
    add(low, x, z);
    add({high.x, low.y, low.z}, z, y);
    add({low.x, high.y, low.z}, x, z);
}

}  // namespace

void addShell(Draft& draft, const Room& room) {
    addFloorAndRug(draft, room);
    addWalls(draft, room);
    addWindow(draft, room);
    addCurtains(draft, room);
    addHull(draft, room);
}

}  // namespace binosplat::builtin
