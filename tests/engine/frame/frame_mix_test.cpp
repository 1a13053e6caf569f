// Any kind of frame after any other kind, as in no real program: each picture must equal the one of a frame
// that knows nothing of earlier ones, or be close to the full render.
#include "tests/engine/frame/frame_runs.h"

SUITE(frame_mix) {

constexpr std::array kModes{Mode::kMono,  Mode::kTwoPass,   Mode::kShared,    Mode::kReproject,
                            Mode::kPaper, Mode::kPredicted, Mode::kAlternate, Mode::kTemporal};
constexpr int kFrames = 12;
// For a picture that is reprojected from one of another size, with other angles, from up to 5 cm away.
// Overwritten or missing pixels score lower.
constexpr double kLeastDb = 17.0;

struct Dice {
    double between(double low, double high) { return drawBetween(random, low, high); }
    bool falls(double odds = 0.5) { return drawUnit(random) < odds; }
    std::size_t below(std::size_t count) { return random() % count; }
    glm::dvec3 vector(double reach) {
        return {between(-reach, reach), between(-reach, reach), between(-reach, reach)};
    }

    std::mt19937 random;
};

// The settings of a frame; holds its hidden tiles.
class Walk {
public:
    Walk(unsigned seed, const Eye& start) : dice_{std::mt19937(seed)}, middle_(start) {
        change();
        changeEyes();
    }

    // On to the next frame.
    void go() {
        if (dice_.falls()) { change(); }
        if (dice_.falls(0.3)) { changeEyes(); }
        const double reach = dice_.falls(0.2) ? dice_.between(0.02, 0.4) : 0.004;  // now and then a jump
        middle_.world_from_camera.position += dice_.vector(reach);
        middle_.world_from_camera.orientation =
            glm::normalize(middle_.world_from_camera.orientation *
                           glm::angleAxis(0.005, glm::normalize(dice_.vector(1) + 1e-3)));
    }

    [[nodiscard]] std::vector<Eye> eyes() const {
        const std::array pair = stereoPair(middle_, 0.063);
        std::vector<Eye> eyes(pair.begin(), pair.begin() + (settings_.mode == Mode::kMono ? 1 : 2));
        for (std::size_t e = 0; e < eyes.size(); ++e) {
            eyes[e].size_px = sizes_[reprojects(settings_.mode) || !settings_.keep_history ? 0 : e];
            eyes[e].intrinsics = intrinsicsFromAngles(angles_[e], eyes[e].size_px);
            eyes[e] = turned(eyes[e], e == 0 ? -cant_ : cant_);
        }
        return eyes;
    }

    [[nodiscard]] FrameSettings settings() {
        FrameSettings settings = settings_;
        // Moments are for files: pictures that are only shown have no kernel for them, and neither have
        // histories.
        settings.keep_moments = settings.keep_moments && !settings.half_floats &&
                                !(settings.keep_history && hasHistory(settings.mode));
        const std::vector<Eye> all = eyes();
        for (std::size_t e = 0; e < all.size() && hides_; ++e) {
            hidden_[e].assign(tileCount(all[e].size_px), 0);
            std::fill_n(hidden_[e].begin(), tilesOf(all[e].size_px).x, 1);  // the top row
            settings.hidden_tiles[e] = hidden_[e];
        }
        return settings;
    }

    [[nodiscard]] bool goesAhead() { return dice_.falls(); }

private:
    // Everything at first, then a few settings at a time, so that histories survive.
    void change() {
        FrameSettings& s = settings_;
        const bool is_new = std::exchange(is_new_, false);
        const auto when = [&](auto&& set) {
            if (is_new || dice_.falls(0.12)) { set(); }
        };
        when([&] { s.mode = dice_.falls() ? Mode::kTemporal : kModes[dice_.below(kModes.size())]; });
        when([&] { s.dominant = dice_.falls() ? kLeft : kRight; });
        when([&] { s.near = dice_.falls() ? 0.2 : dice_.between(0.01, 0.4); });
        when([&] { s.background = dice_.falls() ? glm::dvec3(0) : glm::abs(dice_.vector(1)); });
        when([&] { s.order = dice_.falls(0.3) ? Order::kDistance : Order::kDepth; });
        when([&] { s.per_eye = dice_.falls(0.3); });
        when([&] { s.half_floats = dice_.falls(); });
        when([&] { s.keep_depth = dice_.falls(); });
        when([&] { s.keep_both_depths = dice_.falls(0.3); });
        when([&] { s.keep_moments = dice_.falls(0.1); });
        when([&] { s.keep_classes = dice_.falls(0.3); });
        when([&] { s.half_periphery = dice_.falls(); });
        when([&] { s.keep_history = dice_.falls(0.9); });
        when([&] {
            const bool both = dice_.falls(0.6);
            for (auto& gaze : s.gazes) {
                gaze.reset();
                if (!both && !dice_.falls(0.3)) { continue; }
                gaze =
                    Gaze{{dice_.between(-0.3, 0.3), dice_.between(-0.3, 0.3), 1}, dice_.between(0.05, 0.4)};
            }
        });
        when([&] { s.stereo.budget = dice_.falls(0.2) ? 1.0 : dice_.between(0.1, 0.5); });
        when([&] { s.stereo.forward = dice_.falls(0.3); });
        when([&] {
            s.stereo.depth_choice = dice_.falls(0.7) ? gpu::kDepthInverse
                                    : dice_.falls()  ? gpu::kDepthMean
                                                     : gpu::kDepthSum;
        });
        when([&] { s.stereo.tight_edges = dice_.falls(); });
        when([&] { s.stereo.center_rois = dice_.falls(0.3); });
        when([&] { s.stereo.move_cost = dice_.falls() ? 0 : 32; });
        when([&] { hides_ = dice_.falls(0.3); });
    }

    void changeEyes() {
        constexpr std::array<glm::uvec2, 4> kSizes{{{96, 80}, {131, 77}, {64, 112}, {160, 144}}};
        for (std::size_t e = 0; e < 2; ++e) {
            sizes_[e] = e == 1 && dice_.falls(0.7) ? sizes_[0] : kSizes[dice_.below(kSizes.size())];
            angles_[e] = {-dice_.between(0.4, 0.8), dice_.between(0.4, 0.8), dice_.between(0.4, 0.8),
                          -dice_.between(0.4, 0.8)};
        }
        if (dice_.falls()) { angles_[1] = angles_[0]; }
        cant_ = dice_.falls() ? 0.0 : dice_.between(0.0, 0.15);
    }

    Dice dice_;
    Eye middle_;
    FrameSettings settings_;
    std::array<glm::uvec2, 2> sizes_{};
    std::array<ViewAngles, 2> angles_{};
    double cant_ = 0.0;
    bool hides_ = false, is_new_ = true;
    std::array<std::vector<std::uint8_t>, 2> hidden_;
};

// Whether all that it learns from earlier frames is whether moving pays.
bool standsAlone(const FrameSettings& settings) {
    return !hasHistory(settings.mode) || !settings.keep_history;
}

// By frames that know of none before them.
std::vector<Image> picturesAlone(StereoFrame& other, const std::vector<Eye>& eyes,
                                 const FrameSettings& settings) {
    const auto frame = StereoFrame::beside(other);
    frame->render(eyes, settings);
    if (eyes.size() == 1) { return {frame->readPicture(0)}; }
    return {frame->readPicture(kLeft), frame->readPicture(kRight)};
}

TEST_CASE_FIXTURE(Gpu, "any frame may follow any other") {
    const ViewedScene room = viewBuiltin("builtin:atelier", {96, 80}, 8000);
    for (unsigned seed = 1; seed <= 4; ++seed) {
        Walk walk(seed, room.eye);
        KeptFrame mixed(context(), room.scene);
        for (int i = 0; i < kFrames; ++i) {
            const std::vector<Eye> eyes = walk.eyes();
            const FrameSettings settings = walk.settings();
            INFO("seed ", seed, ", i ", i, ", mode ", nameOf(settings.mode));
            if (walk.goesAhead()) {
                mixed.renderAhead(eyes, settings);
            } else {
                mixed.render(eyes, settings);
            }
            FrameSettings full = settings;
            full.mode = eyes.size() == 1 ? Mode::kMono : Mode::kTwoPass;
            full.half_periphery = false;
            const std::vector<Image> in_full = picturesAlone(mixed, eyes, full);
            const std::vector<Image> alone =
                standsAlone(settings) ? picturesAlone(mixed, eyes, settings) : in_full;
            for (std::size_t e = 0; e < eyes.size(); ++e) {
                CAPTURE(e);
                const Image picture = mixed.readPicture(static_cast<int>(e));
                REQUIRE(picture.size_px == eyes[e].size_px);
                // `predicted` renders in full where moving did not pay last time.
                const bool same =
                    picture.values == alone[e].values || (choiceOf(settings.mode) == TileChoice::kPredicted &&
                                                          picture.values == in_full[e].values);
                if (standsAlone(settings)) {
                    CHECK(same);
                } else if (!same) {
                    CHECK(compare(picture, picture, 4).not_finite == 0);
                    CHECK(compare(in_full[e], picture).psnrDb() > kLeastDb);
                }
            }
            walk.go();
        }
        mixed.finish();
    }
}

}  // SUITE(frame_mix)
