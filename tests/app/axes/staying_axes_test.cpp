// Facts about pictures whose axes stay fixed while the head turns: what they cover, and when they move.
#include "app/axes/staying_axes.h"
#include "engine/picture/turned.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_cases.h"
#include "tests/engine/picture/pictures.h"

SUITE(staying_axes) {

constexpr double kMarginDegrees = 4.0;
const double kMargin = glm::radians(kMarginDegrees);

Eye eyeOf(glm::uvec2 size_px) { return {{}, intrinsicsFromAngles({-0.9, 0.7, 0.8, -0.6}, size_px), size_px}; }

Eye turned(Eye eye, double degrees, const glm::dvec3& axis) {
    glm::dquat& orientation = eye.world_from_camera.orientation;
    orientation = orientation * glm::angleAxis(glm::radians(degrees), glm::normalize(axis));
    return eye;
}

// The direction, in the world, of a place in an eye's picture.
glm::dvec3 rayAt(const Eye& eye, const glm::dvec2& place_px) {
    const Intrinsics& k = eye.intrinsics;
    return eye.world_from_camera.orientation *
           glm::dvec3((place_px.x - k.cx) / k.fx, (place_px.y - k.cy) / k.fy, 1.0);
}

// Where a place in the view is in the picture.
glm::dvec2 placeIn(const Eye& picture, const Eye& view, const glm::dvec2& place_px) {
    const Intrinsics& k = picture.intrinsics;
    const glm::dvec3 ray = glm::conjugate(picture.world_from_camera.orientation) * rayAt(view, place_px);
    return {k.fx * ray.x / ray.z + k.cx, k.fy * ray.y / ray.z + k.cy};
}

TEST_CASE("a picture covers turns within its margin with the view's own pixels, and no turn beyond") {
    const Eye view = eyeOf({400, 300}), picture = coverOf(view, kMargin);
    CHECK(picture.intrinsics.fx == view.intrinsics.fx);
    CHECK((picture.size_px - view.size_px) % 16u == glm::uvec2(0));
    for (const glm::dvec3 axis :
         {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, -1, 0)}) {
        CHECK(covers(picture, turned(view, 0.9 * kMarginDegrees, axis)));
        CHECK_FALSE(covers(picture, turned(view, 2.5 * kMarginDegrees, axis)));
    }
    CHECK(covers(picture, turned(view, 2.0, {0, 0, 1})));
    CHECK_FALSE(covers(picture, turned(view, 15.0, {0, 0, 1})));
}

TEST_CASE("all that a view shows lies in tiles that are not hidden, and most of the rest in hidden ones") {
    const Eye eye = eyeOf({200, 150}), picture = coverOf(eye, glm::radians(20.0));
    const glm::uvec2 tiles = tilesOf(picture.size_px), view_tiles = tilesOf(eye.size_px);
    // A lens that shows only the middle columns.
    std::vector<std::uint8_t> lens;
    for (std::uint32_t t = 0; t < view_tiles.x * view_tiles.y; ++t) {
        lens.push_back(t % view_tiles.x < 4 || t % view_tiles.x > 8);
    }
    for (const bool has_lens : {false, true}) {
        const Eye view = turned(eye, 9.0, {0.3, 1.0, 0.8});
        const auto hidden = hiddenFrom(view, picture, std::span(lens).first(has_lens ? lens.size() : 0));
        std::size_t lost = 0;
        for (std::uint32_t y = 0; y < eye.size_px.y; ++y) {
            for (std::uint32_t x = 0; x < eye.size_px.x; ++x) {
                if (has_lens && lens[std::size_t{y / 16} * view_tiles.x + x / 16] != 0) { continue; }
                const glm::uvec2 tile = glm::uvec2(placeIn(picture, view, glm::dvec2(x, y) + 0.5)) / 16u;
                lost += hidden[std::size_t{tile.y} * tiles.x + tile.x] != 0 ? 1 : 0;
            }
        }
        CHECK(lost == 0);
        const std::size_t shown = hidden.size() - countHidden(hidden);
        CHECK(shown < (has_lens ? 120 : 210));  // of 130, 50
        CHECK(hidden.size() > 2 * shown);
    }
}

TEST_CASE("axes stay until the view leaves the picture, then move ahead of a head that turns") {
    StayingAxes axes(kMargin);
    std::array<Eye, 2> views = stereoPair(eyeOf({200, 150}), 0.063);
    std::vector<std::size_t> moves;
    glm::dquat before{};
    for (std::size_t frame = 0; frame < 40; ++frame) {
        for (Eye& view : views) {
            view = turned(view, 0.5, {0, 1, 0});
            view.world_from_camera.position.x += 0.01;
        }
        const auto pictures = axes.follow(views);
        for (std::size_t e = 0; e < 2; ++e) {
            CHECK(covers(pictures[e], views[e]));
            CHECK(pictures[e].world_from_camera.position == views[e].world_from_camera.position);
            CHECK(pictures[e].world_from_camera.orientation == pictures[0].world_from_camera.orientation);
        }
        if (pictures[0].world_from_camera.orientation != before) { moves.push_back(frame); }
        before = pictures[0].world_from_camera.orientation;
    }
    REQUIRE(moves.size() >= 3);
    CHECK(moves.size() <= 4);
    // Nearly twice the margin, since they moved ahead of the head.
    CHECK(moves[2] - moves[1] > 1.5 * kMarginDegrees / 0.5);
    // Other angles get a picture of their own.
    for (Eye& view : views) { view.size_px.x += 16; }
    CHECK(axes.follow(views)[0].size_px.x != 0);
    CHECK(covers(axes.follow(views)[0], views[0]));
}

TEST_CASE("a compositor shows a picture as it is, and one that is turned to a filter's accuracy") {
    const Eye view = eyeOf({120, 90}), picture = coverOf(view, kMargin);
    const auto draw = [](const Eye& eye) {
        const auto wave = [&](double x, double y) {
            const glm::dvec3 ray = glm::normalize(rayAt(eye, {x + 0.5, y + 0.5}));
            return glm::vec3(glm::dvec3(0.5 + 0.3 * std::sin(20.0 * ray.x) * std::cos(15.0 * ray.y)));
        };
        return makePicture(eye.size_px, wave, 4);
    };
    CHECK(compare(showTurned(draw(picture), picture, view), draw(view)).psnrDb() > 90.0);
    const Eye other = turned(view, 3.0, {0.2, 1.0, 0.5});
    CHECK(compare(showTurned(draw(picture), picture, other), draw(other)).psnrDb() > 50.0);
    CHECK(compare(draw(view), draw(other)).psnrDb() < 25.0);
}

TEST_CASE_FIXTURE(Gpu, "while the head turns, what was seen before is the same bytes, the rest is rendered") {
    const ViewedScene view = viewAtelier({208, 176});
    KeptFrame frame(context(), view.scene), full(context(), view.scene);
    FrameSettings settings = makeSettings(Mode::kTemporal);
    settings.stereo.budget = 1.0;
    settings.stereo.error_bound_db = 20.0;
    StayingAxes axes(kMargin);
    std::array<Image, 2> before;
    std::array<std::vector<std::uint8_t>, 2> hidden_before;
    for (int step = 0; step < 4; ++step) {
        std::array<Eye, 2> views = stereoPair(view.eye, 0.063);
        for (Eye& eye : views) { eye = turned(eye, 0.8 * step, {0.1, 1.0, 0.0}); }  // about the eye itself
        const auto pictures = axes.follow(views);
        settings.hidden_tiles = axes.hiddenTiles();
        const FrameResult result = frame.render(pictures, settings);
        FrameSettings exact = settings;
        exact.mode = Mode::kShared;
        full.render(pictures, exact);
        CHECK(psnrDb(picturesOf(frame), picturesOf(full)) > 60.0);
        if (step > 0) { CHECK(10 * countOf(result, "tiles_patched") < 3 * 2 * 13 * 11); }
        for (std::size_t e = 0; e < 2; ++e) {
            const Image now = frame.readPicture(static_cast<int>(e));
            const auto kinds = frame.readTileKinds(static_cast<int>(e));
            std::size_t other = 0, kept = 0;
            for (std::size_t i = 0; step > 0 && i < now.pixelCount(); ++i) {
                const std::size_t tile = tileOf(i, now.size_px);
                if (kinds[tile] != 0 || hidden_before[e][tile] != 0) { continue; }
                ++kept;
                other += !std::equal(&now.values[4 * i], &now.values[4 * i] + 4, &before[e].values[4 * i]);
            }
            CHECK(other == 0);
            CHECK((step == 0 || kept > now.pixelCount() / 3));
            before[e] = now;
            hidden_before[e].assign(settings.hidden_tiles[e].begin(), settings.hidden_tiles[e].end());
        }
    }
}

}  // SUITE(staying_axes)
