// Facts about whole frames: settings that must not affect a picture do not change a byte of it; and limits,
// counters and memory.
#include "tests/engine/frame/affiliated_frames.h"
#include "tests/engine/frame/frame_runs.h"

SUITE(stereo_frame) {

bool allFinite(const Image& image) { return compare(image, image, image.channels).not_finite == 0; }

// When two pictures count as the same.
bool isAlike(const Image& a, const Image& b) {
    const Difference difference = compare(a, b, 4);
    return difference.psnrDb() >= 80.0 && difference.shareOff() <= 0.0002;
}

TEST_CASE_FIXTURE(Gpu, "sharing what eyes can share changes no byte") {
    ViewedScene atelier = viewAtelier();
    atelier.eye.world_from_camera.orientation =
        glm::normalize(atelier.eye.world_from_camera.orientation * glm::dquat(0.98, 0.03, -0.07, 0.11));
    for (const ViewedScene& view : {atelier, viewGaussians({96, 80}, false), viewGaussians({96, 80}, true)}) {
        CAPTURE(view.name);
        KeptFrame frame(context(), view.scene);
        for (const Side dominant : {kLeft, kRight}) {
            for (const double canting_rad : {0.0, glm::radians(10.0)}) {
                CAPTURE(canting_rad);
                const auto eyes = headsetEyes(view.eye, canting_rad);
                frame.render(eyes, makeSettings(Mode::kTwoPass, dominant));
                const PairOfValues apart = shownBy(frame);
                frame.render(eyes, makeSettings(Mode::kShared, dominant));
                CHECK(shownBy(frame) == apart);
                for (std::size_t e = 0; e < 2; ++e) {
                    frame.render({&eyes[e], 1}, makeSettings(Mode::kMono));
                    CHECK(frame.readPicture(0).values == apart[e]);
                }
                // Ordered by distance, both eyes have the same order.
                FrameSettings settings = makeSettings(Mode::kTwoPass, dominant);
                settings.order = Order::kDistance;
                frame.render(eyes, settings);
                const PairOfValues apart_by_distance = shownBy(frame);
                settings.mode = Mode::kShared;
                const FrameResult result = frame.render(eyes, settings);
                CHECK(shownBy(frame) == apart_by_distance);
                CHECK(std::ranges::count_if(result.gpu_ms, [](const auto& pass) {
                          return pass.label.pass == "sort_depth";
                      }) == 1);
                if (view.scene.isGaussian3d()) { continue; }
                for (std::size_t e = 0; e < 2; ++e) {
                    const auto twin = reference::render(view.scene, eyes[e], {.order_from = middleOf(eyes)});
                    CHECK(isAlike(frame.readPicture(static_cast<int>(e)), toImage(twin)));
                }
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "while an eye turns, what it sees along a ray stays by distance and pops by depth") {
    // Both discs cover the ray x = y = 0. Red is nearer by 1 %; when the eye turns towards it by more than
    // tan a = 0.02, its centre is the deeper one.
    const Scene scene = makeScene(
        {{.position = {0.5f, 0.0f, 2.0f}, .scale = glm::vec2(1.0f), .colour = {1.0f, 0.0f, 0.0f}},
         {.position = {-0.5f, 0.0f, 2.02f}, .scale = glm::vec2(1.0f), .colour = {0.0f, 1.0f, 0.0f}}});
    for (const Order order : {Order::kDepth, Order::kDistance}) {
        FrameSettings settings = makeSettings(Mode::kMono);
        settings.order = order;
        for (const int tenths : {-1, 0, 1}) {
            CAPTURE(tenths);
            // With a focal length of 100 px, so the ray passes through a pixel's centre again.
            const Eye eye = turned(makeEye({101, 101}), std::atan(0.1 * tenths));
            const Image picture = renderMono(context(), scene, eye, settings).picture;
            const float* pixel = &picture.values[4 * (50 * 101 + 50 - 10 * static_cast<std::size_t>(tenths))];
            const bool red_first = order == Order::kDistance || tenths <= 0;
            CHECK((pixel[0] > pixel[1]) == red_first);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a scene split over several allocations gives the same picture") {
    // 100,000 splats of 140 bytes; each upload takes 65,536.
    const ViewedScene view = viewBuiltin("builtin:atelier", {96, 96}, 100000);
    const Context split({.device = {}, .validation = kValidation, .max_allocation_bytes = 10'000'000});
    CHECK(GpuScene(context(), view.scene).chunkCount() == 1);
    CHECK(GpuScene(split, view.scene).chunkCount() > 1);
    const auto one = renderMono(context(), view.scene, view.eye, makeSettings(Mode::kMono));
    const auto many = renderMono(split, view.scene, view.eye, makeSettings(Mode::kMono));
    CHECK(many.picture.values == one.picture.values);
    CHECK(many.depth.values == one.depth.values);
    CHECK(split.validationMessages().empty());
}

TEST_CASE_FIXTURE(Gpu, "the number of threads of a cell does not show") {
    const std::array views{viewAtelier(), viewCloud({100, 75})};
    const std::array<GpuScene, 2> scenes{GpuScene(context(), views[0].scene),
                                         GpuScene(context(), views[1].scene)};
    std::array<Image, 2> first;
    for (const std::uint32_t threads : {8u, 16u, 32u, 64u}) {
        CAPTURE(threads);
        StereoFrame frame(context(), scenes[0], {.threads_per_cell = threads});
        for (std::size_t v = 0; v < views.size(); ++v) {
            frame.show(scenes[v]);
            frame.render({&views[v].eye, 1}, makeSettings(Mode::kMono));
            const Image picture = frame.readPicture(0);
            if (threads == 8) { first[v] = picture; }
            CHECK(compare(picture, first[v], 4).psnrDb() >= 150.0);  // measured: 169.7
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "where no splat is seen there is the background, without depth") {
    FrameSettings settings = makeSettings(Mode::kMono);
    settings.background = {0.25, 0.5, 0.75};
    Scene empty;
    Scene transparent = makeBuiltin("builtin:fence");
    std::fill(transparent.opacities.begin(), transparent.opacities.end(), 0.0039f);  // below 1/255
    Scene behind = makeBuiltin("builtin:one-splat");
    behind.positions[0].z = -2.0f;
    for (const Scene* scene : {&empty, &transparent, &behind}) {
        const Eye eye = eyeOf(*builtinView("fence"), {40, 24});
        const auto frame = renderMono(context(), *scene, eye, settings);
        for (std::size_t i = 0; i < frame.picture.pixelCount(); ++i) {
            REQUIRE(std::equal(&frame.picture.values[4 * i], &frame.picture.values[4 * i] + 4,
                               std::array{0.25f, 0.5f, 0.75f, 0.0f}.begin()));
            REQUIRE(frame.depth.values[i] == 0.0f);
        }
        CHECK(frame.result.counters.named().at("tile_pairs") == 0);
    }
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared}) {
        const auto pair = renderPair(
            context(), empty, stereoPair(eyeOf(*builtinView("fence"), {40, 24}), 0.063), makeSettings(mode));
        const auto [least, most] = std::ranges::minmax(pair.pictures[kRight].values);
        CHECK(these(least, most) == these(0.0f, 0.0f));
    }
}

TEST_CASE_FIXTURE(Gpu, "images of odd sizes are as the twin renders them, and eyes may differ in size") {
    const ViewedScene view = viewAtelier();
    KeptFrame frame(context(), view.scene);
    for (const glm::uvec2 size_px :
         {glm::uvec2(1, 1), glm::uvec2(17, 33), glm::uvec2(3, 200), glm::uvec2(31, 16)}) {
        CAPTURE(size_px.x);
        const Eye eye = viewAtelier(size_px).eye;
        frame.render({&eye, 1}, makeSettings(Mode::kMono));
        CHECK(allFinite(frame.readDominantDepth()));
        CHECK(compare(frame.readPicture(0), toImage(reference::render(view.scene, eye, {})), 4).psnrDb() >=
              80.0);
    }
    std::array<Eye, 2> eyes = stereoPair(view.eye, 0.063);
    eyes[kRight].size_px = {100, 180};
    frame.render(eyes, makeSettings(Mode::kTwoPass));
    const PairOfValues both = shownBy(frame);
    for (std::size_t e = 0; e < 2; ++e) {
        frame.render({&eyes[e], 1}, makeSettings(Mode::kMono));
        CHECK(frame.readPicture(0).values == both[e]);
    }
}

TEST_CASE_FIXTURE(Gpu, "walls beside the eye are finite along their horizon, where depth has no bound") {
    // Discs with t_u = y, t_v = z, t_w = x, whose centres lie beside and behind the eye: in the middle
    // column, 1/z is exactly 0.
    std::vector<Splat> splats;
    for (int i = 0; i < 20; ++i) {
        Splat splat;
        splat.position = {i % 2 == 0 ? 1.0f : -1.0f, 0.3f * static_cast<float>(i % 5) - 0.6f,
                          -0.5f * static_cast<float>(i / 5)};
        splat.rotation = glm::quat(0.5f, 0.5f, 0.5f, 0.5f);
        splat.scale = glm::vec2(0.5f * static_cast<float>(1 + i));
        splats.push_back(splat);
    }
    const ViewedScene view{"walls", makeScene(splats), makeEye({65, 65})};
    const auto frame = renderMono(context(), view.scene, view.eye, makeSettings(Mode::kMono));
    CHECK(allFinite(frame.depth));
    CHECK(isAlike(frame.picture, toImage(reference::render(view.scene, view.eye, {}))));
    CHECK(frame.result.counters.named().at("tile_pairs") > 0);
}

TEST_CASE_FIXTURE(Gpu, "eyes that change their roles take over what the other was made with") {
    const ViewedScene view = viewAtelier();
    KeptFrame frame(context(), view.scene);
    const auto eyes = headsetEyes(view.eye, 0.0);
    frame.render(eyes, makeSettings(Mode::kPredicted, kLeft));
    const std::uint64_t kinds = frame.warpBuffers().tileKinds().value;
    for (const Side dominant : {kRight, kLeft}) {
        frame.render(eyes, makeSettings(Mode::kPredicted, dominant));
        CHECK(frame.warpBuffers().tileKinds().value == kinds);
        CHECK(frame.readTileKinds().size() == frame.warpBuffers().tileCount());
    }
    frame.render(eyes, makeSettings(Mode::kShared));
    CHECK(frame.warpBuffers().bytes() == 0);
    CHECK(frame.readTileKinds().empty());
}

TEST_CASE_FIXTURE(Gpu, "both eyes are rendered at once where a pair fits into a word, in few commands") {
    for (const glm::uvec2 size_px : {glm::uvec2(64, 48), glm::uvec2(256, 256), glm::uvec2(1024, 1024)}) {
        CAPTURE(size_px.x);
        const ViewedScene view = viewBuiltin("builtin:fence", size_px);
        KeptFrame frame(context(), view.scene, {.first_capacity = {1, 1}, .threads_per_cell = 0});
        const auto eyes = headsetEyes(view.eye, 0.0);
        const FrameResult result = frame.render(eyes, makeSettings(Mode::kShared));
        CHECK(countOf(result, "commands") == 18);
        const std::uint64_t pairs = countOf(result, "tile_pairs_left") + countOf(result, "tile_pairs_right");
        CHECK(pairs > 0);
        if (size_px.x < 256) { continue; }  // lists are longer than such pictures
        CHECK(countOf(result, "visible_bytes") <= 92 * (countOf(result, "splats_visible_left") + 1024));
        CHECK(countOf(result, "pair_bytes") <= 4 * pairs + 16 * 1024);
        // Another mode in between has lists and pictures of its own.
        const PairOfValues shown = shownBy(frame);
        frame.render(eyes, makeSettings(Mode::kTwoPass));
        CHECK(shownBy(frame) == shown);
        frame.render(eyes, makeSettings(Mode::kShared, kRight));
        CHECK(shownBy(frame) == shown);
    }
}

TEST_CASE_FIXTURE(Gpu, "memory keeps to its bounds a splat, a visible splat, a pair and a pixel") {
    CHECK(deviceBytesPerSplat(0, false) <= 64);
    CHECK(deviceBytesPerSplat(3, false) <= 160);
    const FrameCapacity capacity{1024, 1024};  // so both lists grow to what is needed
    for (const auto& [view, most_bytes] : {std::pair(viewAtelier({256, 256}), 160.0),
                                           std::pair(viewBuiltin("builtin:fence", {256, 256}), 64.0)}) {
        CAPTURE(view.name);
        const auto counters = renderMono(context(), view.scene, view.eye, makeSettings(Mode::kMono),
                                         {.first_capacity = capacity, .threads_per_cell = 0})
                                  .result.counters.named();
        CHECK(counters.at("splats_read") == view.scene.size());
        CHECK(static_cast<double>(counters.at("scene_bytes")) <=
              most_bytes * static_cast<double>(view.scene.size()));
        // Lists grow in steps of 1024.
        CHECK(counters.at("visible_bytes") <= 64 * (counters.at("splats_visible") + 1024));
        // Three words of a pair are stored in the picture.
        CHECK(counters.at("pair_bytes") <= 4 * counters.at("tile_pairs") + 16 * 1024);
        // The sort's histograms, half a byte per pair, fit into what a visible splat leaves free of its 64
        // bytes.
        CHECK(counters.at("visible_bytes") + counters.at("pair_bytes") + counters.at("scratch_bytes") <=
              64 * counters.at("splats_visible") + 4 * counters.at("tile_pairs") + 64 * 1024 + 16 * 1024);
        CHECK(counters.at("pixel_bytes") <= 32 * counters.at("pixels"));
    }
    CHECK(viewAtelier().scene.sh_degree == 3);
}

}  // SUITE(stereo_frame)
