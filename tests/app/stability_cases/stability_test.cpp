// Facts about extreme cases: the catalogue and the sequences of `binosplat stability`, but the largest.
#include "app/stability_cases/extreme_scenes.h"
#include "app/stability_cases/run_case.h"
#include "engine/scene/pick_splats.h"
#include "tests/engine/frame/frame_runs.h"

SUITE(stability) {

using namespace binosplat::stability;

PairOfValues render(const Context& context, const Stage& stage, Mode mode) {
    FrameSettings settings = makeSettings(mode);
    settings.near = stage.near;
    KeptFrame frame(context, stage.scene);
    return renderPair(frame, stage.eyes, settings);
}

// Nothing is seen of the splats after the first `count`.
void checkSeesOnlyTheFirst(const Context& context, const Stage& stage, std::size_t count) {
    std::vector<std::uint32_t> splats(count);
    std::iota(splats.begin(), splats.end(), 0u);
    Stage first = stage;
    first.scene = pickSplats(stage.scene, splats);
    for (const Mode mode : {Mode::kShared, Mode::kPredicted}) {
        CHECK(render(context, stage, mode) == render(context, first, mode));
    }
}

TEST_CASE_FIXTURE(Gpu, "every case is finite, repeats and keeps to its bounds, in every mode") {
    std::set<std::string> names;
    CaseRunner runner(context());
    for (const Case& one : makeCatalogue()) {
        CHECK(names.insert(one.name()).second);
        // Anything less would not be a bound.
        CHECK(std::min(one.rendered.psnr_db, one.moved.psnr_db) > 10.0);
        if (one.large) { continue; }
        const CaseScore score = runner.run(one);
        CHECK(score.pictures.size() == 11);
        for (const PictureScore& picture : score.pictures) {
            INFO(one.name(), ", ", nameOf(picture.mode), ", ", picture.eye, ": ", picture.psnr_db, " dB");
            CHECK(these(picture.not_finite, picture.repeats, picture.passes) == these(0, true, true));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "an eye on a path sees no more change at a time than the twin's") {
    CaseRunner runner(context());
    for (const Path& path : makePaths()) {
        const PathScore score = runner.run(path);
        CAPTURE(path.name);
        CHECK(these(score.not_finite, score.passes) == these(0, true));
        CHECK(score.psnr_db >= 50.0);
    }
}

TEST_CASE_FIXTURE(Gpu, "pictures made from the ones before keep to their bounds, however long") {
    CaseRunner runner(context());
    for (const Sequence& sequence : makeSequences()) {
        const SequenceScore score = runner.run(sequence);
        INFO(sequence.title() << ": worst " << score.psnr_db << " dB");
        CHECK(these(score.not_finite, score.repeats, score.passes) == these(0, true, true));
        CHECK(score.frames.size() >= 20);
    }
}

TEST_CASE_FIXTURE(Gpu, "broken splats, and those of which dimming leaves nothing, change no byte") {
    for (const double broken : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
        for (const bool gaussians : {false, true}) {
            const Stage stage = gaussians ? makeBrokenGaussians(broken) : makeBrokenAttributes(broken);
            const std::size_t broken_splats = 3 + 3 + 4 + 2 + 1 + (gaussians ? 1 : 0);
            checkSeesOnlyTheFirst(context(), stage, stage.scene.size() - broken_splats);
        }
    }
    // Points and lines, behind the wall and the clutter.
    for (const double flat_axes : {2.0, 3.0}) {
        const Stage stage = asDimmed(makeFlatAxes(flat_axes));
        checkSeesOnlyTheFirst(context(), stage, stage.scene.size() - 60);
    }
}

TEST_CASE_FIXTURE(Gpu, "rotations of any length are those of length one" * nightly()) {
    const auto unit = render(context(), makeQuaternions(1.0), Mode::kShared);
    for (const double length : {0x1p-60, 0.25, 0x1p60}) {  // powers of two cause no rounding
        CHECK(render(context(), makeQuaternions(length), Mode::kShared) == unit);
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
    std::array<Sequence, 5> tight;
    tight.fill(walk);
    tight[0].psnr_db = 100.0;
    tight[1].drift_db = -100.0;
    tight[2].beyond = 0.0;
    tight[3].bias = 0.0;
    tight[4].equal_from = 3;
    for (const Sequence& one_too_tight : tight) { CHECK_FALSE(runner.run(one_too_tight).passes); }
}

}  // SUITE(stability)
