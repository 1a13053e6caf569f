// Facts about several scenes in a frame, each at its own place, and about streamed and moving scenes.
#include "engine/scene/pick_splats.h"
#include "engine/scene/sh_turn.h"
#include "engine/similarity.h"
#include "tests/engine/library/library_runs.h"
#include "tests/engine/stream/moving_frames.h"

#ifdef BINOSPLAT_HAS_SPLIT_SCENE
#include "tests/engine/stream/split_scene.h"
#endif

SUITE(instances) {

bsp_instance instanceOf(const bsp::Scene& scene, const Similarity& at = {}) {
    auto instance = bsp::make<bsp_instance>(BSP_TYPE_INSTANCE);
    instance.scene = scene.get();
    const glm::dquat& turn = at.orientation;
    std::ranges::copy(std::array{turn.w, turn.x, turn.y, turn.z}, instance.orientation);
    for (int i = 0; i < 3; ++i) { instance.position[i] = at.position[i]; }
    instance.scale = at.scale;
    return instance;
}

bsp_frame_info frameOf(bsp_mode mode) {
    bsp_frame_info frame = bsp::frame();
    frame.mode = mode;
    return frame;
}
bsp_frame_info frameOf(bsp_mode mode, const bsp::Scene& scene) {
    bsp_frame_info frame = frameOf(mode);
    frame.scene = scene.get();
    return frame;
}

const double kEye[]{0.3, -0.4, -4.0}, kLook[]{0.0, 0.0, 0.0}, kUp[]{0.0, -1.0, 0.0};
bsp::Views viewsAt(double aside = 0.0) {
    const double eye[]{kEye[0] + aside, kEye[1], kEye[2]};
    return bsp::lookAt(eye, kLook, kUp, 0.063, 1.0, 112, 80);
}

using Instances = std::vector<bsp_instance>;

struct Drawn : Opened {
    Drawn() { unwanted = "Vulkan validation"; }
    // Both eyes' pictures of one scene, or of instances.
    std::vector<float> draw(bsp_frame_info frame, const Instances& instances = {},
                            const bsp::Views& views = viewsAt(), bsp::Renderer* other = nullptr) {
        bsp::Renderer& drawn_by = other != nullptr ? *other : *renderer;
        frame.views = views.data();
        frame.view_count = 2;
        frame.instances = instances.data();
        frame.instance_count = static_cast<std::uint32_t>(instances.size());
        drawn_by.render(frame);
        std::vector<float> values = drawn_by.colour(views[0], 0).values;
        const std::vector<float> right = drawn_by.colour(views[1], 1).values;
        values.insert(values.end(), right.begin(), right.end());
        return values;
    }
};

// Of nothing, if the other is empty.
double rootMeanSquare(const std::vector<float>& a, const std::vector<float>& b = {}) {
    REQUIRE((b.empty() || a.size() == b.size()));
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) { sum += std::pow(double{a[i]} - (b.empty() ? 0 : b[i]), 2); }
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

TEST_CASE_FIXTURE(Drawn, "an instance where its file has it is the scene to the last bit, in every mode") {
    const bsp::Scene room = load(makeBuiltin("builtin:atelier", 3000));
    const bsp::Views views = room.startViews(0.063, 1.2, 96, 64);
    for (const bsp_mode mode : {BSP_MODE_TWO_PASS, BSP_MODE_SHARED, BSP_MODE_PAPER, BSP_MODE_PREDICTED}) {
        CHECK(draw(frameOf(mode), {instanceOf(room)}, views) == draw(frameOf(mode, room), {}, views));
    }
}

TEST_CASE_FIXTURE(Drawn, "instances are what their splats turned, moved and scaled by hand make") {
    const Similarity left{glm::normalize(glm::dquat(0.8, 0.3, -0.4, 0.2)), {-1.1, 0.2, 0.3}, 0.7},
        right{{1, 0, 0, 0}, {1.0, -0.1, 0.5}, 1.0},
        far{glm::normalize(glm::dquat(0.1, -0.5, 0.6, 0.9)), {0.2, 0.3, 3.0}, 2.0};
    for (const bool gaussians : {false, true}) {
        const Scene three_bands = colourful(900, 1, 3, gaussians), one_band = colourful(700, 2, 1, gaussians);
        Scene by_hand = placeByHand(three_bands, left);
        appendSplats(by_hand, placeByHand(one_band, right));
        appendSplats(by_hand, placeByHand(three_bands, far));
        const bsp::Scene first = load(three_bands), other = load(one_band), all = load(by_hand);
        const Instances instances{instanceOf(first, left), instanceOf(other, right), instanceOf(first, far)};
        for (const bsp_mode mode : {BSP_MODE_SHARED, BSP_MODE_PREDICTED}) {
            const std::vector<float> expected = draw(frameOf(mode, all));
            // Splats at the same distance may change places by rounding.
            CHECK(rootMeanSquare(expected, draw(frameOf(mode), instances)) <
                  (mode == BSP_MODE_SHARED ? 2e-4 : 4e-3));
            CHECK(rootMeanSquare(expected) > 0.1);
        }
    }
}

TEST_CASE_FIXTURE(Drawn, "hidden instances are not there, moving ones leave nothing, new ones are a cut") {
    const bsp::Scene one = load(colourful(800, 3, 2, false)), other = load(colourful(500, 4, 0, false));
    Instances both{instanceOf(one, {{1, 0, 0, 0}, {-0.9, 0, 0}, 0.8}),
                   instanceOf(other, {{1, 0, 0, 0}, {1, 0, 0}, 0.6})};
    const bsp_frame_info shared = frameOf(BSP_MODE_SHARED), temporal = frameOf(BSP_MODE_TEMPORAL);
    both[1].hidden = 1;
    CHECK(draw(shared, both) == draw(shared, {both[0]}));
    both[1].hidden = 0;
    bsp::Renderer exact(*device);
    double worst = 0.0, without = 0.0;
    for (int i = 0; i < 24; ++i) {
        both[1].position[1] = 0.04 * i;
        both[0].hidden = i / 8 == 1 ? 1 : 0;
        const bsp::Views views = viewsAt(0.004 * i);
        const std::vector<float> seen = draw(temporal, both, views), full = draw(shared, both, views, &exact);
        worst = std::max(worst, rootMeanSquare(seen, full));
        without = std::max(without, rootMeanSquare(full));
    }
    CHECK(worst < 0.03);  // 30 dB
    CHECK(without > 0.1);
    both.push_back(instanceOf(other, {{1, 0, 0, 0}, {0, 0, 2}, 1.0}));
    CHECK(draw(temporal, both) == draw(shared, both, viewsAt(), &exact));
}

TEST_CASE_FIXTURE(Drawn, "scenes that cannot be drawn together, and senseless placements, are refused") {
    const bsp::Scene discs = load(colourful(10, 5, 0, false)), gaussians = load(colourful(10, 6, 0, true));
    const auto refused = [&](bsp_frame_info frame, const Instances& instances, const std::string& part) {
        checkRefusal([&] { (void)draw(frame, instances); }, BSP_ERROR_INPUT, part);
    };
    const bsp_frame_info frame = frameOf(BSP_MODE_SHARED), of_discs = frameOf(BSP_MODE_SHARED, discs);
    refused(frame, {instanceOf(discs), instanceOf(gaussians)}, "all discs, all Gaussians");
    refused(of_discs, {instanceOf(discs)}, "a scene and 1 instances");
    refused(frame, {instanceOf(discs, {{1, 0, 0, 0}, {}, -1.0})}, "scale of an instance is -1");
    refused(frame, {bsp::make<bsp_instance>(BSP_TYPE_INSTANCE)}, "scene of an instance is null");
    bsp_frame_info bad = frame;
    bad.foveation_rad = -1.0;
    refused(bad, {instanceOf(discs)}, "foveation_rad is -1");
    bad = frame;
    bad.error_bound_db = 61.0;
    refused(bad, {instanceOf(discs)}, "error_bound_db is 61");
    // What was drawn before still draws.
    CHECK(draw(frame, {instanceOf(discs)}) == draw(of_discs));
}

TEST_CASE_FIXTURE(Drawn, "a frame with foveation is exact where the eye looks, and blends fewer pairs") {
    const bsp::Scene room = load(makeBuiltin("builtin:atelier", 20000));
    const bsp::Views views = room.startViews(0.063, 1.6, 256, 256);
    bsp_frame_info frame = frameOf(BSP_MODE_TEMPORAL, room);
    frame.flags = BSP_FRAME_CUT;
    const std::vector<float> full = draw(frame, {}, views);
    frame.foveation_rad = 0.12;
    const std::vector<float> seen = draw(frame, {}, views);
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
    const bsp_scene_properties start = room.properties();
    bsp_frame_info frame = frameOf(BSP_MODE_TEMPORAL);
    frame.budget = 1.0;
    std::vector<double> work;
    for (const double bound : {15.0, 40.0, 0.0}) {
        frame.error_bound_db = bound;
        bsp::Renderer fresh(*device);
        work.push_back(0.0);
        for (int i = 0; i < 4; ++i) {
            const double eye[]{start.eye[0] + 0.004 * i, start.eye[1], start.eye[2]};
            const bsp::Views views = bsp::lookAt(eye, start.look, start.up, 0.063, 1.6, 256, 256);
            const double done = fresh.render(room, views, frame).work_rendered;
            if (i > 0) { work.back() += done; }
        }
    }
    CHECK(work[0] < 0.7 * work[1]);
    CHECK(work[1] < 0.9 * work[2]);
}

TEST_CASE_FIXTURE(Drawn, "a scene that moves shows the file of its time, alone and as an instance") {
    const auto frameAt = [](int i) { return colourful(600, 10 + static_cast<std::uint32_t>(i), 1, false); };
    writeFilm((path / "film").string(), 3, frameAt);
    const bsp::Scene film = load((path / "film").string(), 1);
    CHECK(film.properties().splats == 600);
    for (const int i : {0, 2, 1}) {
        const bsp::Scene still = load(frameAt(i));
        bsp_frame_info frame = frameOf(BSP_MODE_SHARED, film);
        frame.flags = BSP_FRAME_SETTLED;
        frame.time_s = 0.1 * i + 0.05;
        const bsp_frame_info of_still = frameOf(BSP_MODE_SHARED, still);
        CHECK(draw(frame) == draw(of_still));
        frame.scene = nullptr;
        const Similarity back{{0, 0, 1, 0}, {0, 0, 1}, 1.5};
        CHECK(draw(frame, {instanceOf(film, back)}) ==
              draw(frameOf(BSP_MODE_SHARED), {instanceOf(still, back)}));
    }
}

#ifdef BINOSPLAT_HAS_SPLIT_SCENE
TEST_CASE_FIXTURE(Drawn, "a streamed scene brings what views ask for, and settled it is the whole of it") {
    splitScene(makeBuiltin("builtin:atelier", 20000), (path / "streamed").string(),
               {.leaf_splats = 2048, .levels = 3, .chunk_splats = 8192});
    const std::string folder = (path / "streamed").string();
    const bsp::Scene stream = load(folder, 1), whole = load(folder);
    const bsp::Views views = whole.startViews(0.063, 1.2, 96, 64);
    bsp_frame_info frame = frameOf(BSP_MODE_SHARED, stream);
    const std::vector<float> full = draw(frameOf(BSP_MODE_SHARED, whole), {}, views);
    const double at_first = rootMeanSquare(draw(frame, {}, views), full);
    frame.flags = BSP_FRAME_SETTLED;
    CHECK(renderer->render(stream, views, frame).share_there == 1.0);
    const double settled = rootMeanSquare(draw(frame, {}, views), full);
    frame.scene = nullptr;
    const double placed = rootMeanSquare(draw(frame, {instanceOf(stream)}, views), full);
    CHECK(at_first > 2.0 * settled);
    CHECK(settled < 0.02);
    CHECK(placed < 0.02);
    CHECK(stream.properties().splats < whole.properties().splats);
}
#endif

}  // SUITE(instances)
