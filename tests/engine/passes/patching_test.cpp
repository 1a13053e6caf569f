// Facts about which tiles are rendered again, in scenes made so that the cause is known, and about where
// moving pays.
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
    [[nodiscard]] const Image& full() const { return full_; }

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
            splats.push_back({{pitch * static_cast<float>(i), pitch * static_cast<float>(j), z},
                              {1, 0, 0, 0},
                              glm::vec2(0.8f * pitch),
                              0.95f,
                              glm::vec3(shade)});
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
            splats.push_back({{eye_x + offset.x, offset.y, z},
                              {1, 0, 0, 0},
                              glm::vec2(3.0f * px),
                              0.35f,
                              {0.9f, 0.8f, 0.3f}});
        }
    }
}

std::array<Eye, 2> parallelEyes(double eye_distance) {
    return stereoPair({Pose{}, {222.0, 222.0, 128.0, 128.0}, kSizePx}, eye_distance);
}

std::size_t countKind(const AffiliatedFrame& frame, gpu::uint kind) {
    return static_cast<std::size_t>(std::count(frame.tile_kinds.begin(), frame.tile_kinds.end(), kind));
}

// Pixels of a class in tiles that are not rendered again.
std::size_t countLeft(const AffiliatedFrame& frame, gpu::uint pixel_class, glm::uvec2 size_px) {
    std::size_t left = 0;
    for (std::size_t i = 0; i < frame.pixel_classes.size(); ++i) {
        const std::size_t tile = i / size_px.x / 16 * ((size_px.x + 15) / 16) + i % size_px.x / 16;
        left += frame.pixel_classes[i] == pixel_class && frame.tile_kinds[tile] == 0 ? 1 : 0;
    }
    return left;
}

// How much the third source of error gains at the same budget.
void checkNewcomers(Gpu& gpu, const std::vector<Splat>& splats, const std::array<Eye, 2>& eyes, Side dominant,
                    double budget) {
    Scenery scenery(gpu, makeScene(splats), eyes, dominant);
    FrameSettings settings = makeSettings(Mode::kPredicted);
    settings.stereo.budget = budget;
    const Outcome with = scenery.render(settings);
    settings.stereo.newcomer_error = 0.0;
    const Outcome without = scenery.render(settings);
    CHECK(countOf(with.made.result, "splats_newcomers") > 0);
    CHECK(with.psnr_db >= without.psnr_db + 3.0);
}

// The direction from an eye to the middle of a tile.
double angleOf(const Eye& eye, std::size_t tile, const Gaze& gaze) {
    const Intrinsics& lens = eye.intrinsics;
    const std::size_t columns = (eye.size_px.x + 15) / 16;
    const glm::dvec2 middle_px = 16.0 * glm::dvec2(tile % columns, tile / columns) + 8.0;
    const glm::dvec3 ray((middle_px.x - lens.cx) / lens.fx, (middle_px.y - lens.cy) / lens.fy, 1.0);
    return std::acos(std::clamp(glm::dot(glm::normalize(ray), glm::normalize(gaze.direction)), -1.0, 1.0));
}

// Over the right eye's tiles near its gaze.
double psnrNear(const Image& made, const Image& full, const Eye& eye, const Gaze& gaze) {
    std::vector<std::uint32_t> near;
    for (std::size_t t = 0; t < tileCount(eye.size_px); ++t) {
        near.push_back(angleOf(eye, t, gaze) <= gaze.clear_rad ? 1 : 0);
    }
    return compare(keepTiles(made, near), keepTiles(full, near)).psnrDb();
}

bool isChosen(const AffiliatedFrame& made, std::size_t tile) {
    return made.tile_kinds[tile] == gpu::kTilePredicted;
}

TEST_CASE_FIXTURE(Gpu,
                  "splats beyond the dominant eye's border and behind its near plane are found without a "
                  "hole to show them") {
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
    std::array<Eye, 2> eyes = parallelEyes(0.064);
    for (int e = 0; e < 2; ++e) {
        eyes[e].world_from_camera.orientation =
            glm::angleAxis(glm::radians(e == kLeft ? -4.0 : 4.0), glm::dvec3(0, 1, 0));
    }
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
    // What both eyes see is not a newcomer.
    splats.clear();
    addWall(splats, 8.0f, 3.5f, 0.07f);
    addVeil(splats, 0.4f, 0.032f, 60, 200);
    Scenery both(*this, makeScene(splats), parallelEyes(0.064));
    CHECK(countOf(both.render(Mode::kPredicted).made.result, "splats_newcomers") == 0);
}

TEST_CASE_FIXTURE(Gpu,
                  "a near edge uncovers holes beside it; centre ROIs leave none, and every patch brings the "
                  "picture nearer to the full render") {
    // A screen at depth 1 ends at x = -0.05, in front of a wall at depth 4; for eyes 0.12 apart the
    // disparities are 26.6 px and 6.7 px.
    std::vector<Splat> splats;
    addWall(splats, 4.0f, 3.5f, 0.05f);
    for (float y = -0.8f; y < 0.8f; y += 0.012f) {
        for (float x = -0.45f; x < -0.05f; x += 0.012f) {
            splats.push_back({{x, y, 1.0f}, {1, 0, 0, 0}, glm::vec2(0.008f), 0.97f, glm::vec3(0.7f)});
        }
    }
    const auto fence = viewBuiltin("builtin:fence", kSizePx);
    for (const bool bars : {false, true}) {
        for (const Side dominant : {kLeft, kRight}) {
            INFO("bars ", bars, ", dominant ", static_cast<int>(dominant));
            Scenery scenery(*this, bars ? fence.scene : makeScene(splats),
                            bars ? stereoPair(fence.eye, 0.12) : parallelEyes(0.12), dominant);
            const Outcome filled = scenery.render(Mode::kReproject);
            FrameSettings settings = makeSettings(Mode::kPaper);
            settings.stereo.margin_px = 0;
            const Outcome edges = scenery.render(settings);
            settings.stereo.center_rois = true;
            const Outcome centers = scenery.render(settings);
            settings.mode = Mode::kPredicted;
            settings.stereo.budget = 0.25;
            const Outcome predicted = scenery.render(bars ? makeSettings(Mode::kPredicted) : settings);
            CHECK(countLeft(centers.made, gpu::kHole, kSizePx) == 0);
            CHECK(predicted.psnr_db > filled.psnr_db + (bars ? 0.0 : 3.0));
            if (bars) {
                CHECK(edges.psnr_db > filled.psnr_db);
                CHECK(centers.psnr_db > edges.psnr_db);
                continue;
            }
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
            CHECK(beside >= 256 * 10);
            CHECK(beside <= 256 * 20);
            CHECK(elsewhere == 0);
            CHECK(countKind(edges.made, gpu::kTileCenter) == 0);
            CHECK(countKind(centers.made, gpu::kTileCenter) > 0);
            CHECK(countKind(centers.made, gpu::kTileEdge) == countKind(edges.made, gpu::kTileEdge));
            CHECK(centers.psnr_db >= edges.psnr_db + 3.0);
            CHECK(countLeft(predicted.made, gpu::kHole, kSizePx) == 0);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "pixels that blend two depths are rendered again first") {
    const auto view = viewBuiltin("builtin:two-layers", kSizePx);
    Scenery scenery(*this, view.scene, stereoPair(view.eye, 0.12));
    FrameSettings sparse = makeSettings(Mode::kPredicted);
    sparse.stereo.budget = 0.1;  // with more, moving would not pay in a scene this thin
    const Outcome moved = scenery.render(Mode::kReproject), predicted = scenery.render(sparse);
    CHECK(countKind(predicted.made, gpu::kTilePredicted) > 0);
    CHECK(predicted.psnr_db >= moved.psnr_db + 1.0);
    // The error depends on whether a pixel's depth is its mean disparity.
    FrameSettings settings = makeSettings(Mode::kReproject);
    for (const gpu::uint choice : {gpu::kDepthSum, gpu::kDepthMean}) {
        settings.stereo.depth_choice = choice;
        CHECK(moved.psnr_db >= scenery.render(settings).psnr_db);
    }
}

TEST_CASE_FIXTURE(
    Gpu,
    "where moving did not pay the next frame leaves it out and loses nothing, until it would pay again") {
    const auto view = viewBuiltin("builtin:atelier", kSizePx, 20000);
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
        CHECK(countKind(made, gpu::kTileCheap) == made.tile_kinds.size());
        CHECK(countOf(made.result, "tiles_patched") == made.tile_kinds.size());
        CHECK(made.result.tiles_rendered == 1.0);
        CHECK(made.result.work_rendered == 1.0);
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

TEST_CASE_FIXTURE(Gpu,
                  "where it is known where the eye looks fewer tiles are rendered again, none less about "
                  "that place, and it is as good there") {
    for (const double canting_rad : {0.0, glm::radians(5.0)}) {
        const auto view = viewBuiltin("builtin:atelier", {384, 320}, 40000);
        const auto eyes = headsetEyes(view.eye, canting_rad);
        Scenery room(*this, view.scene, eyes);
        FrameSettings settings = makeSettings(Mode::kPredicted);
        settings.stereo.budget = 0.22;
        const AffiliatedFrame everywhere = room.render(settings).made;
        for (const glm::dvec3 direction : {glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(-0.35, 0.2, 1.0)}) {
            INFO("canting rad ", canting_rad, ", direction.x ", direction.x);
            const Gaze gaze{direction, glm::radians(10.0)};
            settings.gazes[kRight] = gaze;
            const AffiliatedFrame there = room.render(settings).made;
            for (std::size_t t = 0; t < there.tile_kinds.size(); ++t) {
                const bool near = angleOf(eyes[kRight], t, gaze) <= gaze.clear_rad;
                if (isChosen(there, t) != isChosen(everywhere, t)) { CHECK(near == isChosen(there, t)); }
            }
            CHECK(countOf(there.result, "tiles_predicted") < countOf(everywhere.result, "tiles_predicted"));
            CHECK(countOf(there.result, "work_patched") < countOf(everywhere.result, "work_patched"));
            CHECK(psnrNear(there.pictures[kRight], room.full(), eyes[kRight], gaze) >=
                  psnrNear(everywhere.pictures[kRight], room.full(), eyes[kRight], gaze));
        }
        // An eye that may look everywhere gets the same picture as one whose gaze is unknown.
        settings.gazes[kRight] = Gaze{{0.0, 0.0, 1.0}, 1.6};
        const AffiliatedFrame clear = room.render(settings).made;
        CHECK(clear.tile_kinds == everywhere.tile_kinds);
        CHECK(clear.pictures[kRight].values == everywhere.pictures[kRight].values);
    }
}

}  // SUITE(patching)
