// Facts about whole frames: what must not affect a picture changes no byte of it; limits, counters, memory.
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
                FrameSettings settings = makeSettings(Mode::kTwoPass, dominant);
                const PairOfValues apart = renderPair(frame, eyes, settings);
                CHECK(renderPair(frame, eyes, makeSettings(Mode::kShared, dominant)) == apart);
                for (std::size_t e = 0; e < 2; ++e) { CHECK(renderEye(frame, eyes[e]).values == apart[e]); }
                // Ordered by distance, both eyes have the same order.
                settings.order = Order::kDistance;
                const PairOfValues apart_by_distance = renderPair(frame, eyes, settings);
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
    const Scene scene =
        makeScene({{.position = {0.5f, 0.0f, 2.0f}, .scale = glm::vec2(1), .colour = {1, 0, 0}},
                   {.position = {-0.5f, 0.0f, 2.02f}, .scale = glm::vec2(1), .colour = {0, 1, 0}}});
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
    const GpuScene one(context(), view.scene), many(split, view.scene);
    CHECK(one.chunkCount() == 1);
    CHECK(many.chunkCount() > 1);
    KeptFrame frame(context(), one), of_many(split, many);
    CHECK(renderEye(of_many, view.eye).values == renderEye(frame, view.eye).values);
    CHECK(of_many.readDominantDepth().values == frame.readDominantDepth().values);
    CHECK(split.validationMessages().empty());
}

TEST_CASE_FIXTURE(Gpu, "the number of threads of a cell does not show") {
    for (const ViewedScene& view : {viewAtelier(), viewCloud({100, 75})}) {
        KeptFrame narrow(context(), view.scene, {.threads_per_cell = 8});
        const Image first = renderEye(narrow, view.eye);
        for (const std::uint32_t threads : {16u, 32u, 64u}) {
            INFO(view.name, ", threads ", threads);
            KeptFrame frame(context(), view.scene, {.threads_per_cell = threads});
            CHECK(compare(renderEye(frame, view.eye), first, 4).psnrDb() >= 150.0);  // measured: 169.7
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "where no splat is seen there is the background, without depth") {
    FrameSettings settings = makeSettings(Mode::kMono);
    settings.background = {0.25, 0.5, 0.75};
    const Eye eye = eyeOf(*builtinView("fence"), {40, 24});
    const Image background = toImage(eye.size_px, std::vector<glm::dvec4>(40 * 24, {0.25, 0.5, 0.75, 0.0}));
    Scene transparent = makeBuiltin("builtin:fence");
    std::ranges::fill(transparent.opacities, 0.0039f);  // below 1/255
    Scene behind = makeBuiltin("builtin:one-splat");
    behind.positions[0].z = -2.0f;
    for (const Scene& scene : {Scene(), transparent, behind}) {
        const auto frame = renderMono(context(), scene, eye, settings);
        CHECK(frame.picture.values == background.values);
        CHECK(frame.depth.values == std::vector<float>(40 * 24));
        CHECK(countOf(frame.result, "tile_pairs") == 0);
    }
    KeptFrame empty(context(), Scene());
    for (const Mode mode : {Mode::kTwoPass, Mode::kShared}) {
        CHECK(renderPair(empty, stereoPair(eye, 0.063), makeSettings(mode))[kRight] ==
              std::vector<float>(4 * 40 * 24));
    }
}

TEST_CASE_FIXTURE(Gpu, "images of odd sizes are as the twin renders them, and eyes may differ in size") {
    const ViewedScene view = viewAtelier();
    KeptFrame frame(context(), view.scene);
    for (const glm::uvec2 size_px :
         {glm::uvec2(1, 1), glm::uvec2(17, 33), glm::uvec2(3, 200), glm::uvec2(31, 16)}) {
        CAPTURE(size_px.x);
        const Eye eye = viewAtelier(size_px).eye;
        const Image twin = toImage(reference::render(view.scene, eye, {}));
        CHECK(compare(renderEye(frame, eye), twin, 4).psnrDb() >= 80.0);
        CHECK(allFinite(frame.readDominantDepth()));
    }
    std::array<Eye, 2> eyes = stereoPair(view.eye, 0.063);
    eyes[kRight].size_px = {100, 180};
    const PairOfValues both = renderPair(frame, eyes, makeSettings(Mode::kTwoPass));
    for (std::size_t e = 0; e < 2; ++e) { CHECK(renderEye(frame, eyes[e]).values == both[e]); }
}

TEST_CASE_FIXTURE(Gpu, "walls beside the eye are finite along their horizon, where depth has no bound") {
    // Discs with t_u = y, t_v = z, t_w = x, whose centres lie beside and behind the eye: in the middle
    // column, 1/z is exactly 0.
    std::vector<Splat> splats;
    for (int i = 0; i < 20; ++i) {
        splats.push_back({.position = glm::vec3(i % 2 == 0 ? 1.0 : -1.0, 0.3 * (i % 5) - 0.6, i / 5 / -2.0),
                          .rotation = glm::quat(0.5f, 0.5f, 0.5f, 0.5f),
                          .scale = glm::vec2(0.5f * static_cast<float>(1 + i))});
    }
    const Scene scene = makeScene(splats);
    const Eye eye = makeEye({65, 65});
    const auto frame = renderMono(context(), scene, eye);
    CHECK(allFinite(frame.depth));
    CHECK(isAlike(frame.picture, toImage(reference::render(scene, eye, {}))));
    CHECK(countOf(frame.result, "tile_pairs") > 0);
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
        CHECK(renderPair(frame, eyes, makeSettings(Mode::kTwoPass)) == shown);
        CHECK(renderPair(frame, eyes, makeSettings(Mode::kShared, kRight)) == shown);
    }
}

TEST_CASE_FIXTURE(Gpu, "memory keeps to its bounds a splat, a visible splat, a pair and a pixel") {
    CHECK(deviceBytesPerSplat(0, false) <= 64);
    CHECK(deviceBytesPerSplat(3, false) <= 160);
    CHECK(viewAtelier().scene.sh_degree == 3);
    // So that both lists grow to what is needed, in steps of 1024.
    const FrameOptions options{.first_capacity = {1024, 1024}};
    for (const auto& [view, most_bytes] :
         {std::pair(viewAtelier({256, 256}), 160), std::pair(viewBuiltin("builtin:fence", {256, 256}), 64)}) {
        CAPTURE(view.name);
        KeptFrame frame(context(), view.scene, options);
        auto counters = frame.render({&view.eye, 1}, makeSettings(Mode::kMono)).counters.named();
        CHECK(counters["splats_read"] == view.scene.size());
        CHECK(counters["scene_bytes"] <= most_bytes * view.scene.size());
        const std::uint64_t for_visible = 64 * (counters["splats_visible"] + 1024),
                            for_pairs = 4 * counters["tile_pairs"] + 16 * 1024;
        CHECK(counters["visible_bytes"] <= for_visible);
        CHECK(counters["pair_bytes"] <= for_pairs);  // three words of a pair are stored in the picture
        // The sort's histograms, half a byte per pair, fit into what a visible splat leaves free.
        CHECK(counters["visible_bytes"] + counters["pair_bytes"] + counters["scratch_bytes"] <=
              for_visible + for_pairs);
        CHECK(counters["pixel_bytes"] <= 32 * counters["pixels"]);
    }
}

}  // SUITE(stereo_frame)
