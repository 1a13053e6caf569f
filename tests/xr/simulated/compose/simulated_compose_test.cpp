// Facts about what the simulated wearer sees: pixels and blending derived by hand.
#include "xr/simulated/compose/compose.h"
#include "xr/simulated/compose/picture_file.h"

#include <doctest/doctest.h>
#include <unistd.h>
#include <glm/gtc/packing.hpp>

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

TEST_SUITE_BEGIN("simulated_compose");

namespace simulated_compose_test {

using namespace simulated;

namespace {

const double kEighth = std::atan(1.0);
const Fov kSquareFov{-kEighth, kEighth, kEighth, -kEighth};  // tangents from -1 to 1

// A picture that owns its texels.
struct Canvas {
    glm::uvec2 size_px;
    std::vector<std::byte> bytes;
    Texels texels = Texels::kRgba8;
    Transfer transfer = Transfer::kSrgb;

    explicit Canvas(glm::uvec2 size) : size_px(size), bytes(std::size_t{4} * size.x * size.y) {}
    Canvas(glm::uvec2 size, std::array<int, 4> colour) : Canvas(size) {
        for (std::uint32_t y = 0; y < size.y; ++y) {
            for (std::uint32_t x = 0; x < size.x; ++x) { set(x, y, colour); }
        }
    }
    void set(std::uint32_t x, std::uint32_t y, std::array<int, 4> colour) {
        for (std::size_t c = 0; c < 4; ++c) { bytes[(std::size_t{y} * size_px.x + x) * 4 + c] = static_cast<std::byte>(colour[c]); }
    }
    [[nodiscard]] Picture picture() const { return {size_px, texels, transfer, bytes}; }
    [[nodiscard]] Rect whole() const { return {{0, 0}, size_px}; }
};

Canvas halves(glm::uvec2 size_px, const glm::vec4& colour) {
    Canvas canvas(size_px);
    canvas.texels = Texels::kRgba16f;
    canvas.transfer = Transfer::kLinear;
    canvas.bytes.resize(std::size_t{8} * size_px.x * size_px.y);
    for (std::size_t i = 0; i < canvas.bytes.size() / 2; ++i) {
        const std::uint16_t half = glm::packHalf1x16(colour[static_cast<glm::length_t>(i % 4)]);
        std::memcpy(canvas.bytes.data() + 2 * i, &half, 2);
    }
    return canvas;
}

// Every byte occurs, without order.
Canvas noise(glm::uvec2 size_px) {
    Canvas canvas(size_px);
    std::uint32_t state = 1;
    for (std::byte& byte : canvas.bytes) { byte = static_cast<std::byte>((state = state * 1664525u + 1013904223u) >> 24); }
    return canvas;
}

ProjectionLayer projection(const Canvas& canvas, const EyeView& view) {
    const ProjectionView one{canvas.picture(), canvas.whole(), view.stage_from_eye, view.fov};
    return {{one, one}, {}};
}

QuadLayer quad(const Canvas& canvas, const glm::dvec3& centre, const glm::dvec2& size_m) {
    return {canvas.picture(), canvas.whole(), {{1, 0, 0, 0}, centre}, size_m, Visibility::kBoth, {}};
}

EyeView eyeOf(const glm::uvec2& size_px) { return {size_px, {}, kSquareFov}; }

RgbPicture compose(const EyeView& eye, const std::vector<Layer>& layers, Side side = kLeft) { return composeEye(eye, side, layers); }

std::array<int, 3> at(const RgbPicture& picture, std::uint32_t x, std::uint32_t y) {
    const std::size_t i = 3 * (std::size_t{y} * picture.size_px.x + x);
    return {picture.bytes[i], picture.bytes[i + 1], picture.bytes[i + 2]};
}

using Rgb = std::array<int, 3>;
constexpr Rgb kBlack{0, 0, 0};

int encoded(double linear) { return static_cast<int>(std::lround(255.0 * encodeSrgb(linear))); }
double decoded(int byte) { return decodeSrgb(byte / 255.0); }

Layer blended(QuadLayer layer, bool unpremultiplied) {
    layer.blending = {true, unpremultiplied};
    return layer;
}

}  // namespace

TEST_CASE("nothing submitted is black") { CHECK(compose(eyeOf({3, 2}), {}) == RgbPicture{{3, 2}, std::vector<std::uint8_t>(18, 0)}); }

TEST_CASE("every sRGB byte comes back") {
    for (int byte = 0; byte < 256; ++byte) { CHECK(encoded(decoded(byte)) == byte); }
    CHECK(decodeSrgb(0.5) == doctest::Approx(0.21404114));
    CHECK(encodeSrgb(0.21404114) == doctest::Approx(0.5));
    CHECK(decodeSrgb(0.04) == doctest::Approx(0.04 / 12.92));
}

TEST_CASE("a projection of the eye's own view comes through byte for byte") {
    const Canvas canvas = noise({64, 48});
    const EyeView eye{{64, 48}, {glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))), {1, 2, 3}}, {-0.9, 0.6, 0.7, -0.8}};
    const RgbPicture seen = compose(eye, {projection(canvas, eye)});
    for (std::size_t pixel = 0; pixel < 64 * 48; ++pixel) {
        for (std::size_t c = 0; c < 3; ++c) {
            REQUIRE(seen.bytes[3 * pixel + c] == static_cast<std::uint8_t>(canvas.bytes[4 * pixel + c]));
        }
    }
}

TEST_CASE("poses that went through single precision still give the same bytes") {
    const Canvas canvas = noise({64, 64});
    const EyeView eye{{64, 64}, {glm::angleAxis(0.7, glm::normalize(glm::dvec3(1, 2, 3))), {1, 2, 3}}, {-0.9, 0.6, 0.7, -0.8}};
    EyeView submitted = eye;
    submitted.stage_from_eye.orientation = glm::dquat(glm::quat(eye.stage_from_eye.orientation));
    submitted.fov = {static_cast<float>(-0.9), static_cast<float>(0.6), static_cast<float>(0.7), static_cast<float>(-0.8)};
    CHECK(compose(eye, {projection(canvas, submitted)}) == compose(eye, {projection(canvas, eye)}));
}

TEST_CASE("an inset and its view are one picture: what shows through the inset is not the view") {
    const EyeView eye = eyeOf({4, 4});
    const Canvas red({4, 4}, {255, 0, 0, 255}), clear({2, 2}, {0, 0, 0, 0});
    ProjectionLayer layer = projection(red, eye);
    // The middle half, each way.
    const double half = std::atan(0.5);
    layer.insets[kLeft] = ProjectionView{clear.picture(), clear.whole(), {}, {-half, half, half, -half}};
    layer.blending = {true, false};
    const Canvas white({4, 4}, {255, 255, 255, 255});
    const RgbPicture seen = compose(eye, {projection(white, eye), layer});
    CHECK(at(seen, 0, 1) == Rgb{255, 0, 0});
    CHECK(at(seen, 1, 1) == Rgb{255, 255, 255});
    CHECK(at(seen, 2, 2) == Rgb{255, 255, 255});
    CHECK(at(seen, 2, 3) == Rgb{255, 0, 0});
    CHECK(at(compose(eye, {layer}, kRight), 1, 1) == Rgb{255, 0, 0});
    // An empty one is none.
    layer.insets[kLeft]->rect.extent = {0, 2};
    CHECK(at(compose(eye, {layer}), 1, 1) == Rgb{255, 0, 0});
}

TEST_CASE("each eye sees its own view") {
    const EyeView eye = eyeOf({2, 2});
    const Canvas red({2, 2}, {255, 0, 0, 255}), green({2, 2}, {0, 255, 0, 255});
    ProjectionLayer layer = projection(red, eye);
    layer.views[kRight].picture = green.picture();
    CHECK(at(compose(eye, {layer}, kLeft), 0, 0) == Rgb{255, 0, 0});
    CHECK(at(compose(eye, {layer}, kRight), 0, 0) == Rgb{0, 255, 0});
}

TEST_CASE("a rectangle of the picture is all that is seen") {
    Canvas canvas = noise({8, 8});
    const EyeView eye = eyeOf({4, 3});
    ProjectionLayer layer = projection(canvas, eye);
    for (ProjectionView& view : layer.views) { view.rect = {{3, 5}, {4, 3}}; }
    const RgbPicture seen = compose(eye, {layer});
    for (std::uint32_t y = 0; y < 3; ++y) {
        for (std::uint32_t x = 0; x < 4; ++x) { CHECK(at(seen, x, y)[0] == static_cast<int>(canvas.bytes[4 * ((y + 5) * 8 + x + 3)])); }
    }
}

TEST_CASE("bilinear sampling stays inside the rectangle") {
    // The rectangle is white, all around it black: twice enlarged, no black bleeds in.
    Canvas canvas({8, 8}, {0, 0, 0, 255});
    for (std::uint32_t y = 2; y < 6; ++y) {
        for (std::uint32_t x = 2; x < 6; ++x) { canvas.set(x, y, {255, 255, 255, 255}); }
    }
    const EyeView eye = eyeOf({8, 8});
    ProjectionLayer layer = projection(canvas, eye);
    for (ProjectionView& view : layer.views) { view.rect = {{2, 2}, {4, 4}}; }
    for (const std::uint8_t byte : compose(eye, {layer}).bytes) { CHECK(byte == 255); }
}

TEST_CASE("sampling between texels mixes light") {
    // A black and a white texel side by side, seen by four pixels: centres at 1/8, 3/8, 5/8 and 7/8, so 0, 1/4, 3/4 and 1 of the way.
    Canvas canvas({2, 1}, {0, 0, 0, 255});
    canvas.set(1, 0, {255, 255, 255, 255});
    const RgbPicture seen = compose(eyeOf({4, 1}), {projection(canvas, eyeOf({2, 1}))});
    CHECK(at(seen, 0, 0)[0] == 0);
    CHECK(at(seen, 1, 0)[0] == encoded(0.25));
    CHECK(at(seen, 2, 0)[0] == encoded(0.75));
    CHECK(at(seen, 3, 0)[0] == 255);
}

TEST_CASE("linear pictures are encoded") {
    Canvas canvas({2, 2}, {51, 128, 255, 255});
    canvas.transfer = Transfer::kLinear;
    const EyeView eye = eyeOf({2, 2});
    CHECK(at(compose(eye, {projection(canvas, eye)}), 0, 0) == Rgb{encoded(0.2), encoded(128.0 / 255.0), 255});
    CHECK(encoded(0.2) == 124);  // 0.2 is 0.4845 encoded
}

TEST_CASE("BGR pictures swap their channels") {
    Canvas canvas({2, 2}, {10, 20, 30, 255});
    canvas.texels = Texels::kBgra8;
    const EyeView eye = eyeOf({2, 2});
    CHECK(at(compose(eye, {projection(canvas, eye)}), 1, 1) == Rgb{30, 20, 10});
}

TEST_CASE("halves beyond white are white and NaN is black") {
    const EyeView eye = eyeOf({2, 2});
    const Canvas canvas = halves({2, 2}, {0.5f, 7.0f, -1.0f, 1.0f});
    CHECK(at(compose(eye, {projection(canvas, eye)}), 0, 0) == Rgb{188, 255, 0});  // half the light is 188
    const Canvas nan = halves({2, 2}, {std::nanf(""), INFINITY, 0.0f, 1.0f});
    CHECK(at(compose(eye, {projection(nan, eye)}), 0, 0) == Rgb{0, 255, 0});
}

TEST_CASE("turning the view moves the picture by the predicted pixels") {
    // 64 pixels between tangents -1 and 1. The application's view was turned to the left by atan(1/8): a texel at tangent t appears at
    // (t - 1/8) / (1 + t/8) = -1/8 for t = 0, four pixels to the left of the middle. Columns 31 and 32 are white, their common edge is t =
    // 0.
    Canvas canvas({64, 64}, {0, 0, 0, 255});
    for (std::uint32_t y = 0; y < 64; ++y) {
        canvas.set(31, y, {255, 255, 255, 255});
        canvas.set(32, y, {255, 255, 255, 255});
    }
    const EyeView eye = eyeOf({64, 64});
    EyeView turned = eye;
    turned.stage_from_eye.orientation = glm::angleAxis(std::atan(0.125), glm::dvec3(0, 1, 0));
    const RgbPicture seen = compose(eye, {projection(canvas, turned)});
    for (const std::uint32_t x : {27u, 28u}) { CHECK(at(seen, x, 32)[0] > 240); }
    for (const std::uint32_t x : {25u, 30u, 31u, 32u}) { CHECK(at(seen, x, 32)[0] == 0); }
    // The view reaches from -1 to 1 in its own axes, so to (1 - 1/8) / (1 + 1/8) = 7/9 on the right in the eye's: nothing beyond
    // (7/9 + 1) * 32 = 56.9 pixels.
    const Canvas white({64, 64}, {255, 255, 255, 255});
    const RgbPicture edge = compose(eye, {projection(white, turned)});
    CHECK(at(edge, 55, 32)[0] == 255);
    CHECK(at(edge, 57, 32)[0] == 0);
    CHECK(at(edge, 0, 32)[0] == 255);
}

TEST_CASE("looking up moves the picture down") {
    Canvas canvas({64, 64}, {0, 0, 0, 255});
    for (std::uint32_t x = 0; x < 64; ++x) {
        canvas.set(x, 31, {255, 255, 255, 255});
        canvas.set(x, 32, {255, 255, 255, 255});
    }
    EyeView eye = eyeOf({64, 64});
    const ProjectionLayer level = projection(canvas, eye);
    eye.stage_from_eye.orientation = glm::angleAxis(std::atan(0.125), glm::dvec3(1, 0, 0));
    const RgbPicture seen = compose(eye, {level});
    for (const std::uint32_t y : {35u, 36u}) { CHECK(at(seen, 32, y)[0] > 240); }
    CHECK(at(seen, 32, 31)[0] == 0);
}

TEST_CASE("the projection's position does not move it") {
    const Canvas canvas = noise({16, 16});
    const EyeView eye = eyeOf({16, 16});
    EyeView elsewhere = eye;
    elsewhere.stage_from_eye.position = {3, 4, 5};
    CHECK(compose(eye, {projection(canvas, elsewhere)}) == compose(eye, {projection(canvas, eye)}));
}

TEST_CASE("a narrower view fills only its part of the eye") {
    // Tangents -0.5 to 0.5 of -1 to 1: the middle half, pixels 4 to 11 of 16.
    const Canvas white({4, 4}, {255, 255, 255, 255});
    const double half = std::atan(0.5);
    const RgbPicture seen = compose(eyeOf({16, 16}), {projection(white, {{4, 4}, {}, {-half, half, half, -half}})});
    for (std::uint32_t x = 0; x < 16; ++x) { CHECK(at(seen, x, 8)[0] == (x >= 4 && x < 12 ? 255 : 0)); }
}

TEST_CASE("views upside down are turned over") {
    Canvas canvas({2, 2}, {0, 0, 0, 255});
    canvas.set(0, 0, {255, 0, 0, 255});
    const EyeView eye = eyeOf({2, 2});
    EyeView flipped = eye;
    std::swap(flipped.fov.up_rad, flipped.fov.down_rad);
    CHECK(at(compose(eye, {projection(canvas, flipped)}), 0, 1) == Rgb{255, 0, 0});
}

TEST_CASE("a quad covers the pixels that its corners say") {
    // 32 pixels between tangents -1 and 1, 16 per unit. A quad 2 m ahead from x = -0.5 to 1.5 and y = 0 to 1 spans tangents -0.25 to 0.75
    // and 0 to 0.5: columns 12 to 27, rows 8 to 15.
    const Canvas white({4, 4}, {255, 255, 255, 255});
    const RgbPicture seen = compose(eyeOf({32, 32}), {quad(white, {0.5, 0.5, -2.0}, {2.0, 1.0})});
    for (std::uint32_t y = 0; y < 32; ++y) {
        for (std::uint32_t x = 0; x < 32; ++x) {
            const bool is_inside = x >= 12 && x < 28 && y >= 8 && y < 16;
            if ((at(seen, x, y)[0] == 255) != is_inside) { FAIL_CHECK(x << ", " << y); }
        }
    }
}

TEST_CASE("a quad shifts between the eyes by its disparity") {
    // 100 pixels per unit of tangent; 0.08 m between the eyes at 2 m are 4 pixels: nearer things lie further left for the right eye.
    const Canvas white({4, 4}, {255, 255, 255, 255});
    const Layer layer = quad(white, {0, 0, -2}, {0.4, 0.4});
    const auto firstColumn = [&](double eye_x) {
        EyeView eye = eyeOf({200, 200});
        eye.stage_from_eye.position.x = eye_x;
        const RgbPicture seen = compose(eye, {layer});
        std::uint32_t x = 0;
        while (x < 200 && at(seen, x, 100) == kBlack) { ++x; }
        return x;
    };
    CHECK(firstColumn(-0.04) == 92);
    CHECK(firstColumn(0.04) == 88);
}

TEST_CASE("a quad's top left texel is at its top left") {
    Canvas canvas({2, 2}, {0, 0, 0, 255});
    canvas.set(0, 0, {255, 0, 0, 255});
    canvas.set(1, 0, {0, 255, 0, 255});
    canvas.set(0, 1, {0, 0, 255, 255});
    const RgbPicture seen = compose(eyeOf({32, 32}), {quad(canvas, {0, 0, -1}, {2, 2})});
    CHECK(at(seen, 2, 2) == Rgb{255, 0, 0});
    CHECK(at(seen, 29, 2) == Rgb{0, 255, 0});
    CHECK(at(seen, 2, 29) == Rgb{0, 0, 255});
}

TEST_CASE("quads are seen from their front and ahead only") {
    const Canvas white({4, 4}, {255, 255, 255, 255});
    QuadLayer turned_away = quad(white, {0, 0, -2}, {9, 9});
    turned_away.stage_from_quad.orientation = glm::angleAxis(std::acos(-1.0), glm::dvec3(0, 1, 0));
    CHECK(at(compose(eyeOf({8, 8}), {turned_away}), 4, 4) == kBlack);
    CHECK(at(compose(eyeOf({8, 8}), {quad(white, {0, 0, 2}, {9, 9})}), 4, 4) == kBlack);
    CHECK(at(compose(eyeOf({8, 8}), {quad(white, {0, 0, 0}, {9, 9})}), 4, 4) == kBlack);
    CHECK(at(compose(eyeOf({8, 8}), {quad(white, {0, 0, -2}, {9, 9})}), 4, 4)[0] == 255);
}

TEST_CASE("quads can be for one eye") {
    const Canvas white({4, 4}, {255, 255, 255, 255});
    QuadLayer layer = quad(white, {0, 0, -1}, {9, 9});
    layer.visibility = Visibility::kRight;
    CHECK(at(compose(eyeOf({4, 4}), {layer}, kLeft), 2, 2) == kBlack);
    CHECK(at(compose(eyeOf({4, 4}), {layer}, kRight), 2, 2)[0] == 255);
    layer.visibility = Visibility::kLeft;
    CHECK(at(compose(eyeOf({4, 4}), {layer}, kLeft), 2, 2)[0] == 255);
    CHECK(at(compose(eyeOf({4, 4}), {layer}, kRight), 2, 2) == kBlack);
}

TEST_CASE("later layers cover earlier ones") {
    const Canvas red({2, 2}, {255, 0, 0, 0}), blue({2, 2}, {0, 0, 255, 0});
    const Layer near = quad(red, {0, 0, -1}, {9, 9}), far = quad(blue, {0, 0, -2}, {9, 9});
    // Not by depth, and without the flag alpha does not matter.
    CHECK(at(compose(eyeOf({2, 2}), {near, far}), 0, 0) == Rgb{0, 0, 255});
    CHECK(at(compose(eyeOf({2, 2}), {far, near}), 0, 0) == Rgb{255, 0, 0});
}

TEST_CASE("premultiplied alpha adds to what shines through") {
    const Canvas below({2, 2}, {200, 100, 0, 255}), above({2, 2}, {64, 0, 32, 102});  // alpha 0.4
    const RgbPicture seen = compose(eyeOf({2, 2}), {quad(below, {0, 0, -2}, {9, 9}), blended(quad(above, {0, 0, -1}, {9, 9}), false)});
    CHECK(at(seen, 0, 0) == Rgb{encoded(decoded(64) + 0.6 * decoded(200)), encoded(0.6 * decoded(100)), encoded(decoded(32))});
}

TEST_CASE("unpremultiplied alpha multiplies first") {
    const Canvas below({2, 2}, {200, 100, 0, 255}), above({2, 2}, {64, 0, 32, 102});
    const RgbPicture seen = compose(eyeOf({2, 2}), {quad(below, {0, 0, -2}, {9, 9}), blended(quad(above, {0, 0, -1}, {9, 9}), true)});
    CHECK(at(seen, 0, 0) == Rgb{encoded(0.4 * decoded(64) + 0.6 * decoded(200)), encoded(0.6 * decoded(100)), encoded(0.4 * decoded(32))});
}

TEST_CASE("half-transparent white over black is half the light") {
    const Canvas white = halves({2, 2}, {1.0f, 1.0f, 1.0f, 0.5f});
    CHECK(at(compose(eyeOf({2, 2}), {blended(quad(white, {0, 0, -1}, {9, 9}), true)}), 0, 0) == Rgb{188, 188, 188});
    CHECK(at(compose(eyeOf({2, 2}), {blended(quad(white, {0, 0, -1}, {9, 9}), false)}), 0, 0) == Rgb{255, 255, 255});
}

TEST_CASE("rectangles outside the picture are refused") {
    const Canvas canvas({4, 4}, {1, 2, 3, 4});
    QuadLayer layer = quad(canvas, {0, 0, -1}, {1, 1});
    for (const Rect& rect : {Rect{{0, 0}, {5, 4}}, Rect{{4, 0}, {1, 1}}, Rect{{0xffffffffu, 0}, {1, 1}}}) {
        layer.rect = rect;
        CHECK_THROWS_AS((void)compose(eyeOf({2, 2}), {layer}), std::invalid_argument);
    }
    layer.rect = canvas.whole();
    layer.picture.bytes = layer.picture.bytes.subspan(1);
    CHECK_THROWS_AS((void)compose(eyeOf({2, 2}), {layer}), std::invalid_argument);
}

TEST_CASE("empty rectangles show nothing") {
    const Canvas canvas({4, 4}, {255, 255, 255, 255});
    const EyeView eye = eyeOf({2, 2});
    for (const Rect& rect : {Rect{{0, 0}, {0, 4}}, Rect{{0, 0}, {4, 0}}, Rect{{4, 4}, {0, 0}}}) {
        QuadLayer flat = quad(canvas, {0, 0, -1}, {9, 9});
        CylinderLayer cylinder{canvas.picture(), canvas.whole(), {}, 0.0, 4.0 * kEighth, 1.0, Visibility::kBoth, {}};
        SphereLayer sphere{canvas.picture(), canvas.whole(), {}, 0.0, 8.0 * kEighth, kEighth, -kEighth, Visibility::kBoth, {}};
        ProjectionLayer views = projection(canvas, eye);
        CHECK(at(compose(eye, {flat}), 0, 0) != kBlack);
        CHECK(at(compose(eye, {cylinder}), 0, 0) != kBlack);
        CHECK(at(compose(eye, {sphere}), 0, 0) != kBlack);
        CHECK(at(compose(eye, {views}), 0, 0) != kBlack);
        flat.rect = cylinder.rect = sphere.rect = views.views[kLeft].rect = rect;
        CHECK(compose(eye, {flat, cylinder, sphere, views}) == compose(eye, {}));
        // The other eye's part of a projection is whole.
        CHECK(at(compose(eye, {views}, kRight), 0, 0) != kBlack);
    }
}

TEST_CASE("eyes side by side keep their pixels") {
    const RgbPicture left{{1, 2}, {1, 2, 3, 4, 5, 6}}, right{{2, 1}, {7, 8, 9, 10, 11, 12}};
    CHECK(putSideBySide(left, right) == RgbPicture{{3, 2}, {1, 2, 3, 7, 8, 9, 10, 11, 12, 4, 5, 6, 0, 0, 0, 0, 0, 0}});
}

TEST_CASE("pictures in files come back and the files are the same every time") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("binosplat_compose_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const EyeView eye = eyeOf({33, 17});
    const RgbPicture picture = compose(eye, {projection(noise({33, 17}), eye)});
    const auto bytesOf = [](const std::filesystem::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return std::string{std::istreambuf_iterator<char>(stream), {}};
    };
    writePng(folder / "a.png", picture);
    CHECK(readPng(folder / "a.png") == picture);
    const std::string once = bytesOf(folder / "a.png");
    // Chunks that would tell one run from another.
    for (const char* chunk : {"tIME", "tEXt", "iTXt", "zTXt"}) { CHECK(once.find(chunk) == std::string::npos); }
    // Time stamps of files count whole seconds at worst: not even a later second changes the bytes, as there is no chunk for it.
    writePng(folder / "b.png", picture);
    CHECK(bytesOf(folder / "b.png") == once);
    CHECK_THROWS_AS(writePng(folder / "none" / "c.png", picture), std::runtime_error);
    std::size_t files = 0;
    for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator(folder)) { ++files; }
    CHECK(files == 2);
    std::filesystem::remove_all(folder);
}

#ifndef _WIN32  // where links take a privilege
TEST_CASE("a picture is not written through a link or over an unfinished one") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("binosplat_planted_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "victim") << "keep me";
    for (const char* name : {".a.unfinished.png", "b.png"}) { std::filesystem::create_symlink("victim", folder / name); }
    std::ofstream(nameUnfinishedPicture(folder / "c.png")) << "keep me";
    const RgbPicture picture{{1, 1}, {1, 2, 3}};
    for (const char* name : {"a.png", "c.png"}) {
        CHECK_THROWS_WITH_AS(writePng(folder / name, picture), ((folder / name).string() + ": cannot be written (File exists)").c_str(),
                             std::runtime_error);
    }
    writePng(folder / "b.png", picture);
    CHECK(readPng(folder / "b.png") == picture);
    CHECK(std::filesystem::file_size(folder / "victim") == 7);
    CHECK(std::filesystem::file_size(nameUnfinishedPicture(folder / "c.png")) == 7);
    std::filesystem::remove_all(folder);
}
#endif

TEST_CASE("a cylinder's picture lies on its arc about the middle") {
    // A quarter turn wide and as high as wide: longitudes within 45 degrees, heights within pi/4 of the radius.
    Canvas canvas({2, 1}, {255, 0, 0, 255});
    canvas.set(1, 0, {0, 0, 255, 255});
    CylinderLayer layer{canvas.picture(), canvas.whole(), {}, 0.0, 2.0 * kEighth, 1.0, Visibility::kBoth, {}};
    // 100 pixels per unit of tangent, so far away that the left edge is the eye's, and the top where y/z = pi/4 in the middle.
    const RgbPicture far_away = compose(eyeOf({200, 200}), {layer});
    CHECK(at(far_away, 10, 100) == Rgb{255, 0, 0});
    CHECK(at(far_away, 190, 100) == Rgb{0, 0, 255});
    CHECK(at(far_away, 99, 23)[0] > 100);
    CHECK(at(far_away, 99, 20) == kBlack);
    // At 45 degrees to the side the wall is farther away by sqrt(2), so its edge is seen at pi/4 * sqrt(2) > 1.
    CHECK(at(far_away, 1, 1)[0] > 100);
    // From its axis it looks the same, however large; from nearer to its wall it is wider than the view.
    layer.radius_m = 2.0;
    CHECK(compose(eyeOf({200, 200}), {layer}) == far_away);
    layer.radius_m = INFINITY;
    CHECK(compose(eyeOf({200, 200}), {layer}) == far_away);
    layer.radius_m = 2.0;
    layer.stage_from_cylinder.position.z = 1.0;
    CHECK(at(compose(eyeOf({200, 200}), {layer}), 99, 1)[0] > 100);
    layer.stage_from_cylinder.orientation = glm::angleAxis(4.0 * kEighth, glm::dvec3(0, 1, 0));
    CHECK(at(compose(eyeOf({200, 200}), {layer}), 100, 100) == kBlack);
    layer.stage_from_cylinder = {};
    layer.visibility = Visibility::kRight;
    CHECK(at(compose(eyeOf({200, 200}), {layer}), 100, 100) == kBlack);
    CHECK(at(compose(eyeOf({200, 200}), {layer}, kRight), 150, 100) == Rgb{0, 0, 255});
}

TEST_CASE("a sphere's picture lies between its angles") {
    Canvas canvas({2, 2}, {255, 0, 0, 255});
    canvas.set(1, 0, {0, 255, 0, 255});
    canvas.set(0, 1, {0, 0, 255, 255});
    canvas.set(1, 1, {255, 255, 255, 255});
    // All longitudes, latitudes within 45 degrees.
    SphereLayer layer{canvas.picture(), canvas.whole(), {}, 0.0, 8.0 * kEighth, kEighth, -kEighth, Visibility::kBoth, {}};
    EyeView eye = eyeOf({64, 64});
    const auto looking = [&](double yaw_rad, double pitch_rad) {
        eye.stage_from_eye.orientation = glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch_rad, glm::dvec3(1, 0, 0));
        return at(compose(eye, {layer}), 32, 32);
    };
    // A quarter of the picture's width and height from the middle, where its texels are.
    CHECK(looking(2.0 * kEighth, 0.5 * kEighth)[0] > 240);
    CHECK(looking(-2.0 * kEighth, 0.5 * kEighth)[1] > 240);
    CHECK(looking(2.0 * kEighth, -0.5 * kEighth)[2] > 240);
    CHECK(looking(0.0, 1.5 * kEighth) == kBlack);
    CHECK(looking(0.0, -1.5 * kEighth) == kBlack);
    // A sphere about the eye is as one far away; from outside only its far half is seen, from within.
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

TEST_CASE("a cube map's faces are in Vulkan's order") {
    const std::array<Canvas, 6> faces{Canvas({2, 2}, {255, 0, 0, 255}),   Canvas({2, 2}, {0, 255, 0, 255}),
                                      Canvas({2, 2}, {0, 0, 255, 255}),   Canvas({2, 2}, {255, 255, 0, 255}),
                                      Canvas({2, 2}, {255, 0, 255, 255}), Canvas({2, 2}, {0, 255, 255, 255})};
    CubeLayer layer;
    for (std::size_t face = 0; face < 6; ++face) { layer.faces[face] = faces[face].picture(); }
    EyeView eye = eyeOf({8, 8});
    eye.stage_from_eye.position = {5, 6, 7};  // infinitely far, so that it does not matter
    const auto looking = [&](double yaw_rad, double pitch_rad) {
        eye.stage_from_eye.orientation = glm::angleAxis(yaw_rad, glm::dvec3(0, 1, 0)) * glm::angleAxis(pitch_rad, glm::dvec3(1, 0, 0));
        return at(compose(eye, {layer}), 4, 4);
    };
    CHECK(looking(-2.0 * kEighth, 0) == Rgb{255, 0, 0});
    CHECK(looking(2.0 * kEighth, 0) == Rgb{0, 255, 0});
    CHECK(looking(0, 2.0 * kEighth) == Rgb{0, 0, 255});
    CHECK(looking(0, -2.0 * kEighth) == Rgb{255, 255, 0});
    CHECK(looking(4.0 * kEighth, 0) == Rgb{255, 0, 255});
    CHECK(looking(0, 0) == Rgb{0, 255, 255});
    layer.stage_from_cube = glm::angleAxis(2.0 * kEighth, glm::dvec3(0, 1, 0));  // its -z is the stage's -x
    CHECK(looking(2.0 * kEighth, 0) == Rgb{0, 255, 255});
    layer.visibility = Visibility::kRight;
    CHECK(looking(0, 0) == kBlack);
}

TEST_CASE("the top left texel of a cube's face is where Vulkan has it") {
    // On -z, s grows towards -x and t towards -y.
    Canvas marked({8, 8}, {0, 0, 0, 255});
    for (std::uint32_t y = 0; y < 4; ++y) {
        for (std::uint32_t x = 0; x < 4; ++x) { marked.set(x, y, {255, 0, 0, 255}); }
    }
    CubeLayer layer;
    layer.faces.fill(marked.picture());
    const RgbPicture seen = compose(eyeOf({8, 8}), {layer});
    CHECK(at(seen, 6, 1) == Rgb{255, 0, 0});
    CHECK(at(seen, 1, 1) == kBlack);
    CHECK(at(seen, 6, 6) == kBlack);
}

TEST_CASE("the room shows as far as alpha lets it or is added") {
    const Backdrop room{{1.0, 0.0, 0.0}, false}, added{{1.0, 0.0, 0.0}, true};
    const auto seen = [](const std::vector<Layer>& layers, const Backdrop& backdrop) {
        return at(composeEye(eyeOf({2, 2}), kLeft, layers, backdrop), 0, 0);
    };
    CHECK(seen({}, room) == Rgb{255, 0, 0});
    // Half of blue's light over it: half the light is the byte 188 of sRGB.
    const Canvas blue = halves({2, 2}, {0.0f, 0.0f, 1.0f, 0.5f}), green({2, 2}, {0, 255, 0, 255});
    CHECK(seen({blended(quad(blue, {0, 0, -1}, {9, 9}), true)}, room) == Rgb{188, 0, 188});
    CHECK(seen({quad(green, {0, 0, -2}, {9, 9})}, room) == Rgb{0, 255, 0});
    CHECK(seen({quad(green, {0, 0, -2}, {9, 9})}, added) == Rgb{255, 255, 0});
    CHECK(seen({quad(green, {0, 0, -2}, {9, 9}), blended(quad(blue, {0, 0, -1}, {9, 9}), true)}, room) == Rgb{0, 188, 188});
}

}  // namespace simulated_compose_test
