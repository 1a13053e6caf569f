// Facts about the copy of a frame's picture: it is available three frames later, and shows what the view saw.
#include "app/view/scenes/picture_copy.h"
#include "app/scores/metrics.h"
#include "engine/picture/turned.h"
#include "tests/engine/gpu/gpu_fixture.h"

#include <glm/gtc/packing.hpp>

SUITE(picture_copy) {

// A smooth picture, of floats or half floats.
struct Painted {
    Painted(Gpu& gpu, glm::uvec2 size_px, bool half_floats) : image{size_px, 4, {}} {
        std::vector<glm::vec4> colours;
        for (std::uint32_t i = 0; i < size_px.x * size_px.y; ++i) {
            const glm::vec2 at = glm::vec2(i % size_px.x, i / size_px.x) / glm::vec2(size_px);
            colours.emplace_back(at.x, at.y, 0.5f + 0.5f * std::sin(9.0f * at.x * at.y), 1.0f);
            for (int c = 0; c < 4; ++c) { image.values.push_back(colours.back()[c]); }
        }
        std::vector<glm::uvec2> halves;
        for (const glm::vec4& c : colours) {
            halves.emplace_back(glm::packHalf2x16({c.r, c.g}), glm::packHalf2x16({c.b, c.a}));
        }
        picture.size_px = size_px;
        picture.half_floats = half_floats;
        picture.colours = half_floats ? gpu.upload("colours", halves) : gpu.upload("colours", colours);
        eye.size_px = size_px;
        eye.intrinsics = intrinsicsFromFovX(1.2, size_px);
    }

    Image image;
    Picture picture;
    Eye eye{};
};

TEST_CASE_FIXTURE(Gpu, "a copy shows what the view saw of the picture, however many of its rows fit") {
    for (const glm::uvec2 size_px : {glm::uvec2(48, 37), glm::uvec2(1200, 1001)}) {
        for (const bool half_floats : {true, false}) {
            CAPTURE(size_px.x);
            CAPTURE(half_floats);
            const Painted painted(*this, size_px, half_floats);
            Eye view = painted.eye;
            view.size_px = {40, 30};
            view.intrinsics = intrinsicsFromFovX(0.9, view.size_px);
            view.world_from_camera.orientation = glm::angleAxis(0.05, glm::normalize(glm::dvec3(1, 2, 3)));
            PictureCopy copy(context());
            REQUIRE_FALSE(copy.ask());
            run([&](Commands& commands) { copy.record(commands, painted.picture, painted.eye, view); });
            for (const bool is_there : {false, false, true}) { CHECK(copy.ask() == is_there); }
            const std::function<Image()> take = copy.take();
            REQUIRE(take != nullptr);
            CHECK(compare(take(), showTurned(painted.image, painted.eye, view)).psnrDb() > 45.0);
            CHECK(copy.take() == nullptr);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a frame that was not drawn leaves no copy, nor does one that was dropped") {
    const Painted first(*this, {16, 16}, true), later(*this, {48, 37}, true);
    PictureCopy copy(context());
    CHECK(copy.take() == nullptr);
    CHECK_FALSE(copy.ask());
    CHECK(copy.ask());
    CHECK(copy.take() == nullptr);
    CHECK_FALSE(copy.ask());
    run([&](Commands& commands) { copy.record(commands, first.picture, first.eye, first.eye); });
    CHECK_FALSE(copy.ask());
    run([&](Commands& commands) { copy.record(commands, later.picture, later.eye, later.eye); });
    CHECK_FALSE(copy.ask());
    CHECK(copy.ask());
    CHECK(copy.take()().size_px == glm::uvec2(16, 16));
    // One that was dropped is not taken for the next one.
    CHECK_FALSE(copy.ask());
    run([&](Commands& commands) { copy.record(commands, first.picture, first.eye, first.eye); });
    copy.drop();
    run([&](Commands& commands) { copy.record(commands, later.picture, later.eye, later.eye); });
    CHECK_FALSE(copy.ask());
    // That frame is not drawn.
    CHECK(copy.ask());
    CHECK(copy.take() == nullptr);
}

}  // SUITE(picture_copy)
