// Facts about what the simulated wearer sees: pixels and blending, derived by hand.
#include "tests/xr/simulated/folder.h"
#include "xr/simulated/compose/compose.h"
#include "xr/simulated/compose/picture_file.h"

SUITE(simulated_compose) {

using namespace simulated;

const double kEighth = std::atan(1.0);
const Fov kSquareFov{-kEighth, kEighth, kEighth, -kEighth};  // tangents from -1 to 1

// A picture that owns its texels.
struct Canvas {
    glm::uvec2 size_px;
    std::vector<std::byte> bytes;

    explicit Canvas(glm::uvec2 size) : size_px(size), bytes(std::size_t{4} * size.x * size.y) {}
    Canvas(glm::uvec2 size, std::array<int, 4> colour) : Canvas(size) { fill({{0, 0}, size}, colour); }
    void fill(const Rect& rect, std::array<int, 4> colour) {
        for (std::uint32_t i = 0; i < rect.extent.x * rect.extent.y; ++i) {
            const glm::uvec2 place = rect.offset + glm::uvec2(i % rect.extent.x, i / rect.extent.x);
            for (std::size_t c = 0; c < 4; ++c) {
                bytes[(std::size_t{place.y} * size_px.x + place.x) * 4 + c] =
                    static_cast<std::byte>(colour[c]);
            }
        }
    }
    // A part of it, one pixel for each texel.
    [[nodiscard]] RgbPicture seen(const Rect& rect) const {
        RgbPicture picture{rect.extent, {}};
        for (std::uint32_t i = 0; i < 3 * rect.extent.x * rect.extent.y; ++i) {
            const glm::uvec2 place = rect.offset + glm::uvec2(i / 3 % rect.extent.x, i / 3 / rect.extent.x);
            picture.bytes.push_back(
                static_cast<std::uint8_t>(bytes[4 * (size_px.x * place.y + place.x) + i % 3]));
        }
        return picture;
    }
    [[nodiscard]] Picture picture() const { return {size_px, Texels::kRgba8, Transfer::kSrgb, bytes}; }
    [[nodiscard]] Rect whole() const { return {{0, 0}, size_px}; }
};

// Every byte value occurs, in no order.
Canvas noise(glm::uvec2 size_px) {
    Canvas canvas(size_px);
    std::uint32_t state = 1;
    for (std::byte& byte : canvas.bytes) {
        byte = static_cast<std::byte>((state = state * 1664525u + 1013904223u) >> 24);
    }
    return canvas;
}

ProjectionLayer projection(const Canvas& canvas, const EyeView& view) {
    const ProjectionView one{canvas.picture(), canvas.whole(), view.stage_from_eye, view.fov};
    return {{one, one}, {}};
}

QuadLayer quad(const Canvas& canvas, const glm::dvec3& centre, const glm::dvec2& size_m) {
    return {canvas.picture(), canvas.whole(), {{1, 0, 0, 0}, centre}, size_m, Visibility::kBoth, {}};
}

// A quarter turn wide and as high as wide; and all longitudes, latitudes within 45 degrees.
CylinderLayer cylinder(const Canvas& canvas) {
    return {canvas.picture(), canvas.whole(), {}, 0.0, 2.0 * kEighth, 1.0, Visibility::kBoth, {}};
}
SphereLayer sphere(const Canvas& canvas) {
    return {canvas.picture(), canvas.whole(),    {}, 0.0, 8.0 * kEighth, kEighth,
            -kEighth,         Visibility::kBoth, {}};
}

EyeView eyeOf(const glm::uvec2& size_px) { return {size_px, {}, kSquareFov}; }

RgbPicture compose(const EyeView& eye, const std::vector<Layer>& layers, Side side = kLeft) {
    return composeEye(eye, side, layers);
}

std::array<int, 3> at(const RgbPicture& picture, std::uint32_t x, std::uint32_t y) {
    const std::size_t i = 3 * (std::size_t{y} * picture.size_px.x + x);
    return {picture.bytes[i], picture.bytes[i + 1], picture.bytes[i + 2]};
}

using Rgb = std::array<int, 3>;
constexpr Rgb kBlack{0, 0, 0}, kWhite{255, 255, 255}, kRed{255, 0, 0}, kGreen{0, 255, 0}, kBlue{0, 0, 255};

int encoded(double linear) { return static_cast<int>(std::lround(255.0 * encodeSrgb(linear))); }
double decoded(int byte) { return decodeSrgb(byte / 255.0); }

Layer blended(QuadLayer layer, bool unpremultiplied) {
    layer.blending = {true, unpremultiplied};
    return layer;
}

// The middle pixel of an eye that looks to the left and up.
Rgb lookAt(const Layer& layer, double yaw_rad, double pitch_rad, const glm::dvec3& place = {}) {
    EyeView eye = eyeOf({64, 64});
    eye.stage_from_eye = {
        glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch_rad, glm::dvec3(1, 0, 0)), place};
    return at(compose(eye, {layer}), 32, 32);
}

TEST_CASE("a projection of the eye's own view comes through byte for byte, also in single precision") {
    const Canvas canvas = noise({64, 48});
    const EyeView eye{{64, 48},
                      {glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))), {1, 2, 3}},
                      {-0.9, 0.6, 0.7, -0.8}};
    const RgbPicture seen = compose(eye, {projection(canvas, eye)});
    CHECK(seen == canvas.seen({{0, 0}, {64, 48}}));
    EyeView submitted = eye;
    submitted.stage_from_eye.orientation = glm::dquat(glm::quat(eye.stage_from_eye.orientation));
    submitted.stage_from_eye.position = {3, 4, 5};
    submitted.fov = {double{-0.9f}, double{0.6f}, double{0.7f}, double{-0.8f}};
    CHECK(compose(eye, {projection(canvas, submitted)}) == seen);
    submitted.fov.right_rad += 0.004;  // a fifth of a pixel
    CHECK(compose(eye, {projection(canvas, submitted)}) != seen);
    // A picture that covers more than the eye sees.
    const Canvas wide = noise({70, 51});
    const double across = (std::tan(0.6) + std::tan(0.9)) / 64, down = (std::tan(0.7) + std::tan(0.8)) / 48;
    submitted.fov = {std::atan(-std::tan(0.9) - 4 * across), std::atan(std::tan(0.6) + 2 * across),
                     std::atan(std::tan(0.7) + down), std::atan(-std::tan(0.8) - 2 * down)};
    CHECK(compose(eye, {projection(wide, submitted)}) == wide.seen({{4, 1}, {64, 48}}));
    CHECK(compose(eyeOf({3, 2}), {}) == RgbPicture{{3, 2}, std::vector<std::uint8_t>(18, 0)});
}

TEST_CASE("an inset and its view are one picture: what shows through the inset is not the view") {
    const EyeView eye = eyeOf({4, 4});
    const Canvas red({4, 4}, {255, 0, 0, 255}), clear({2, 2}, {0, 0, 0, 0});
    ProjectionLayer layer = projection(red, eye);
    // The middle half in both directions.
    const double half = std::atan(0.5);
    layer.insets[kLeft] = ProjectionView{clear.picture(), clear.whole(), {}, {-half, half, half, -half}};
    layer.blending = {true, false};
    const Canvas white({4, 4}, {255, 255, 255, 255});
    const RgbPicture seen = compose(eye, {projection(white, eye), layer});
    CHECK(these(at(seen, 0, 1), at(seen, 1, 1), at(seen, 2, 2), at(seen, 2, 3),
                at(compose(eye, {layer}, kRight), 1, 1)) == these(kRed, kWhite, kWhite, kRed, kRed));
    // An empty inset counts as none.
    layer.insets[kLeft]->rect.extent = {0, 2};
    CHECK(at(compose(eye, {layer}), 1, 1) == kRed);
}

TEST_CASE("looking up moves the picture down, and views upside down are turned over") {
    Canvas canvas({64, 64}, {0, 0, 0, 255});
    canvas.fill({{0, 31}, {64, 2}}, {255, 255, 255, 255});
    EyeView eye = eyeOf({64, 64});
    const ProjectionLayer level = projection(canvas, eye);
    eye.stage_from_eye.orientation = glm::angleAxis(std::atan(0.125), glm::dvec3(1, 0, 0));
    const RgbPicture seen = compose(eye, {level});
    for (const std::uint32_t y : {35u, 36u}) { CHECK(at(seen, 32, y)[0] > 240); }
    CHECK(at(seen, 32, 31)[0] == 0);

    Canvas marked({2, 2}, {0, 0, 0, 255});
    marked.fill({{0, 0}, {1, 1}}, {255, 0, 0, 255});
    EyeView flipped = eyeOf({2, 2});
    std::swap(flipped.fov.up_rad, flipped.fov.down_rad);
    CHECK(at(compose(eyeOf({2, 2}), {projection(marked, flipped)}), 0, 1) == kRed);
}

TEST_CASE("a quad covers the pixels that its corners say, for each eye") {
    // 32 pixels between tangents -1 and 1 are 16 per unit. A quad 2 m ahead from x = -0.5 to 1.5 and y = 0 to
    // 1 spans tangents -0.25 to 0.75 and 0 to 0.5: columns 12 to 27, rows 8 to 15.
    const Canvas white({4, 4}, {255, 255, 255, 255});
    // For an eye an eighth of a metre further to the right, with 16 pixels per unit at 2 m, it is one column
    // further left.
    for (const std::uint32_t shift : {0u, 1u}) {
        EyeView eye = eyeOf({32, 32});
        eye.stage_from_eye.position.x = 0.125 * shift;
        Canvas expected({32, 32}, {0, 0, 0, 255});
        expected.fill({{12 - shift, 8}, {16, 8}}, {255, 255, 255, 255});
        CHECK(compose(eye, {quad(white, {0.5, 0.5, -2.0}, {2.0, 1.0})}) == expected.seen(expected.whole()));
    }
}

TEST_CASE("quads are seen from their front and ahead only") {
    const Canvas white({4, 4}, {255, 255, 255, 255});
    QuadLayer turned_away = quad(white, {0, 0, -2}, {9, 9});
    turned_away.stage_from_quad.orientation = glm::angleAxis(std::acos(-1.0), glm::dvec3(0, 1, 0));
    CHECK(at(compose(eyeOf({8, 8}), {turned_away}), 4, 4) == kBlack);
    for (const double z : {2.0, 0.0, -2.0}) {
        CHECK(at(compose(eyeOf({8, 8}), {quad(white, {0, 0, z}, {9, 9})}), 4, 4)[0] == (z < 0.0 ? 255 : 0));
    }
}

TEST_CASE("alpha is multiplied first where it was not, and the rest shines through") {
    const Canvas below({2, 2}, {200, 100, 0, 255}), above({2, 2}, {64, 0, 32, 102});  // alpha 0.4
    for (const bool unpremultiplied : {false, true}) {
        const Layer over = blended(quad(above, {0, 0, -1}, {9, 9}), unpremultiplied);
        const RgbPicture seen = compose(eyeOf({2, 2}), {quad(below, {0, 0, -2}, {9, 9}), over});
        const double share = unpremultiplied ? 0.4 : 1.0;
        CHECK(at(seen, 0, 0) == Rgb{encoded(share * decoded(64) + 0.6 * decoded(200)),
                                    encoded(0.6 * decoded(100)), encoded(share * decoded(32))});
    }
}

TEST_CASE("rectangles outside the picture are refused, and empty ones show nothing") {
    const Canvas canvas({4, 4}, {255, 255, 255, 255});
    QuadLayer layer = quad(canvas, {0, 0, -1}, {1, 1});
    for (const Rect& rect : {Rect{{0, 0}, {5, 4}}, Rect{{4, 0}, {1, 1}}, Rect{{0xffffffffu, 0}, {1, 1}}}) {
        layer.rect = rect;
        CHECK_THROWS_AS((void)compose(eyeOf({2, 2}), {layer}), std::invalid_argument);
    }
    layer.rect = canvas.whole();
    layer.picture.bytes = layer.picture.bytes.subspan(1);
    CHECK_THROWS_AS((void)compose(eyeOf({2, 2}), {layer}), std::invalid_argument);

    const EyeView eye = eyeOf({2, 2});
    for (const Rect& rect : {Rect{{0, 0}, {0, 4}}, Rect{{0, 0}, {4, 0}}, Rect{{4, 4}, {0, 0}}}) {
        QuadLayer flat = quad(canvas, {0, 0, -1}, {9, 9});
        CylinderLayer curved = cylinder(canvas);
        SphereLayer round = sphere(canvas);
        ProjectionLayer views = projection(canvas, eye);
        for (const Layer& whole : std::vector<Layer>{flat, curved, round, views}) {
            CHECK(at(compose(eye, {whole}), 0, 0) != kBlack);
        }
        flat.rect = curved.rect = round.rect = views.views[kLeft].rect = rect;
        CHECK(compose(eye, {flat, curved, round, views}) == compose(eye, {}));
        // The other eye's part of a projection is complete.
        CHECK(at(compose(eye, {views}, kRight), 0, 0) != kBlack);
    }
}

TEST_CASE("eyes side by side keep their pixels, come back from files, and those are the same every time") {
    const RgbPicture left{{1, 2}, {1, 2, 3, 4, 5, 6}}, right{{2, 1}, {7, 8, 9, 10, 11, 12}},
        both = putSideBySide(left, right);
    CHECK(both == RgbPicture{{3, 2}, {1, 2, 3, 7, 8, 9, 10, 11, 12, 4, 5, 6, 0, 0, 0, 0, 0, 0}});
    const Folder folder;
    writePng(folder.path / "a.png", both);
    CHECK(readPng(folder.path / "a.png") == both);
    // No chunk differs from run to run.
    const std::string once = folder.bytesOf("a.png");
    for (const char* chunk : {"tIME", "tEXt", "iTXt", "zTXt"}) { CHECK_FALSE(test::contains(once, chunk)); }
    writePng(folder.path / "b.png", both);
    CHECK(folder.bytesOf("b.png") == once);
    CHECK_THROWS_AS(writePng(folder.path / "none" / "c.png", both), std::runtime_error);
    CHECK(folder.names() == std::set<std::string>{"a.png", "b.png"});
}

#ifndef _WIN32  // on Windows, links need a privilege
TEST_CASE_FIXTURE(InFolder, "a picture is not written through a link or over an unfinished one") {
    folder.write("victim", "keep me");
    for (const char* name : {".a.unfinished.png", "b.png"}) {
        std::filesystem::create_symlink("victim", folder.path / name);
    }
    const std::string unfinished = nameUnfinishedPicture(folder.path / "c.png").filename().string();
    folder.write(unfinished, "keep me");
    const RgbPicture picture{{1, 1}, {1, 2, 3}};
    for (const char* name : {"a.png", "c.png"}) {
        const std::string refusal = (folder.path / name).string() + ": cannot be written (File exists)";
        CHECK_THROWS_WITH_AS(writePng(folder.path / name, picture), refusal.c_str(), std::runtime_error);
    }
    writePng(folder.path / "b.png", picture);
    CHECK(readPng(folder.path / "b.png") == picture);
    for (const std::string& name : {std::string("victim"), unfinished}) {
        CHECK(folder.bytesOf(name) == "keep me");
    }
}
#endif

TEST_CASE("a cylinder's picture lies on its arc about the middle") {
    // Longitudes within 45 degrees, heights within pi/4 of the radius.
    Canvas canvas({2, 1}, {255, 0, 0, 255});
    canvas.fill({{1, 0}, {1, 1}}, {0, 0, 255, 255});
    CylinderLayer layer = cylinder(canvas);
    // 100 pixels per unit of tangent: the left edge is the eye's, the top is at y/z = pi/4 in the middle.
    const RgbPicture far_away = compose(eyeOf({200, 200}), {layer});
    CHECK(these(at(far_away, 10, 100), at(far_away, 190, 100)) == these(kRed, kBlue));
    CHECK(at(far_away, 99, 23)[0] > 100);
    CHECK(at(far_away, 99, 20) == kBlack);
    // At 45 degrees to the side, the wall's depth z is smaller by sqrt(2): its edge is at pi/4 * sqrt(2) > 1.
    CHECK(at(far_away, 1, 1)[0] > 100);
    // From its axis it looks the same, whatever its size; from nearer to its wall it is wider than the view.
    for (const double radius_m : {double{INFINITY}, 2.0}) {
        layer.radius_m = radius_m;
        CHECK(compose(eyeOf({200, 200}), {layer}) == far_away);
    }
    layer.stage_from_cylinder.position.z = 1.0;
    CHECK(at(compose(eyeOf({200, 200}), {layer}), 99, 1)[0] > 100);
    layer.stage_from_cylinder.orientation = glm::angleAxis(4.0 * kEighth, glm::dvec3(0, 1, 0));
    CHECK(at(compose(eyeOf({200, 200}), {layer}), 100, 100) == kBlack);
    layer.stage_from_cylinder = {};
    layer.visibility = Visibility::kRight;
    CHECK(at(compose(eyeOf({200, 200}), {layer}), 100, 100) == kBlack);
    CHECK(at(compose(eyeOf({200, 200}), {layer}, kRight), 150, 100) == kBlue);
}

TEST_CASE("a sphere's picture lies between its angles") {
    Canvas canvas({2, 2}, {255, 0, 0, 255});
    canvas.fill({{1, 0}, {1, 1}}, {0, 255, 0, 255});
    canvas.fill({{0, 1}, {1, 1}}, {0, 0, 255, 255});
    canvas.fill({{1, 1}, {1, 1}}, {255, 255, 255, 255});
    SphereLayer layer = sphere(canvas);
    const auto looking = [&](double yaw_rad, double pitch_rad) { return lookAt(layer, yaw_rad, pitch_rad); };
    // A quarter of the picture's width and height from the middle, where its texels are.
    CHECK(looking(2.0 * kEighth, 0.5 * kEighth)[0] > 240);
    CHECK(looking(-2.0 * kEighth, 0.5 * kEighth)[1] > 240);
    CHECK(looking(2.0 * kEighth, -0.5 * kEighth)[2] > 240);
    CHECK(these(looking(0.0, 1.5 * kEighth), looking(0.0, -1.5 * kEighth)) == these(kBlack, kBlack));
    // A sphere around the eye looks as if it were far away. From outside, only the inside of its far half is
    // seen.
    const Rgb before = looking(2.0 * kEighth, 0.3 * kEighth);
    layer.radius_m = 3.0;
    CHECK(looking(2.0 * kEighth, 0.3 * kEighth) == before);
    layer.stage_from_sphere.position = {0, 0, -10};
    layer.horizontal_angle_rad = 4.0 * kEighth;
    CHECK(looking(0.0, 0.0) != kBlack);
    layer.stage_from_sphere.orientation = glm::angleAxis(4.0 * kEighth, glm::dvec3(0, 1, 0));
    CHECK(looking(0.0, 0.0) == kBlack);
    layer.horizontal_angle_rad = 0.0;
    CHECK(looking(0.0, 0.0) == kBlack);
}

TEST_CASE("a cube map's faces are in Vulkan's order, and the top left texel of each is where Vulkan has it") {
    const std::array<Rgb, 6> colours{{kRed, kGreen, kBlue, {255, 255, 0}, {255, 0, 255}, {0, 255, 255}}};
    // Where each is seen: to the left and up, in eighths of a turn.
    const std::array<glm::dvec2, 6> ways{{{-2, 0}, {2, 0}, {0, 2}, {0, -2}, {4, 0}, {0, 0}}};
    std::vector<Canvas> canvases;
    for (const auto& [r, g, b] : colours) {
        canvases.emplace_back(glm::uvec2(2, 2), std::array{r, g, b, 255});
    }
    CubeLayer layer;
    for (std::size_t face = 0; face < 6; ++face) { layer.faces[face] = canvases[face].picture(); }
    // Infinitely far away, so the place does not matter.
    const auto looking = [&](double yaw_rad, double pitch_rad) {
        return lookAt(layer, yaw_rad, pitch_rad, {5, 6, 7});
    };
    for (std::size_t face = 0; face < 6; ++face) {
        CHECK(looking(ways[face].x * kEighth, ways[face].y * kEighth) == colours[face]);
    }
    layer.stage_from_cube = glm::angleAxis(2.0 * kEighth, glm::dvec3(0, 1, 0));  // its -z is the stage's -x
    CHECK(looking(2.0 * kEighth, 0) == Rgb{0, 255, 255});
    layer.visibility = Visibility::kRight;
    CHECK(looking(0, 0) == kBlack);

    // On -z, s grows towards -x and t towards -y.
    Canvas marked({8, 8}, {0, 0, 0, 255});
    marked.fill({{0, 0}, {4, 4}}, {255, 0, 0, 255});
    CubeLayer turned;
    turned.faces.fill(marked.picture());
    const RgbPicture seen = compose(eyeOf({8, 8}), {turned});
    CHECK(these(at(seen, 6, 1), at(seen, 1, 1), at(seen, 6, 6)) == these(kRed, kBlack, kBlack));
}

TEST_CASE("the room shows as far as alpha lets it or is added") {
    const Backdrop room{{1.0, 0.0, 0.0}, false}, added{{1.0, 0.0, 0.0}, true};
    const auto seen = [](const std::vector<Layer>& layers, const Backdrop& backdrop) {
        return at(composeEye(eyeOf({2, 2}), kLeft, layers, backdrop), 0, 0);
    };
    CHECK(seen({}, room) == kRed);
    // Over it, four tenths of blue's light.
    const Canvas blue({2, 2}, {0, 0, 255, 102}), green({2, 2}, {0, 255, 0, 255});
    const Layer glass = blended(quad(blue, {0, 0, -1}, {9, 9}), true), wall = quad(green, {0, 0, -2}, {9, 9});
    CHECK(seen({glass}, room) == Rgb{encoded(0.6), 0, encoded(0.4)});
    CHECK(seen({wall}, room) == kGreen);
    CHECK(seen({wall}, added) == Rgb{255, 255, 0});
    CHECK(seen({wall, glass}, room) == Rgb{0, encoded(0.6), encoded(0.4)});
}

}  // SUITE(simulated_compose)
