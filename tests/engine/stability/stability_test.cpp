// Facts about stiff and extreme cases: the catalogue of `binosplat stability` but for its largest picture, on the device, and its
// sequences.
#include "engine/stability/extreme_scenes.h"
#include "engine/stability/run_case.h"
#include "tests/engine/gpu/gpu_fixture.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

TEST_SUITE_BEGIN("stability");

namespace stability_test {

using namespace binosplat;
using namespace binosplat::stability;
using test::Gpu;

namespace {

// Pictures of one stage after another, by kernels that are compiled once.
class Pairs {
public:
    explicit Pairs(const Context& context) : context_(context) {}

    std::vector<Image> render(const Stage& stage, Mode mode) {
        scene_.emplace(context_, stage.scene);
        if (frame_) {
            frame_->show(*scene_);
        } else {
            frame_.emplace(context_, *scene_);
        }
        FrameSettings settings;
        settings.mode = mode;
        settings.near = stage.near;
        frame_->render(stage.eyes, settings);
        return {frame_->readPicture(kLeft), frame_->readPicture(kRight)};
    }

private:
    const Context& context_;
    std::optional<GpuScene> scene_;
    std::optional<StereoFrame> frame_;
};

// The first `count` splats of a scene without SH bands.
Stage keepFirst(Stage stage, std::size_t count) {
    stage.scene.positions.resize(count);
    stage.scene.rotations.resize(count);
    stage.scene.scales.resize(count);
    if (stage.scene.isGaussian3d()) { stage.scene.thicknesses.resize(count); }
    stage.scene.opacities.resize(count);
    stage.scene.sh.resize(3 * count);
    return stage;
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "every case is finite, repeats and keeps to its bounds beside the twin, in every mode") {
    std::set<std::string> names;
    CaseRunner runner(context());
    for (const Case& one : makeCatalogue()) {
        CHECK(names.insert(one.name()).second);
        CHECK(std::min(one.rendered.psnr_db, one.moved.psnr_db) > 10.0);  // less is no bound
        if (one.large) { continue; }
        const CaseScore score = runner.run(one);
        CHECK(score.pictures.size() == 11);
        for (const PictureScore& picture : score.pictures) {
            INFO(one.name() << ", " << nameOf(picture.mode) << ", " << picture.eye << ": " << picture.psnr_db << " dB, off "
                            << picture.share_off << ", largest " << picture.largest << ", other tiles " << picture.other_tiles);
            CHECK(picture.not_finite == 0);
            CHECK(picture.repeats);
            CHECK(picture.passes);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "an eye that goes through discs and along their planes sees no more change at a time than the twin's") {
    CaseRunner runner(context());
    for (const Path& path : makePaths()) {
        const PathScore score = runner.run(path);
        INFO(path.name << ": " << score.device << ", the twin's " << score.twin << ", worst frame " << score.psnr_db << " dB");
        CHECK(score.not_finite == 0);
        CHECK(score.passes);
        CHECK(score.psnr_db >= 50.0);
    }
}

TEST_CASE_FIXTURE(Gpu, "pictures that are made from the ones before keep to their bounds beside full renders, however long") {
    CaseRunner runner(context());
    for (const Sequence& sequence : makeSequences()) {
        const SequenceScore score = runner.run(sequence);
        INFO(sequence.title() << ": worst " << score.psnr_db << " dB, drift " << score.drift_db << " dB, beyond " << score.beyond
                              << ", bias " << score.bias << ", equal from " << score.equal_from);
        CHECK(score.not_finite == 0);
        CHECK(score.repeats);
        CHECK(score.frames.size() >= 20);
        CHECK(score.passes);
    }
}

TEST_CASE_FIXTURE(Gpu, "splats with a broken attribute change no byte, whichever attribute it is, of discs and of 3D Gaussians") {
    Pairs pairs(context());
    for (const double broken : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        for (const bool gaussians : {false, true}) {
            const Stage stage = gaussians ? makeBrokenGaussians(broken) : makeBrokenAttributes(broken);
            const std::size_t count = stage.scene.size(), broken_splats = 3 + 3 + 4 + 2 + 1 + (gaussians ? 1 : 0);
            for (const Mode mode : {Mode::kShared, Mode::kPredicted}) {
                const auto with = pairs.render(stage, mode), without = pairs.render(keepFirst(stage, count - broken_splats), mode);
                CHECK(with[kLeft].values == without[kLeft].values);
                CHECK(with[kRight].values == without[kRight].values);
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "what dimming leaves nothing of changes no byte") {
    Pairs pairs(context());
    // Points and lines, after the wall and the clutter.
    for (const double flat_axes : {2.0, 3.0}) {
        const Stage stage = asDimmed(makeFlatAxes(flat_axes));
        const std::size_t room = stage.scene.size() - 60;
        for (const Mode mode : {Mode::kShared, Mode::kPredicted}) {
            const auto with = pairs.render(stage, mode), without = pairs.render(keepFirst(stage, room), mode);
            CHECK(with[kLeft].values == without[kLeft].values);
            CHECK(with[kRight].values == without[kRight].values);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "rotations of any length are those of length one") {
    Pairs pairs(context());
    const auto unit = pairs.render(makeQuaternions(1.0), Mode::kShared);
    for (const double length : {std::ldexp(1.0, -60), 0.25, std::ldexp(1.0, 60)}) {  // powers of two round nothing
        CHECK(pairs.render(makeQuaternions(length), Mode::kShared)[kLeft].values == unit[kLeft].values);
    }
}

TEST_CASE_FIXTURE(Gpu, "what misses a bound fails") {
    CaseRunner runner(context());
    Case one = makeCatalogue().front();
    one.moved = {0.0, 1.0, HUGE_VAL, 1.0};
    for (const Bound& bound : {Bound{200.0, 1.0}, Bound{0.0, 1.0, 0.0}}) {
        one.rendered = bound;
        CHECK_FALSE(runner.run(one).passes());
    }
    one.rendered = {0.0, 1.0};
    CHECK(runner.run(one).passes());
    Sequence walk = makeSequences().front();
    walk.frames = 4;
    walk.equal_from = {};
    CHECK(runner.run(walk).passes);
    const auto misses = [&](const std::function<void(Sequence&)>& tighten) {
        Sequence tight = walk;
        tighten(tight);
        return !runner.run(tight).passes;
    };
    CHECK(misses([](Sequence& s) { s.psnr_db = 100.0; }));
    CHECK(misses([](Sequence& s) { s.drift_db = -100.0; }));
    CHECK(misses([](Sequence& s) { s.beyond = 0.0; }));
    CHECK(misses([](Sequence& s) { s.bias = 0.0; }));
    CHECK(misses([](Sequence& s) { s.equal_from = 3; }));
}

}  // namespace stability_test
