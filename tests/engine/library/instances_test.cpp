// Facts about several scenes in a frame, each at its own place, and about streamed and moving scenes, through
// the library.
#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "engine/scene/pick_splats.h"
#include "engine/scene/sh_turn.h"
#include "engine/similarity.h"
#include "tests/engine/library/library_runs.h"

#ifdef BINOSPLAT_HAS_SPLIT_SCENE
#include "tests/engine/stream/split_scene.h"
#endif

SUITE(instances) {

struct Drawn : Opened {
    Drawn() { unwanted = "Vulkan validation"; }
    using Opened::load;
    [[nodiscard]] bsp::Scene load(const Scene& scene) const {
        static int number = 0;
        const fs::path file = path / fmt::format("scene{}.ply", ++number);
        writePly(scene, file.string());
        return load(file.string());
    }
};

bsp_instance instanceOf(const bsp::Scene& scene, const Similarity& at = {}) {
    auto instance = bsp::make<bsp_instance>(BSP_TYPE_INSTANCE);
    instance.scene = scene.get();
    const glm::dquat& turn = at.orientation;
    std::ranges::copy(std::array{turn.w, turn.x, turn.y, turn.z}, instance.orientation);
    for (int i = 0; i < 3; ++i) { instance.position[i] = at.position[i]; }
    instance.scale = at.scale;
    return instance;
}

// Both eyes' pictures of one scene, or of instances.
std::vector<float> draw(bsp::Renderer& renderer, bsp_frame_info frame, const bsp::Views& views,
                        const std::vector<bsp_instance>& instances) {
    frame.views = views.data();
    frame.view_count = 2;
    frame.instances = instances.data();
    frame.instance_count = static_cast<std::uint32_t>(instances.size());
    renderer.render(frame);
    std::vector<float> values;
    for (unsigned v = 0; v < 2; ++v) {
        const bsp::Picture picture = renderer.colour(views[v], v);
        values.insert(values.end(), picture.values.begin(), picture.values.end());
    }
    return values;
}

bsp_frame_info frameOf(bsp_mode mode, bsp_scene scene = nullptr) {
    bsp_frame_info frame = bsp::frame();
    frame.mode = mode;
    frame.scene = scene;
    return frame;
}

double rootMeanSquare(const std::vector<float>& a, const std::vector<float>& b) {
    REQUIRE(a.size() == b.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) { sum += (double{a[i]} - b[i]) * (double{a[i]} - b[i]); }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

// The twin of a placement: each splat is turned, moved and scaled in float64, and its harmonics turn with it.
Scene placeByHand(Scene scene, const Similarity& at) {
    const ShTurn turn(glm::mat3_cast(at.orientation));
    const auto coefficients = static_cast<std::size_t>(shCoefficientCount(scene.sh_degree));
    for (std::size_t i = 0; i < scene.size(); ++i) {
        scene.positions[i] = transform(at, glm::dvec3(scene.positions[i]));
        scene.rotations[i] = glm::quat(at.orientation * glm::dquat(scene.rotations[i]));
        scene.scales[i] *= static_cast<float>(at.scale);
        if (scene.isGaussian3d()) { scene.thicknesses[i] *= static_cast<float>(at.scale); }
        for (std::size_t channel = 0; channel < 3; ++channel) {
            std::array<float, 15> rest{};
            float* sh = &scene.sh[3 * coefficients * i];
            for (std::size_t k = 1; k < coefficients; ++k) { rest.at(k - 1) = sh[3 * k + channel]; }
            turn.apply(rest.data(), scene.sh_degree);
            for (std::size_t k = 1; k < coefficients; ++k) { sh[3 * k + channel] = rest.at(k - 1); }
        }
    }
    return scene;
}

// Some splats with harmonics of every band.
Scene colourful(std::size_t splats, std::uint32_t seed, int sh_degree, bool gaussians) {
    Scene scene;
    scene.name = "colourful";
    scene.sh_degree = sh_degree;
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> spread(-1.0f, 1.0f);
    for (std::size_t i = 0; i < splats; ++i) {
        scene.positions.emplace_back(spread(random), spread(random), spread(random));
        scene.rotations.push_back(
            glm::normalize(glm::quat(spread(random), spread(random), spread(random), spread(random))));
        scene.scales.emplace_back(0.05f + 0.04f * spread(random), 0.05f + 0.04f * spread(random));
        if (gaussians) { scene.thicknesses.push_back(0.009f + 0.001f * spread(random)); }
        scene.opacities.push_back(0.5f + 0.4f * spread(random));
        for (int k = 0; k < 3 * shCoefficientCount(sh_degree); ++k) {
            scene.sh.push_back(0.3f * spread(random));
        }
    }
    return scene;
}

const double kEye[]{0.3, -0.4, -4.0}, kLook[]{0.0, 0.0, 0.0}, kUp[]{0.0, -1.0, 0.0};
bsp::Views viewsAt(double aside = 0.0) {
    const double eye[]{kEye[0] + aside, kEye[1], kEye[2]};
    return bsp::lookAt(eye, kLook, kUp, 0.063, 1.0, 112, 80);
}

TEST_CASE_FIXTURE(
    Drawn, "an instance that is placed where its file has it is the scene to the last bit, in every mode") {
    const bsp::Scene room = load(makeBuiltin("builtin:atelier", 3000));
    const bsp::Views views = room.startViews(0.063, 1.2, 96, 64);
    for (const bsp_mode mode : {BSP_MODE_TWO_PASS, BSP_MODE_SHARED, BSP_MODE_PAPER, BSP_MODE_PREDICTED}) {
        const std::vector<float> alone = draw(*renderer, frameOf(mode, room.get()), views, {});
        CHECK(draw(*renderer, frameOf(mode), views, {instanceOf(room)}) == alone);
    }
}

TEST_CASE_FIXTURE(
    Drawn,
    "instances of discs and of Gaussians are what their splats turned, moved and scaled by hand make") {
    const Similarity left{glm::normalize(glm::dquat(0.8, 0.3, -0.4, 0.2)), {-1.1, 0.2, 0.3}, 0.7},
        right{{1, 0, 0, 0}, {1.0, -0.1, 0.5}, 1.0},
        far{glm::normalize(glm::dquat(0.1, -0.5, 0.6, 0.9)), {0.2, 0.3, 3.0}, 2.0};
    for (const bool gaussians : {false, true}) {
        const Scene three_bands = colourful(900, 1, 3, gaussians), one_band = colourful(700, 2, 1, gaussians);
        Scene by_hand = placeByHand(three_bands, left);
        appendSplats(by_hand, placeByHand(one_band, right));
        appendSplats(by_hand, placeByHand(three_bands, far));
        const bsp::Scene first = load(three_bands), other = load(one_band), all = load(by_hand);
        const std::vector<bsp_instance> instances{instanceOf(first, left), instanceOf(other, right),
                                                  instanceOf(first, far)};
        for (const bsp_mode mode : {BSP_MODE_SHARED, BSP_MODE_PREDICTED}) {
            const std::vector<float> expected = draw(*renderer, frameOf(mode, all.get()), viewsAt(), {}),
                                     seen = draw(*renderer, frameOf(mode), viewsAt(), instances);
            // Splats at the same distance may change places by rounding.
            CHECK(rootMeanSquare(expected, seen) < (mode == BSP_MODE_SHARED ? 2e-4 : 4e-3));
            CHECK(rootMeanSquare(expected, std::vector<float>(expected.size())) > 0.1);
        }
    }
}

TEST_CASE_FIXTURE(Drawn,
                  "a hidden instance is not there, one that moves leaves nothing behind in temporal, and "
                  "another's coming is a cut") {
    const bsp::Scene one = load(colourful(800, 3, 2, false)), other = load(colourful(500, 4, 0, false));
    std::vector<bsp_instance> both{instanceOf(one, {{1, 0, 0, 0}, {-0.9, 0, 0}, 0.8}),
                                   instanceOf(other, {{1, 0, 0, 0}, {1, 0, 0}, 0.6})};
    const std::vector<bsp_instance> first{both[0]};
    both[1].hidden = 1;
    CHECK(draw(*renderer, frameOf(BSP_MODE_SHARED), viewsAt(), both) ==
          draw(*renderer, frameOf(BSP_MODE_SHARED), viewsAt(), first));
    both[1].hidden = 0;
    bsp::Renderer exact(*device);
    double worst = 0.0, without = 0.0;
    for (int i = 0; i < 24; ++i) {
        both[1].position[1] = 0.04 * i;
        both[0].hidden = i / 8 == 1 ? 1 : 0;
        const bsp::Views views = viewsAt(0.004 * i);
        const std::vector<float> seen = draw(*renderer, frameOf(BSP_MODE_TEMPORAL), views, both),
                                 full = draw(exact, frameOf(BSP_MODE_SHARED), views, both);
        worst = std::max(worst, rootMeanSquare(seen, full));
        without = std::max(without, rootMeanSquare(full, std::vector<float>(full.size())));
    }
    CHECK(worst < 0.03);  // 30 dB
    CHECK(without > 0.1);
    both.push_back(instanceOf(other, {{1, 0, 0, 0}, {0, 0, 2}, 1.0}));
    CHECK(draw(*renderer, frameOf(BSP_MODE_TEMPORAL), viewsAt(), both) ==
          draw(exact, frameOf(BSP_MODE_SHARED), viewsAt(), both));
}

TEST_CASE_FIXTURE(
    Drawn, "scenes that cannot be drawn together, and placements that make no sense, are refused in a line") {
    const bsp::Scene discs = load(colourful(10, 5, 0, false)), gaussians = load(colourful(10, 6, 0, true));
    const auto refused = [&](bsp_frame_info frame, const std::vector<bsp_instance>& instances,
                             const std::string& part) {
        checkRefusal([&] { (void)draw(*renderer, frame, viewsAt(), instances); }, BSP_ERROR_INPUT, part);
    };
    const bsp_frame_info frame = frameOf(BSP_MODE_SHARED);
    refused(frame, {instanceOf(discs), instanceOf(gaussians)}, "all discs, all Gaussians");
    refused(frameOf(BSP_MODE_SHARED, discs.get()), {instanceOf(discs)}, "a scene and 1 instances");
    refused(frame, {instanceOf(discs, {{1, 0, 0, 0}, {}, -1.0})}, "scale of an instance is -1");
    bsp_instance empty = instanceOf(discs);
    empty.scene = nullptr;
    refused(frame, {empty}, "scene of an instance is null");
    bsp_frame_info bad = frame;
    bad.foveation_rad = -1.0;
    refused(bad, {instanceOf(discs)}, "foveation_rad is -1");
    bad = frame;
    bad.error_bound_db = 61.0;
    refused(bad, {instanceOf(discs)}, "error_bound_db is 61");
    // What was drawn before still draws.
    CHECK(rootMeanSquare(draw(*renderer, frame, viewsAt(), {instanceOf(discs)}),
                         draw(*renderer, frameOf(BSP_MODE_SHARED, discs.get()), viewsAt(), {})) == 0.0);
}

TEST_CASE_FIXTURE(Drawn, "a frame with foveation is exact where the eye looks, and blends fewer pairs") {
    const bsp::Scene room = load(makeBuiltin("builtin:atelier", 20000));
    const bsp::Views views = room.startViews(0.063, 1.6, 256, 256);
    bsp_frame_info frame = frameOf(BSP_MODE_TEMPORAL, room.get());
    frame.flags = BSP_FRAME_CUT;
    const std::vector<float> full = draw(*renderer, frame, views, {});
    frame.foveation_rad = 0.12;
    const std::vector<float> seen = draw(*renderer, frame, views, {});
    double middle = 0.0, all = 0.0;
    for (std::size_t i = 0; i < 256 * 256; ++i) {
        const double x = static_cast<double>(i % 256) - 127.5, y = static_cast<double>(i / 256) - 127.5;
        const double off = std::abs(full[4 * i] - seen[4 * i]);
        all += off;
        if (std::hypot(x, y) < 10.0) { middle += off; }
    }
    CHECK(middle == 0.0);
    CHECK(all > 0.0);
}

TEST_CASE_FIXTURE(Drawn, "an error bound leaves tiles that are good enough, and a higher one leaves fewer") {
    const bsp::Scene room = load(makeBuiltin("builtin:atelier", 20000));
    bsp_frame_info frame = frameOf(BSP_MODE_TEMPORAL, room.get());
    frame.budget = 1.0;
    std::vector<double> work;
    for (const double bound : {15.0, 40.0, 0.0}) {
        frame.error_bound_db = bound;
        bsp::Renderer fresh(*device);
        work.push_back(0.0);
        for (int i = 0; i < 4; ++i) {
            const bsp_scene_properties start = room.properties();
            const double eye[]{start.eye[0] + 0.004 * i, start.eye[1], start.eye[2]};
            const bsp::Views views = bsp::lookAt(eye, start.look, start.up, 0.063, 1.6, 256, 256);
            frame.views = views.data();
            frame.view_count = 2;
            const double done = fresh.render(frame).work_rendered;
            if (i > 0) { work.back() += done; }
        }
    }
    CHECK(work[0] < 0.7 * work[1]);
    CHECK(work[1] < 0.9 * work[2]);
}

TEST_CASE_FIXTURE(Drawn, "a scene that moves shows the file of its time, alone and as an instance") {
    fs::create_directory(path / "film");
    std::vector<Scene> files;
    for (int i = 0; i < 3; ++i) {
        files.push_back(colourful(600, 10 + static_cast<std::uint32_t>(i), 1, false));
        writePly(files.back(), (path / "film" / fmt::format("{:03}.ply", i)).string());
    }
    const bsp::Scene film = load((path / "film").string(), 1);
    CHECK(film.properties().splats == 600);
    for (const int i : {0, 2, 1}) {
        const bsp::Scene still = load(files[static_cast<std::size_t>(i)]);
        const std::vector<float> expected =
            draw(*renderer, frameOf(BSP_MODE_SHARED, still.get()), viewsAt(), {});
        bsp_frame_info frame = frameOf(BSP_MODE_SHARED, film.get());
        frame.flags = BSP_FRAME_SETTLED;
        frame.time_s = 0.1 * i + 0.05;
        CHECK(draw(*renderer, frame, viewsAt(), {}) == expected);
        frame.scene = nullptr;
        const Similarity back{{0, 0, 1, 0}, {0, 0, 1}, 1.5};
        const std::vector<float> placed = draw(*renderer, frame, viewsAt(), {instanceOf(film, back)});
        CHECK(placed == draw(*renderer, frameOf(BSP_MODE_SHARED), viewsAt(), {instanceOf(still, back)}));
    }
}

#ifdef BINOSPLAT_HAS_SPLIT_SCENE
TEST_CASE_FIXTURE(
    Drawn,
    "a streamed scene brings what the views ask for, frame by frame, and settled it is the whole of it") {
    const Scene room = makeBuiltin("builtin:atelier", 20000);
    test::splitScene(room, (path / "streamed").string(),
                     {.leaf_splats = 2048, .levels = 3, .chunk_splats = 8192});
    const bsp::Scene stream = load((path / "streamed").string(), 1),
                     whole = load((path / "streamed").string());
    const bsp::Views views = whole.startViews(0.063, 1.2, 96, 64);
    bsp_frame_info frame = frameOf(BSP_MODE_SHARED, stream.get());
    const std::vector<float> full = draw(*renderer, frameOf(BSP_MODE_SHARED, whole.get()), views, {});
    const double at_first = rootMeanSquare(draw(*renderer, frame, views, {}), full);
    frame.views = views.data();
    frame.view_count = 2;
    frame.flags = BSP_FRAME_SETTLED;
    CHECK(renderer->render(frame).share_there == 1.0);
    const double settled = rootMeanSquare(draw(*renderer, frame, views, {}), full);
    frame.scene = nullptr;
    const double placed = rootMeanSquare(draw(*renderer, frame, views, {instanceOf(stream)}), full);
    CHECK(at_first > 2.0 * settled);
    CHECK(settled < 0.02);
    CHECK(placed < 0.02);
    CHECK(stream.properties().splats < whole.properties().splats);
}
#endif

}  // SUITE(instances)
