// Blocks of whole leaves, so that each leaf has all of a level at once.
#include "engine/levels/scene_levels.h"

#include "engine/files/scene_spill.h"
#include "engine/scene/pick_splats.h"

#include <algorithm>

namespace binosplat {

namespace {

class LevelMaker {
public:
    LevelMaker(const Context& context, const LevelSettings& settings, StreamedWriter& writer)
        : context_(context), settings_(settings), writer_(writer) {}

    // Writes levels `first` (unless that was written) to `last`, of which `scene` is the former. Gives the latter.
    Scene make(const Scene& scene, std::size_t first, std::size_t last, std::vector<Eye> eyes, int steps, const Progress& progress) {
        const auto levels = static_cast<double>(last - first + 1);
        const auto part = [&](std::size_t level, double from, double share) {
            return [=, &progress](double done) {
                if (progress) { progress((static_cast<double>(level - first) + from + share * done) / levels); }
            };
        };
        if (first == 0) { writer_.add(0, scene, {}, 0, part(0, 0.0, 0.5)); }
        if (last == first) { return {}; }
        ThinOut thin_out(context_, scene, std::move(eyes), settings_.near, part(first, 0.5, 0.5), steps);
        Scene thin;
        for (std::size_t level = first + 1; level <= last; ++level) {
            thin = thin_out.keep(std::max<std::uint64_t>(scene.size() >> (level - first), 1), part(level, 0.0, 0.7));
            writer_.add(level, thin, thin_out.splatErrorsOf(thin, part(level, 0.7, 0.2)), first, part(level, 0.9, 0.1));
        }
        return thin;
    }

private:
    const Context& context_;
    const LevelSettings& settings_;
    StreamedWriter& writer_;
};

}  // namespace

void writeSceneLevels(const Context& context, Scene scene, const LevelSettings& settings, StreamedWriter& writer,
                      const Progress& progress) {
    LevelMaker maker(context, settings, writer);
    const std::size_t last = settings.levels - 1;
    writer.cutLeaves(scene.positions);
    if (scene.size() <= settings.block_splats) {
        (void)maker.make(scene, 0, last, settings.eyes, kFitSteps, progress);
        return;
    }
    std::size_t of_blocks = 0;  // the last level that is
    while (of_blocks < last && scene.size() >> of_blocks > settings.block_splats) { ++of_blocks; }
    SceneSpill spill(writer.scratchFolder());
    for (const std::vector<std::uint32_t>& block : writer.blocksOf(scene.positions, settings.block_splats)) {
        spill.add(pickSplats(scene, block));
        if (progress) { progress(0.0); }
    }
    scene = pickSplats(scene, {});
    constexpr double kShareOfBlocks = 0.95;
    for (std::size_t i = 0; i < spill.size(); ++i) {
        const auto part = [&](double share) {
            if (progress) { progress(kShareOfBlocks * (static_cast<double>(i) + share) / static_cast<double>(spill.size())); }
        };
        const Scene block = spill.read(i);
        appendSplats(scene, maker.make(block, 0, of_blocks, eyesOnto(block, settings.eyes, settings.block_eyes, settings.block_side_px),
                                       settings.block_steps, part));
    }
    const auto part = [&](double share) {
        if (progress) { progress(kShareOfBlocks + (1.0 - kShareOfBlocks) * share); }
    };
    (void)maker.make(scene, of_blocks, last, settings.eyes, kFitSteps, part);
}

}  // namespace binosplat
