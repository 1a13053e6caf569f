// Facts about which tiles are rendered again, on scenes made so that the cause is known, and where moving pays.
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_cases.h"

SUITE(patching) {

constexpr glm::uvec2 kSizePx{256, 256};

FrameSettings makeSettings(Mode mode, Side dominant = kLeft) {
    FrameSettings settings;
    settings.mode = mode;
    settings.dominant = dominant;
    return settings;
}

struct Outcome {
    AffiliatedFrame made;
    double psnr_db;  // of the affiliated eye against its full render
};

// A pair of eyes before a scene, and the affiliated one in full.
class Scenery {
public:
    Scenery(Gpu& gpu, const Scene& scene, const std::array<Eye, 2>& eyes, Side dominant = kLeft)
        : frame_(gpu.context(), scene), eyes_(eyes), dominant_(dominant) {
        full_ = makeAffiliated(frame_, eyes, makeSettings(Mode::kShared, dominant)).pictures[1 - dominant];
    }

    Outcome render(FrameSettings settings) {
        settings.dominant = dominant_;
        AffiliatedFrame made = makeAffiliated(frame_, eyes_, settings);
        const double psnr_db = compare(made.pictures[1 - dominant_], full_).psnrDb();
        return {std::move(made), psnr_db};
    }
    Outcome render(Mode mode) { return render(makeSettings(mode)); }

private:
    test::KeptFrame frame_;
    std::array<Eye, 2> eyes_;
    Side dominant_;
    Image full_;
};

// A wall of discs at depth z that a 256 px eye of 222 px focal length sees as a chequered pattern.
void addWall(std::vector<Splat>& splats, float z, float half_width, float pitch) {
    const int reach = static_cast<int>(half_width / pitch);
    for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
            const float shade = ((i / 3 + j / 3) & 1) != 0 ? 0.2f : 0.35f;
            splats.push_back({{pitch * static_cast<float>(i), pitch * static_cast<float>(j), z},
                              {1, 0, 0, 0},
                              glm::vec2(0.8f * pitch),
                              0.95f,
                              glm::vec3(shade)});
        }
    }
}

// Bright translucent discs of 3 px at depth z whose centres an eye at `eye_x`, axis along z, sees in the columns [first, end).
void addVeil(std::vector<Splat>& splats, float z, float eye_x, int first_px, int end_px) {
    const float px = z / 222.0f;
    for (int y = 40; y < 216; y += 6) {
        for (int x = first_px; x < end_px; x += 6) {
            const glm::vec2 offset = px * (glm::vec2(x, y) - 128.0f);
            splats.push_back({{eye_x + offset.x, offset.y, z}, {1, 0, 0, 0}, glm::vec2(3.0f * px), 0.35f, {0.9f, 0.8f, 0.3f}});
        }
    }
}

std::array<Eye, 2> parallelEyes(double eye_distance) { return stereoPair({Pose{}, {222.0, 222.0, 128.0, 128.0}, kSizePx}, eye_distance); }

std::size_t countKind(const AffiliatedFrame& frame, gpu::uint kind) {
    return static_cast<std::size_t>(std::count(frame.tile_kinds.begin(), frame.tile_kinds.end(), kind));
}

// How much the third source of error gains at one and the same budget.
void checkNewcomers(Gpu& gpu, const std::vector<Splat>& splats, const std::array<Eye, 2>& eyes, Side dominant, double budget) {
    Scenery scenery(gpu, test::makeScene(splats), eyes, dominant);
    FrameSettings settings = makeSettings(Mode::kPredicted);
    settings.stereo.budget = budget;
    const Outcome with = scenery.render(settings);
    settings.stereo.newcomer_error = 0.0;
    const Outcome without = scenery.render(settings);
    CHECK(countOf(with.made.result, "splats_newcomers") > 0);
    CHECK(with.psnr_db >= without.psnr_db + 3.0);
}

TEST_CASE_FIXTURE(Gpu, "splats beyond the dominant eye's border and behind its near plane are found without a hole to show them") {
    // 0.25 before eyes 0.064 apart, 57 px of disparity: what one eye sees in its columns 210 to 238, the other has beyond 256.
    for (const Side dominant : {kLeft, kRight}) {
        CAPTURE(static_cast<int>(dominant));
        std::vector<Splat> splats;
        addWall(splats, 8.0f, 5.6f, 0.07f);
        addVeil(splats, 0.25f, dominant == kLeft ? 0.032f : -0.032f, dominant == kLeft ? 214 : 18, dominant == kLeft ? 239 : 43);
        checkNewcomers(*this, splats, parallelEyes(0.064), dominant, 0.15);
    }
    // The axes are turned outwards, so that what is to the right of the middle is nearer for the left eye. A sixth of the right
    // eye's picture is beyond the left one's border, too, and is rendered again first.
    std::array<Eye, 2> eyes = parallelEyes(0.064);
    for (int e = 0; e < 2; ++e) {
        eyes[e].world_from_camera.orientation = glm::angleAxis(glm::radians(e == kLeft ? -4.0 : 4.0), glm::dvec3(0, 1, 0));
    }
    const auto depthFor = [&](int e, const Splat& splat) {
        return transform(inverse(eyes[e].world_from_camera), glm::dvec3(splat.position)).z;
    };
    std::vector<Splat> splats;
    addVeil(splats, 0.2015f, 0.0f, 168, 201);
    std::erase_if(splats, [&](const Splat& splat) { return depthFor(kLeft, splat) > 0.199 || depthFor(kRight, splat) < 0.201; });
    REQUIRE(splats.size() > 50);
    addWall(splats, 8.0f, 8.4f, 0.07f);
    checkNewcomers(*this, splats, eyes, kLeft, 0.4);
    // What both eyes see is no newcomer.
    splats.clear();
    addWall(splats, 8.0f, 3.5f, 0.07f);
    addVeil(splats, 0.4f, 0.032f, 60, 200);
    Scenery both(*this, test::makeScene(splats), parallelEyes(0.064));
    CHECK(countOf(both.render(Mode::kPredicted).made.result, "splats_newcomers") == 0);
}

TEST_CASE_FIXTURE(Gpu, "where moving did not pay the next frame leaves it out and loses nothing, until it would pay again") {
    const auto view = test::viewBuiltin("builtin:atelier", kSizePx, 20000);
    const std::array<Eye, 2> eyes = stereoPair(view.eye, 0.064);
    std::array<Eye, 2> outside = eyes;
    for (Eye& eye : outside) { eye.world_from_camera.position += eye.world_from_camera.orientation * glm::dvec3(0, 0, 1000); }
    const GpuScene scene(context(), view.scene);
    test::KeptFrame frame(context(), scene), plain(context(), scene);
    const auto render = [&](const std::array<Eye, 2>& of, double budget = 0.22) {
        FrameSettings settings = makeSettings(Mode::kPredicted);
        settings.stereo.budget = budget;
        return makeAffiliated(frame, of, settings);
    };
    const auto reprojects = [](const AffiliatedFrame& made) {
        return std::ranges::any_of(made.result.gpu_ms, [](const auto& pass) { return pass.label.text() == "affiliated resample"; });
    };
    const auto isWhole = [&](const AffiliatedFrame& made, const std::array<Eye, 2>& of) {
        const AffiliatedFrame shared = makeAffiliated(plain, of, makeSettings(Mode::kShared));
        CHECK(countKind(made, gpu::kTileCheap) == made.tile_kinds.size());
        CHECK(countOf(made.result, "tiles_patched") == made.tile_kinds.size());
        CHECK(these(made.result.tiles_rendered, made.result.work_rendered) == these(1.0, 1.0));
        return made.pictures[kLeft].values == shared.pictures[kLeft].values &&
               made.pictures[kRight].values == shared.pictures[kRight].values;
    };
    // Before the eyes there is nothing: what moves is asked once.
    CHECK(reprojects(render(outside)));
    const AffiliatedFrame left_out = render(outside);
    CHECK_FALSE(reprojects(left_out));
    CHECK(isWhole(left_out, outside));
    const AffiliatedFrame first = render(eyes), second = render(eyes);
    CHECK_FALSE(reprojects(first));
    CHECK(isWhole(first, eyes));
    CHECK(reprojects(second));
    CHECK(countOf(second.result, "tiles_weighed_as_moved") > 0);
    CHECK(second.result.work_rendered < 0.5);
    // Whoever asks for something else is answered at once.
    CHECK_FALSE((render(outside), reprojects(render(outside))));
    CHECK(reprojects(render(eyes, 0.1)));
}

}  // SUITE(patching)
