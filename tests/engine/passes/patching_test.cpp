// Facts about which tiles are rendered again, in scenes made so that the cause is known, and about where
// moving pays.
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/passes/stereo_cases.h"

SUITE(patching) {

constexpr glm::uvec2 kSizePx{256, 256};

struct Outcome {
    AffiliatedFrame made;
    double psnr_db;  // the affiliated eye against its full render
};

// A pair of eyes in front of a scene, and the affiliated eye's full render.
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
    KeptFrame frame_;
    std::array<Eye, 2> eyes_;
    Side dominant_;
    Image full_;
};

// A wall of discs at depth z that looks like a chequerboard to an eye of 256 px with a focal length of 222
// px.
void addWall(std::vector<Splat>& splats, float z, float half_width, float pitch) {
    const int reach = static_cast<int>(half_width / pitch);
    for (int j = -reach; j <= reach; ++j) {
        for (int i = -reach; i <= reach; ++i) {
            const float shade = ((i / 3 + j / 3) & 1) != 0 ? 0.2f : 0.35f;
            splats.push_back({.position = {pitch * static_cast<float>(i), pitch * static_cast<float>(j), z},
                              .scale = glm::vec2(0.8f * pitch),
                              .opacity = 0.95f,
                              .colour = glm::vec3(shade)});
        }
    }
}

// Bright translucent discs of 3 px at depth z. An eye at `eye_x` that looks along z sees their centres in the
// columns [first, end).
void addVeil(std::vector<Splat>& splats, float z, float eye_x, int first_px, int end_px) {
    const float px = z / 222.0f;
    for (int y = 40; y < 216; y += 6) {
        for (int x = first_px; x < end_px; x += 6) {
            const glm::vec2 offset = px * (glm::vec2(x, y) - 128.0f);
            splats.push_back({.position = {eye_x + offset.x, offset.y, z},
                              .scale = glm::vec2(3.0f * px),
                              .opacity = 0.35f,
                              .colour = {0.9f, 0.8f, 0.3f}});
        }
    }
}

std::array<Eye, 2> parallelEyes(double eye_distance) {
    return stereoPair({Pose{}, {222.0, 222.0, 128.0, 128.0}, kSizePx}, eye_distance);
}

std::ptrdiff_t countKind(const AffiliatedFrame& frame, gpu::uint kind) {
    return std::ranges::count(frame.tile_kinds, kind);
}

// Holes in tiles that are not rendered again.
std::size_t countHolesLeft(const AffiliatedFrame& frame) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < frame.pixel_classes.size(); ++i) {
        left += frame.pixel_classes[i] == gpu::kHole && frame.tile_kinds[tileOf(i, kSizePx)] == 0;
    }
    return left;
}

// How many splats only the affiliated eye sees, and how much better its picture is for their error at the
// same budget.
void checkNewcomers(Gpu& gpu, const std::vector<Splat>& splats, const std::array<Eye, 2>& eyes, Side dominant,
                    double budget) {
    Scenery scenery(gpu, makeScene(splats), eyes, dominant);
    FrameSettings settings = makeSettings(Mode::kPredicted);
    settings.stereo.budget = budget;
    const Outcome with = scenery.render(settings);
    settings.stereo.newcomer_error = 0.0;
    CHECK(countOf(with.made.result, "splats_newcomers") > 0);
    CHECK(with.psnr_db >= scenery.render(settings).psnr_db + 3.0);
}

TEST_CASE_FIXTURE(Gpu, "splats beyond the dominant eye's border and behind its near plane are found") {
    // A veil at 0.25 in front of eyes 0.064 apart has a disparity of 57 px: what one eye sees in columns 210
    // to 238, the other has beyond 256.
    for (const Side dominant : {kLeft, kRight}) {
        CAPTURE(static_cast<int>(dominant));
        std::vector<Splat> splats;
        addWall(splats, 8.0f, 5.6f, 0.07f);
        addVeil(splats, 0.25f, dominant == kLeft ? 0.032f : -0.032f, dominant == kLeft ? 214 : 18,
                dominant == kLeft ? 239 : 43);
        checkNewcomers(*this, splats, parallelEyes(0.064), dominant, 0.15);
    }
    // The axes are turned outwards, so what is right of the middle is nearer for the left eye. A sixth of the
    // right eye's picture lies beyond the left one's border as well, and is rendered again first.
    const auto [left, right] = parallelEyes(0.064);
    const std::array eyes{turned(left, glm::radians(-4.0)), turned(right, glm::radians(4.0))};
    const auto depthFor = [&](int e, const Splat& splat) {
        return transform(inverse(eyes[e].world_from_camera), glm::dvec3(splat.position)).z;
    };
    std::vector<Splat> splats;
    addVeil(splats, 0.2015f, 0.0f, 168, 201);
    std::erase_if(splats, [&](const Splat& splat) {
        return depthFor(kLeft, splat) > 0.199 || depthFor(kRight, splat) < 0.201;
    });
    REQUIRE(splats.size() > 50);
    addWall(splats, 8.0f, 8.4f, 0.07f);
    checkNewcomers(*this, splats, eyes, kLeft, 0.4);
}

TEST_CASE_FIXTURE(Gpu, "a near edge uncovers holes beside it; centre ROIs leave none, and patches mend it") {
    // A screen at depth 1 ends at x = -0.05, in front of a wall at depth 4; for eyes 0.12 apart the
    // disparities are 26.6 px and 6.7 px.
    std::vector<Splat> splats;
    addWall(splats, 4.0f, 3.5f, 0.05f);
    for (float y = -0.8f; y < 0.8f; y += 0.012f) {
        for (float x = -0.45f; x < -0.05f; x += 0.012f) {
            splats.push_back({{x, y, 1.0f}, {1, 0, 0, 0}, glm::vec2(0.008f), 0.97f, glm::vec3(0.7f)});
        }
    }
    for (const Side dominant : {kLeft, kRight}) {
        CAPTURE(static_cast<int>(dominant));
        Scenery scenery(*this, makeScene(splats), parallelEyes(0.12), dominant);
        const Outcome filled = scenery.render(Mode::kReproject);
        FrameSettings settings = makeSettings(Mode::kPaper);
        settings.stereo.margin_px = 0;
        const Outcome edges = scenery.render(settings);
        settings.stereo.center_rois = true;
        const Outcome centers = scenery.render(settings);
        settings.mode = Mode::kPredicted;
        settings.stereo.budget = 0.25;
        const Outcome predicted = scenery.render(settings);
        // Where the affiliated eye sees the edge from behind which the far wall appears: the right edge
        // for the right eye, the left edge for the left one.
        const double edge_px =
            dominant == kLeft ? 128.0 + 222.0 * (-0.05 - 0.06) : 128.0 + 222.0 * (-0.45 + 0.06);
        std::size_t beside = 0, elsewhere = 0;
        for (std::size_t i = 0; i < filled.made.pixel_classes.size(); ++i) {
            const double x = static_cast<double>(i % 256) + 0.5;
            if (filled.made.pixel_classes[i] == gpu::kHole && x > 16.0 && x < 240.0) {
                (std::abs(x - edge_px) < 28.0 ? beside : elsewhere) += 1;
            }
        }
        CHECK(these(beside, elsewhere) == these(within(256 * 10, 256 * 20), 0));
        CHECK(these(countKind(edges.made, gpu::kTileCenter), countKind(edges.made, gpu::kTileEdge)) ==
              these(0, countKind(centers.made, gpu::kTileEdge)));
        CHECK(these(countHolesLeft(centers.made), countHolesLeft(predicted.made)) == these(0u, 0u));
        CHECK(centers.psnr_db >= edges.psnr_db + 3.0);
        CHECK(predicted.psnr_db > filled.psnr_db + 3.0);
    }
}

TEST_CASE_FIXTURE(Gpu, "where moving did not pay it is left out, and nothing is lost, until it would pay") {
    const auto view = viewAtelier(kSizePx);
    const std::array<Eye, 2> eyes = stereoPair(view.eye, 0.064);
    std::array<Eye, 2> outside = eyes;
    for (Eye& eye : outside) {
        eye.world_from_camera.position += eye.world_from_camera.orientation * glm::dvec3(0, 0, 1000);
    }
    const GpuScene scene(context(), view.scene);
    KeptFrame frame(context(), scene), plain(context(), scene);
    const auto render = [&](const std::array<Eye, 2>& of, double budget = 0.22) {
        FrameSettings settings = makeSettings(Mode::kPredicted);
        settings.stereo.budget = budget;
        return makeAffiliated(frame, of, settings);
    };
    const auto reprojects = [](const AffiliatedFrame& made) {
        return std::ranges::any_of(
            made.result.gpu_ms, [](const auto& pass) { return pass.label.text() == "affiliated resample"; });
    };
    const auto isWhole = [&](const AffiliatedFrame& made, const std::array<Eye, 2>& of) {
        const AffiliatedFrame shared = makeAffiliated(plain, of, makeSettings(Mode::kShared));
        const std::size_t tiles = made.tile_kinds.size();
        CHECK(these(countKind(made, gpu::kTileCheap), countOf(made.result, "tiles_patched")) ==
              these(tiles, tiles));
        CHECK(these(made.result.tiles_rendered, made.result.work_rendered) == these(1.0, 1.0));
        return made.pictures[kLeft].values == shared.pictures[kLeft].values &&
               made.pictures[kRight].values == shared.pictures[kRight].values;
    };
    // With nothing in front of the eyes, reprojection is asked for once.
    CHECK(reprojects(render(outside)));
    const AffiliatedFrame left_out = render(outside);
    CHECK_FALSE(reprojects(left_out));
    CHECK(isWhole(left_out, outside));
    const AffiliatedFrame first = render(eyes), second = render(eyes);
    CHECK_FALSE(reprojects(first));
    CHECK(isWhole(first, eyes));
    CHECK(reprojects(second));
    CHECK(countOf(second.result, "tiles_weighed_as_reprojected") > 0);
    CHECK(second.result.work_rendered < 0.5);
    // A different request is answered at once.
    CHECK_FALSE((render(outside), reprojects(render(outside))));
    CHECK(reprojects(render(eyes, 0.1)));
}

}  // SUITE(patching)
