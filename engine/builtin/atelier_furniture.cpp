// Furniture: table, armchair, shelf with books, sideboard, lamp, pictures.
#include "engine/builtin/atelier.h"
#include "engine/builtin/noise.h"
#include "engine/builtin/shapes.h"

#include <cmath>

namespace binosplat::builtin {

namespace {

// Grain along x or z, whichever the caller says is the longer side.
MaterialAt wood(const glm::vec3& dark, const glm::vec3& light, bool along_x, std::uint32_t seed) {
    return [=](const glm::vec3& p, const glm::vec2&) {
        const glm::vec2 at =
            along_x ? glm::vec2(p.x * 2.5f, (p.z + p.y) * 32.0f) : glm::vec2(p.z * 2.5f, (p.x + p.y) * 32.0f);
        return Material{glm::mix(dark, light, fractalNoise(at, seed)), glm::vec3(0.0f), 0.98f};
    };
}

MaterialAt fabric(const glm::vec3& albedo, std::uint32_t seed) {
    return [=](const glm::vec3& p, const glm::vec2&) {
        const float weave = fractalNoise({(p.x + p.z) * 70.0f, p.y * 70.0f}, seed),
                    soft = fractalNoise({p.x * 5.0f + p.z * 3.0f, p.y * 5.0f}, seed + 1u);
        return Material{albedo * (0.72f + 0.3f * weave + 0.26f * soft), glm::vec3(0.0f), 0.97f};
    };
}

void addTable(Draft& draft) {
    const glm::vec3 centre(0.35f, -0.74f, 2.45f);
    const MaterialAt oak = wood({0.24f, 0.115f, 0.05f}, {0.46f, 0.26f, 0.125f}, true, 41u);
    addBox(draft, {centre + glm::vec3(0.0f, 0.018f, 0.0f), {0.80f, 0.018f, 0.43f}, 0.0f, true}, oak, 6.0f);
    addBox(draft, {centre + glm::vec3(0.0f, 0.08f, 0.0f), {0.72f, 0.042f, 0.36f}, 0.0f}, oak, 3.0f);
    for (const float x : {-0.69f, 0.69f}) {
        for (const float z : {-0.33f, 0.33f}) {
            addRevolution(draft, {centre.x + x, 0.0f, centre.z + z},
                          {{0.018f, 0.0f}, {0.022f, 0.1f}, {0.03f, 0.35f}, {0.036f, 0.58f}, {0.036f, 0.66f}},
                          oak, 6.0f);
            draft.occluders().push_back(
                {Occluder::Shape::kBox, {centre.x + x, -0.33f, centre.z + z}, {0.025f, 0.33f, 0.025f}, 0.0f});
        }
    }
}

void addArmchair(Draft& draft) {
    const glm::vec3 foot(-1.55f, 0.0f, 3.55f);
    const float yaw = -0.55f;  // turned towards the table
    const MaterialAt cloth = fabric({0.50f, 0.22f, 0.075f}, 51u), pillow = fabric({0.62f, 0.56f, 0.44f}, 57u);
    const auto place = [&](const glm::vec3& local) {
        const float c = std::cos(yaw), s = std::sin(yaw);
        return foot + glm::vec3(c * local.x + s * local.z, local.y, -s * local.x + c * local.z);
    };
    addCushion(draft, {place({0.0f, -0.26f, 0.0f}), {0.42f, 0.14f, 0.40f}, yaw}, 6.0f, cloth, 4.0f);
    addCushion(draft, {place({0.0f, -0.43f, -0.05f}), {0.31f, 0.085f, 0.36f}, yaw}, 5.0f, cloth, 5.0f);
    addCushion(draft, {place({0.0f, -0.62f, 0.36f}), {0.40f, 0.40f, 0.11f}, yaw}, 5.0f, cloth, 4.0f);
    for (const float side : {-1.0f, 1.0f}) {
        addCushion(draft, {place({side * 0.41f, -0.42f, 0.02f}), {0.095f, 0.22f, 0.40f}, yaw}, 5.0f, cloth,
                   5.0f);
    }
    addCushion(draft, {place({0.06f, -0.66f, 0.20f}), {0.21f, 0.17f, 0.085f}, yaw + 0.2f}, 3.2f, pillow,
               7.0f);
    for (const float x : {-0.34f, 0.34f}) {
        for (const float z : {-0.30f, 0.30f}) {
            addRod(draft, place({x, 0.0f, z}), place({x, -0.14f, z}), 0.02f, plain({0.13f, 0.07f, 0.035f}),
                   6.0f);
        }
    }
}

// One row of books from z0 to z1 standing at the height `shelf`; a little space for leaning is left at the
// end.
void addBooks(Draft& draft, float shelf, float z0, float z1, std::uint32_t seed) {
    const glm::vec3 covers[] = {{0.36f, 0.06f, 0.05f}, {0.06f, 0.12f, 0.24f}, {0.09f, 0.20f, 0.12f},
                                {0.56f, 0.42f, 0.20f}, {0.68f, 0.63f, 0.52f}, {0.22f, 0.09f, 0.16f},
                                {0.05f, 0.19f, 0.22f}, {0.48f, 0.20f, 0.06f}, {0.12f, 0.11f, 0.10f}};
    const float stop = z1 - 0.22f * unitFloat(hash(seed, 999u));
    std::uint32_t i = 0;
    for (float z = z0; z < stop; ++i) {
        const std::uint32_t chance = hash(seed, i);
        const float thick = 0.018f + 0.034f * unitFloat(chance),
                    height = 0.19f + 0.10f * unitFloat(hash(chance)),
                    depth = 0.085f + 0.03f * unitFloat(hash(chance, 3u));
        const glm::vec3 cover =
            covers[hash(chance, 5u) % std::size(covers)] * (0.8f + 0.4f * unitFloat(hash(chance, 7u)));
        const float band = 0.2f + 0.6f * unitFloat(hash(chance, 9u));
        const MaterialAt spine = [=](const glm::vec3& p, const glm::vec2&) {
            const float up = (shelf - p.y) / height;
            const float gilt = 1.0f - glm::smoothstep(0.012f, 0.03f, std::abs(up - band)) *
                                          glm::smoothstep(0.01f, 0.02f, std::abs(up - 0.93f));
            return Material{glm::mix(cover, glm::vec3(0.62f, 0.48f, 0.20f), 0.8f * gilt), glm::vec3(0.0f),
                            0.97f};
        };
        // Only the spine and top are made, since the sides touch each other, and the back is against the
        // wall.
        const glm::vec3 low(-2.95f, shelf - height, z), high(-2.95f + 2.0f * depth, shelf, z + 0.96f * thick),
            away(0.0f, -1.5f, 0.5f * (low.z + high.z));
        const glm::vec3 x(high.x - low.x, 0.0f, 0.0f), y(0.0f, height, 0.0f),
            along(0.0f, 0.0f, high.z - low.z);
        addQuad(draft, {{high.x, low.y, low.z}, along, y, away}, spine, 3.0f);
        addQuad(draft, {low, x, along, away + glm::vec3(0.0f, -100.0f, 0.0f)}, plain({0.55f, 0.50f, 0.40f}),
                1.0f);
        addQuad(draft, {low, x, y, away + glm::vec3(0.0f, 0.0f, -100.0f)}, spine, 0.25f);
        addQuad(draft, {{low.x, low.y, high.z}, x, y, away + glm::vec3(0.0f, 0.0f, 100.0f)}, spine, 0.25f);
        z += thick + 0.002f;
    }
    // For shadows, the row is one block.
    draft.occluders().push_back({Occluder::Shape::kBox,
                                 {-2.88f, shelf - 0.11f, 0.5f * (z0 + stop)},
                                 {0.09f, 0.11f, 0.5f * (stop - z0)},
                                 0.0f});
}

void addShelf(Draft& draft) {
    const MaterialAt walnut = wood({0.13f, 0.065f, 0.03f}, {0.27f, 0.145f, 0.07f}, false, 71u);
    const float z0 = 2.3f, z1 = 4.5f, depth = 0.15f, x = -3.0f + depth;
    for (const float z : {z0, 0.5f * (z0 + z1), z1}) {
        addBox(draft, {{x, -1.15f, z}, {depth, 1.15f, 0.018f}, 0.0f}, walnut, 2.5f);
    }
    addQuad(draft, {{-2.985f, -2.3f, z0}, {0.0f, 0.0f, z1 - z0}, {0.0f, 2.3f, 0.0f}, {100.0f, -1.0f, 3.4f}},
            walnut, 0.9f);
    for (int board = 0; board <= 6; ++board) {
        const float y = -0.06f - 0.37f * static_cast<float>(board);
        addBox(draft, {{x, y, 0.5f * (z0 + z1)}, {depth, 0.014f, 0.5f * (z1 - z0)}, 0.0f, true}, walnut,
               2.5f);
        if (board == 6) { break; }
        const auto seed = static_cast<std::uint32_t>(board);
        addBooks(draft, y - 0.014f, z0 + 0.03f, 0.5f * (z0 + z1) - 0.02f, 131u + seed);
        if (board != 3) { addBooks(draft, y - 0.014f, 0.5f * (z0 + z1) + 0.03f, z1 - 0.02f, 151u + seed); }
    }
    // One compartment shows a bowl and a pale vessel instead of books.
    const float shelf = -0.06f - 3.0f * 0.37f - 0.014f;
    addRevolution(draft, {-2.84f, shelf, 3.72f},
                  {{0.03f, 0.0f},
                   {0.035f, 0.01f},
                   {0.08f, 0.05f},
                   {0.105f, 0.10f},
                   {0.095f, 0.10f},
                   {0.06f, 0.05f},
                   {0.0f, 0.03f}},
                  plain({0.60f, 0.36f, 0.24f}), 7.0f);
    addRevolution(
        draft, {-2.84f, shelf, 4.15f},
        {{0.0f, 0.0f}, {0.05f, 0.0f}, {0.085f, 0.09f}, {0.05f, 0.18f}, {0.022f, 0.23f}, {0.032f, 0.27f}},
        plain({0.70f, 0.68f, 0.62f}), 7.0f);
    draft.occluders().push_back(
        {Occluder::Shape::kEllipsoid, {-2.84f, shelf - 0.1f, 4.15f}, {0.075f, 0.12f, 0.075f}, 0.0f});
}

void addSideboard(Draft& draft) {
    const MaterialAt teak = wood({0.21f, 0.10f, 0.045f}, {0.40f, 0.215f, 0.10f}, false, 81u);
    const MaterialAt front = [teak](const glm::vec3& p, const glm::vec2& uv) {
        Material material = teak(p, uv);
        // Three doors, a gap between them, a round knob each.
        const float door = (p.z - 1.95f) / 0.65f, at = door - std::floor(door);
        const float gap = glm::smoothstep(0.0f, 0.008f, std::min(at, 1.0f - at) * 0.65f);
        const float knob =
            1.0f - glm::smoothstep(0.012f, 0.017f, glm::length(glm::vec2((at - 0.88f) * 0.65f, p.y + 0.52f)));
        material.albedo =
            glm::mix(material.albedo * (0.3f + 0.7f * gap), glm::vec3(0.70f, 0.52f, 0.24f), knob);
        return material;
    };
    addBox(draft, {{2.76f, -0.44f, 2.925f}, {0.225f, 0.32f, 0.975f}, 0.0f}, front, 3.0f);
    addBox(draft, {{2.75f, -0.775f, 2.925f}, {0.245f, 0.015f, 1.0f}, 0.0f}, teak, 3.0f);
    for (const float z : {2.05f, 3.8f}) {
        addRod(draft, {2.58f, 0.0f, z}, {2.58f, -0.13f, z}, 0.018f, plain({0.14f, 0.08f, 0.04f}), 5.0f);
    }
}

void addLamp(Draft& draft, const Room& room) {
    const glm::vec3 foot(room.lamp.x, 0.0f, room.lamp.z);
    const MaterialAt brass = plain({0.45f, 0.32f, 0.14f});
    addRevolution(draft, foot, {{0.15f, 0.0f}, {0.15f, 0.015f}, {0.05f, 0.028f}, {0.012f, 0.05f}}, brass,
                  6.0f);
    addRod(draft, foot, foot + glm::vec3(0.0f, -1.5f, 0.0f), 0.011f, brass, 8.0f);
    draft.occluders().push_back(
        {Occluder::Shape::kBox, foot + glm::vec3(0.0f, -0.7f, 0.0f), {0.011f, 0.7f, 0.011f}, 0.0f});
    Patch shade;
    shade.point = [lamp = room.lamp](const glm::vec2& uv) {
        const float angle = 2.0f * kPi * uv.x, radius = glm::mix(0.15f, 0.24f, uv.y);
        return lamp +
               glm::vec3(radius * std::cos(angle), glm::mix(-0.17f, 0.17f, uv.y), radius * std::sin(angle));
    };
    shade.material = [](const glm::vec3&, const glm::vec2& uv) {
        const float glow = std::exp(-5.0f * (uv.y - 0.55f) * (uv.y - 0.55f)),
                    pleats = 0.93f + 0.07f * std::sin(2.0f * kPi * 40.0f * uv.x);
        const float hem = glm::smoothstep(0.0f, 0.03f, std::min(uv.y, 1.0f - uv.y));
        return Material{glm::vec3(0.35f, 0.30f, 0.22f),
                        glm::vec3(1.05f, 0.68f, 0.34f) * glow * pleats * (0.5f + 0.5f * hem), 0.80f};
    };
    shade.size_m = {1.22f, 0.35f};
    shade.detail = 6.0f;
    shade.two_sided = true;
    draft.add(std::move(shade));
}

// A canvas at sunset over water: bands of sky, a sun and its path.
Material paintedSunset(const glm::vec2& uv) {
    const float brush = fractalNoise(uv * glm::vec2(14.0f, 60.0f), 301u) - 0.5f,
                daub = fractalNoise(uv * 30.0f, 302u) - 0.5f;
    glm::vec3 colour;
    if (uv.y < 0.58f) {
        colour = glm::mix(glm::vec3(0.10f, 0.17f, 0.32f), glm::vec3(0.80f, 0.42f, 0.16f),
                          glm::smoothstep(0.0f, 0.55f, uv.y + 0.16f * brush));
        const float sun = glm::length((uv - glm::vec2(0.62f, 0.44f)) * glm::vec2(1.45f, 1.0f));
        colour = glm::mix(colour, glm::vec3(0.95f, 0.78f, 0.42f),
                          1.0f - glm::smoothstep(0.06f, 0.085f, sun + 0.02f * daub));
    } else {
        const float depth = (uv.y - 0.58f) / 0.42f,
                    path = std::exp(-60.0f * (uv.x - 0.62f) * (uv.x - 0.62f) / (0.2f + depth));
        colour = glm::mix(glm::vec3(0.30f, 0.24f, 0.24f), glm::vec3(0.05f, 0.10f, 0.17f), depth) +
                 glm::vec3(0.5f, 0.28f, 0.10f) * path * (0.5f + 1.2f * brush);
        if (uv.y < 0.61f + 0.03f * daub && uv.x < 0.45f) { colour = glm::vec3(0.07f, 0.07f, 0.09f); }
    }
    return {glm::max(colour * (1.0f + 0.5f * daub), glm::vec3(0.01f)), glm::vec3(0.0f), 0.97f};
}

// Flat shapes on a pale ground.
Material paintedShapes(const glm::vec2& uv) {
    glm::vec3 colour(0.74f, 0.69f, 0.58f);
    const auto disc = [&](const glm::vec2& centre, float radius, const glm::vec3& paint) {
        colour = glm::mix(paint, colour,
                          glm::smoothstep(radius - 0.01f, radius + 0.01f,
                                          glm::length((uv - centre) * glm::vec2(0.8f, 1.0f))));
    };
    disc({0.40f, 0.42f}, 0.25f, {0.60f, 0.15f, 0.07f});
    disc({0.66f, 0.60f}, 0.18f, {0.07f, 0.13f, 0.24f});
    disc({0.60f, 0.28f}, 0.09f, {0.76f, 0.52f, 0.14f});
    const float line = std::abs(uv.y - 0.80f - 0.04f * std::sin(6.0f * uv.x));
    if (line < 0.012f && uv.x > 0.15f && uv.x < 0.85f) { colour = glm::vec3(0.08f); }
    return {colour * (0.92f + 0.16f * fractalNoise(uv * 24.0f, 305u)), glm::vec3(0.0f), 0.97f};
}

void addPictures(Draft& draft, const Room& room) {
    const MaterialAt gilt = plain({0.40f, 0.28f, 0.12f}), black = plain({0.05f, 0.045f, 0.04f});
    // On the right wall, 1.6 x 1.1 m with its frame.
    const float x = room.max.x - 0.03f;
    addQuad(
        draft, {{x, -2.12f, 3.64f}, {0.0f, 0.0f, -1.48f}, {0.0f, 0.98f, 0.0f}, {0.0f, -1.6f, 2.9f}},
        [](const glm::vec3&, const glm::vec2& uv) { return paintedSunset(uv); }, 6.0f);
    for (const float y : {-2.15f, -1.11f}) {
        addBox(draft, {{x, y, 2.9f}, {0.03f, 0.03f, 0.80f}, 0.0f}, gilt, 5.0f);
    }
    for (const float z : {2.13f, 3.67f}) {
        addBox(draft, {{x, -1.63f, z}, {0.03f, 0.55f, 0.03f}, 0.0f}, gilt, 5.0f);
    }
    // Beside the window, 0.96 x 1.16 m.
    const float z = room.max.z - 0.02f;
    addQuad(
        draft, {{1.51f, -2.04f, z}, {0.88f, 0.0f, 0.0f}, {0.0f, 1.08f, 0.0f}, {1.9f, -1.5f, 2.0f}},
        [](const glm::vec3&, const glm::vec2& uv) { return paintedShapes(uv); }, 6.0f);
    for (const float y : {-2.06f, -0.94f}) {
        addBox(draft, {{1.95f, y, z}, {0.48f, 0.022f, 0.02f}, 0.0f}, black, 5.0f);
    }
    for (const float side : {1.49f, 2.41f}) {
        addBox(draft, {{side, -1.5f, z}, {0.022f, 0.58f, 0.02f}, 0.0f}, black, 5.0f);
    }
}

}  // namespace

void addFurniture(Draft& draft, const Room& room) {
    addTable(draft);
    addArmchair(draft);
    addShelf(draft);
    addSideboard(draft);
    addLamp(draft, room);
    addPictures(draft, room);
}

}  // namespace binosplat::builtin
