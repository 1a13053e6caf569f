// Facts about pictures on their way to a headset: the pass compared with its float64 twin, on the device, and
// the images they become.
#include "engine/passes/present.h"
#include "engine/twin/present.h"
#include "tests/engine/gpu/device_image.h"
#include "tests/engine/passes/stereo_cases.h"

SUITE(present) {

using Colours = std::vector<glm::vec4>;
using Bytes = std::vector<std::uint32_t>;

// A picture; optionally with sums of depth or with the words from which later pictures are made, and with the
// kinds of its tiles and pixels.
struct Shown {
    glm::uvec2 size_px;
    Colours colours;
    std::vector<float> depth_sums = {};
    std::vector<gpu::uint> words = {}, tile_kinds = {}, pixel_classes = {};
    bool halves = false;
    Bytes behind = {};            // what lies in front of it and behind it
    std::uint32_t kept_bits = 0;  // bits of `behind` that stay as they are; then there is no blending
    std::vector<float> mesh_depths = {};
};

struct Presented {
    Bytes pixels;
    std::vector<float> depths;
};

Presented runPresent(Gpu& gpu, const Shown& shown, const reference::Presentation& how = {}) {
    const auto upload = [&](const auto& values) {
        return values.empty() ? Buffer() : gpu.upload("input", values);
    };
    const Buffer colours = shown.halves ? upload(packHalves(shown.colours)) : upload(shown.colours),
                 sums = upload(shown.depth_sums), words = upload(shown.words),
                 kinds = upload(shown.tile_kinds), classes = upload(shown.pixel_classes), none = Buffer();
    const std::size_t count = shown.colours.size();
    const bool is_alone = shown.behind.empty(), has_meshes = !shown.mesh_depths.empty(),
               with_depth = !shown.words.empty() || !shown.depth_sums.empty();
    const Buffer pixels = is_alone ? gpu.allocate<std::uint32_t>("pixels", count) : upload(shown.behind),
                 depths = has_meshes ? upload(shown.mesh_depths) : gpu.allocate<float>("depths", count);
    const gpu::PresentPass pass{.colours = at(colours),
                                .half_colours = at(colours),
                                .depths = at(sums),
                                .words = at(words),
                                .tile_kinds = at(kinds),
                                .pixel_classes = at(classes),
                                .pixels = at(pixels),
                                .device_depths = at(with_depth ? depths : none),
                                .mesh_depths = at(has_meshes ? depths : none),
                                .size_px = shown.size_px,
                                .depth_scale = static_cast<float>(how.near),
                                .depth_offset = static_cast<float>(how.depth_offset),
                                .blue_first = how.blue_first,
                                .linear = how.linear,
                                .see_through = how.see_through,
                                .over = !is_alone && shown.kept_bits == 0,
                                .is_cut = how.is_cut,
                                .kept_bits = shown.kept_bits,
                                .of_surface = 0};
    gpu.dispatch(gpu.kernel(PresentKernel{.half_colours = shown.halves}), pass,
                 (shown.size_px + glm::uvec2(15, 7)) / glm::uvec2(16, 8));
    return {gpu.readBack<std::uint32_t>(pixels, count), gpu.readBack<float>(depths, with_depth ? count : 0)};
}

// Every pixel has a different colour that half floats can represent, from well below 0 to well above 1.
Colours makeColours(glm::uvec2 size_px) {
    Colours colours;
    for (std::uint32_t i = 0; i < size_px.x * size_px.y; ++i) {
        const auto at = static_cast<float>(i);
        colours.emplace_back(0.6f + 0.8f * std::sin(at), 0.5f + 0.4f * std::sin(0.37f * at),
                             0.5f + 0.6f * std::cos(0.11f * at), 0.5f + 0.5f * std::sin(0.05f * at));
    }
    return unpackHalves(packHalves(colours));
}

// Bytes may differ by one if the value lies between two bytes, within the rounding of float32.
std::size_t countOff(std::span<const std::uint32_t> actual, const Bytes& expected, int tolerance) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
        for (int shift = 0; shift < 32; shift += 8) {
            const int a = static_cast<int>((actual[i] >> shift) & 255),
                      b = static_cast<int>((expected[i] >> shift) & 255);
            off += std::abs(a - b) > tolerance;
        }
    }
    return off;
}

std::vector<glm::dvec4> asDoubles(const Colours& colours) { return {colours.begin(), colours.end()}; }

TEST_CASE_FIXTURE(Gpu, "pictures become the bytes of their twin, in every order of channels and encoding") {
    for (const glm::uvec2 size_px :
         {glm::uvec2(1, 1), glm::uvec2(15, 17), glm::uvec2(16, 16), glm::uvec2(100, 70)}) {
        Shown shown{size_px, makeColours(size_px)};
        for (int choice = 0; choice < 8; ++choice) {
            INFO("size ", size_px.x, ", choice ", choice);
            const reference::Presentation how{(choice & 1) != 0, (choice & 2) != 0, 0.2, (choice & 4) != 0};
            shown.halves = false;
            const Bytes actual = runPresent(*this, shown, how).pixels,
                        expected = reference::present(asDoubles(shown.colours), how);
            CHECK(countOff(actual, expected, 1) == 0);
            CHECK(countOff(actual, expected, 0) <= 1 + expected.size() / 500);
            shown.halves = true;
            CHECK(runPresent(*this, shown, how).pixels == actual);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "of a picture over another's words only the bits that are not kept change") {
    Shown shown{{20, 10}, makeColours({20, 10})};
    Bytes expected = reference::present(asDoubles(shown.colours), {});
    shown.behind.assign(expected.rbegin(), expected.rend());
    shown.kept_bits = 0xff0000ffu;
    reference::keepBits(expected, shown.behind, shown.kept_bits);
    const Bytes actual = runPresent(*this, shown).pixels;
    CHECK(countOff(actual, expected, 1) == 0);
    for (std::size_t i = 0; i < actual.size(); ++i) {
        CHECK((actual[i] & shown.kept_bits) == (shown.behind[i] & shown.kept_bits));
    }
}

TEST_CASE_FIXTURE(Gpu, "tints say what made a pixel, and nothing of tiles that no lens shows") {
    const glm::uvec2 size_px(3 * gpu::kTileSize, gpu::kTileSize);
    static_assert(gpu::kHole == 2);
    const Bytes shown =
        runPresent(*this, {.size_px = size_px,
                           .colours = Colours(size_px.x * size_px.y, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f)),
                           .tile_kinds = {gpu::kTileHidden, gpu::kTileEdge, 0},
                           // All are holes.
                           .pixel_classes = std::vector<gpu::uint>(3 * gpu::kTileSize, 0xaaaaaaaa)})
            .pixels;
    CHECK(shown[0] == 0xff000000);
    CHECK(shown[gpu::kTileSize] == 0xff662400);      // 0.4 of 0, 0.35, 1
    CHECK(shown[2 * gpu::kTileSize] == 0xff000066);  // 0.4 of red
}

TEST_CASE_FIXTURE(Gpu, "channels have their places, light is multiplied by alpha, and NaN is no colour") {
    const auto present = [&](const Colours& colours, const reference::Presentation& how) {
        Bytes pixels = runPresent(*this, {{colours.size(), 1}, colours}, how).pixels;
        CHECK(pixels == reference::present(asDoubles(colours), how));
        return pixels;
    };
    const Colours plain{{1.0f, 0.5f, 0.0f, 0.25f}};
    CHECK(present(plain, {false, false, 0.2}) == Bytes{0xff0080ffu});
    CHECK(present(plain, {true, false, 0.2}) == Bytes{0xffff8000u});
    CHECK(present(plain, {false, true, 0.2}) == Bytes{0xff0037ffu});  // 0.5 is 21.4 % of the light
    // White at half alpha, encoded: half of its light is byte 188. Then a quarter of red; nothing; more than
    // full.
    const reference::Presentation through{false, false, 0.2, true};
    Bytes seen = present(
        {{0.5f, 0.5f, 0.5f, 0.5f}, {0.25f, 0, 0, 0.25f}, {0.3f, 0.3f, 0.3f, 0}, {1, 0.5f, 0, 2}}, through);
    CHECK((seen.back() >> 24) == 255u);
    seen.pop_back();
    CHECK(seen == Bytes{0x80bcbcbcu, 0x40000089u, 0});
    // Opaque colours have the same bytes as without.
    CHECK(present({{1.0f, 0.5f, 0.2f, 1.0f}}, through) == present({{1.0f, 0.5f, 0.2f, 1.0f}}, {}));
    const float nan = std::numeric_limits<float>::quiet_NaN(),
                infinity = std::numeric_limits<float>::infinity();
    CHECK(present(
              {{nan, nan, nan, nan}, {infinity, -infinity, nan, 1}, {-1, 2, -0.0f, 1}, {1e38f, -1e38f, 1, 0}},
              {false, false, 0.2}) == Bytes{0xff000000u, 0xff0000ffu, 0xff00ff00u, 0xffff00ffu});
}

TEST_CASE_FIXTURE(Gpu, "depth is near over depth, of sums and of words, and nothing is infinitely far") {
    // Alpha 0.5 at depth 4, alpha 1 at the near plane and in front of it, nothing, almost nothing, alpha
    // without depth.
    const Shown summed{
        .size_px = {6, 1},
        .colours =
            {{0, 0, 0, 0.5f}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0.001f}, {0, 0, 0, 0.5f}},
        .depth_sums = {2.0f, 0.25f, 0.1f, 0.0f, 0.001f, std::numeric_limits<float>::quiet_NaN()}};
    // Depth 4 and, to 19 bits, 3; in front of the near plane; infinitely far; a pixel that moves nowhere;
    // almost nothing.
    const Shown moving{
        .size_px = {6, 1},
        .colours =
            {{0, 0, 0, 0.5f}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 0.5f}, {0, 0, 0, 1}, {0, 0, 0, 0.001f}},
        .words = {packMoving(0.25, true, 3), packMoving(1.0 / 3.0, true, 31), packMoving(9.0, true, 0),
                  packMoving(0.0, true, 0), 0, packMoving(0.25, true, 0)}};
    for (const Shown* shown : {&summed, &moving}) {
        reference::Presentation how{false, false, 0.25};
        how.by_inverse = shown == &moving;
        std::vector<double> sums(shown->depth_sums.begin(), shown->depth_sums.end());
        for (std::size_t i = 0; i < shown->words.size(); ++i) {
            sums.push_back(static_cast<double>(shown->colours[i].a) /
                           unpackArrival(shown->words[i]).inverse_depth);
        }
        const std::vector<double> expected =
            reference::presentDepths(asDoubles(shown->colours), sums, shown->size_px.x, how);
        if (shown == &summed) { CHECK(expected == std::vector<double>{0.0625, 1.0, 1.0, 0.0, 0.0, 0.0}); }
        const Presented presented = runPresent(*this, *shown, how);
        for (std::size_t i = 0; i < sums.size(); ++i) {
            CHECK(presented.depths[i] == doctest::Approx(expected[i]).epsilon(1e-6));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "the depth at a silhouette is of the surface that makes up half of the pixel") {
    // A pane in front of a slanted wall. Its edge, which is not straight, takes `soft_px` from opaque to
    // nothing.
    constexpr glm::uvec2 kSizePx(48, 40);
    for (int way = 0; way < 10; ++way) {
        const bool by_words = way % 2 != 0;
        const double soft_px = std::array{0.0, 1.0, 2.5, 4.0, 8.0}[way / 2];
        CAPTURE(by_words);
        CAPTURE(soft_px);
        reference::Presentation how{false, false, 0.25};
        how.by_inverse = by_words;
        Shown shown{.size_px = kSizePx, .colours = Colours(kSizePx.x * kSizePx.y, {0, 0, 0, 1})};
        std::vector<double> back, shares, sums;
        for (std::size_t i = 0; i < shown.colours.size(); ++i) {
            const glm::dvec2 at(i % kSizePx.x, i / kSizePx.x);
            const double beyond_px = at.x - 20.3 - 0.3 * at.y - 2.0 * std::sin(0.3 * at.y);
            back.push_back(1.0 / 7.0 + 0.0004 * at.x - 0.0003 * at.y);
            shares.push_back(std::clamp(0.5 - beyond_px / std::max(soft_px, 1e-9), 0.0, 1.0));
            if (by_words) {
                shown.words.push_back(packMoving(glm::mix(back[i], 0.5, shares[i]), true, 0));
                sums.push_back(1.0 / unpackArrival(shown.words[i]).inverse_depth);
            } else {
                shown.depth_sums.push_back(static_cast<float>(glm::mix(1.0 / back[i], 2.0, shares[i])));
                sums.push_back(static_cast<double>(shown.depth_sums[i]));
            }
        }
        const std::vector<double> expected =
            reference::presentDepths(asDoubles(shown.colours), sums, kSizePx.x, how);
        const Presented presented = runPresent(*this, shown, how);
        for (std::size_t i = 0; i < expected.size(); ++i) {
            CHECK(presented.depths[i] == doctest::Approx(expected[i]).epsilon(1e-5));
            if (std::abs(shares[i] - 0.5) < 0.03) { continue; }  // half of either, or so: the wall is slanted
            const double surface = shares[i] > 0.5 ? 0.5 : back[i];
            CHECK(expected[i] == doctest::Approx(how.near * surface).epsilon(0.03));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "surfaces seen at a low angle and thin things keep the depth that they have") {
    const glm::uvec2 size_px(40, 30);
    Shown shown{.size_px = size_px,
                .colours = Colours(size_px.x * size_px.y, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f))};
    for (std::uint32_t i = 0; i < size_px.x * size_px.y; ++i) {
        const double row = i / size_px.x, column = i % size_px.x;
        // A floor up to its horizon; or a pole that blurs over three pixels and never covers one.
        shown.words.push_back(
            packMoving(row > 15.0 ? 0.01 * (row - 15.0)
                                  : 0.05 + 0.2 * std::max(0.0, 0.6 - 0.3 * std::abs(column - 20.0)),
                       true, 0));
    }
    const Presented presented = runPresent(*this, shown, {false, false, 0.25});
    for (std::size_t i = 0; i < shown.words.size(); ++i) {
        if (i / size_px.x == 15 || i / size_px.x == 16) { continue; }  // between both
        CHECK(presented.depths[i] ==
              doctest::Approx(0.25 * unpackArrival(shown.words[i]).inverse_depth).epsilon(1e-6));
    }
}

TEST_CASE_FIXTURE(Gpu, "a picture lies over a program's own bytes, before or behind its depths") {
    Shown shown{{64, 4}, makeColours({64, 4})};
    std::vector<double> sums, meshes;
    for (std::uint32_t i = 0; i < 256; ++i) {
        for (int c = 0; c < 3; ++c) { shown.colours[i][c] *= shown.colours[i].a; }
        shown.behind.push_back(0xff000000u | i << 16 | (255 - i) << 8 | 77);
        sums.push_back(static_cast<double>(shown.colours[i].a) * (1.0 + 0.1 * (i % 16)));
        meshes.push_back(0.25 / (1.05 + 0.1 * (i / 16)) + 0.125);
        shown.depth_sums.push_back(static_cast<float>(sums.back()));
        shown.mesh_depths.push_back(static_cast<float>(meshes.back()));
    }
    for (int choice = 0; choice < 8; ++choice) {
        const reference::Presentation how{(choice & 1) != 0, (choice & 2) != 0, 0.25, false, 0.125,
                                          (choice & 4) != 0};
        const Bytes expected =
            reference::presentOver(asDoubles(shown.colours), sums, shown.behind, meshes, how);
        const Presented presented = runPresent(*this, shown, how);
        CHECK(countOff(presented.pixels, expected, 1) == 0);
        const std::vector<double> own =
            reference::presentDepths(asDoubles(shown.colours), sums, shown.size_px.x, how);
        for (std::size_t i = 0; i < own.size(); ++i) {
            const bool is_splats = (how.is_cut || own[i] > meshes[i]) && shown.colours[i].a >= 0.5f;
            CHECK(presented.depths[i] == doctest::Approx(is_splats ? own[i] : meshes[i]).epsilon(1e-6));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "the bytes reach an image, and a window shows what other axes see of it") {
    const glm::uvec2 size_px(21, 13), view_px(10, 7);
    const Colours colours = makeColours(size_px);
    const Picture eye{.colours = upload("colours", colours), .depths = {}};
    const Bytes shown = reference::present(asDoubles(colours), {});
    const DeviceImage image(context(), size_px);
    Presenter presenter(context(), DeviceImage::kFormat);
    const glm::dmat3 within(1, 0, 0, 0, 1, 0, 5, 3, 1),
        turned(0.9, -0.2, 0.004, 0.3, 1.1, -0.006, 3.3, 2.7, 1.0);
    for (const glm::dmat3& picture_from_view : {within, turned}) {
        const Buffer whole(context(), "read-back", 4 * colours.size(), MemoryKind::kReadback),
            seen(context(), "read-back", 4 * view_px.x * view_px.y, MemoryKind::kReadback);
        run([&](Commands& commands) {
            presenter.record(commands, {&eye, size_px, nullptr, *image.image, {}}, 0.2);
            commands.copy(presenter.turn(commands, size_px, view_px, picture_from_view), seen, seen.bytes());
            image.copyLevel(commands, 0, size_px, whole, 0);
        });
        CHECK(countOff(whole.mapped<std::uint32_t>(), shown, 1) == 0);
        // The same bytes where the axes are the picture's own.
        CHECK(countOff(seen.mapped<std::uint32_t>(),
                       reference::turn(shown, size_px, view_px, picture_from_view, false),
                       picture_from_view == within ? 0 : 1) == 0);
    }
    CHECK_THROWS_WITH(Presenter(context(), vk::Format::eR16G16B16A16Sfloat),
                      doctest::Contains("8-bit RGBA or BGRA"));
}

}  // SUITE(present)
