// Blocks of whole leaves, so that each leaf gets all of a level at once.
#include "engine/levels/scene_levels.h"

#include "engine/files/scene_spill.h"
#include "engine/scene/pick_splats.h"

#include <algorithm>

namespace binosplat {

namespace {

// A level of more splats than this part of a block's is made in blocks, and thinned out from the finest.
constexpr std::uint64_t kPartOfBlock = 16;

class LevelMaker {
public:
    LevelMaker(const Context& context, const LevelSettings& settings, StreamedWriter& writer)
        : context_(context), settings_(settings), writer_(writer) {}

    struct Judging {
        std::vector<Eye> eyes;
        int steps = kFitSteps;
        std::size_t errors_every = 1;
        gpu::uint side_of_few_px = 0;
    };

    // Writes levels `first` (unless it has been written) to `last`; `scene` is level `first`. Returns level
    // `last`.
    Scene make(const Scene& scene, std::size_t first, std::size_t last, Judging judging,
               const Progress& progress) {
        const auto levels = static_cast<double>(last - first + 1);
        const auto part = [&](std::size_t level, double from, double share) {
            return [=, &progress](double done) {
                if (progress) {
                    progress((static_cast<double>(level - first) + from + share * done) / levels);
                }
            };
        };
        if (first == 0) { writer_.add(0, scene, {}, 0, part(0, 0.0, 0.5)); }
        if (last == first) { return {}; }
        ThinOut thin_out(context_, scene, std::move(judging.eyes), settings_.near, part(first, 0.5, 0.5),
                         judging.steps, judging.side_of_few_px);
        Scene thin;
        for (std::size_t level = first + 1; level <= last; ++level) {
            thin = thin_out.keep(std::max<std::uint64_t>(scene.size() >> (level - first), 1),
                                 part(level, 0.0, 0.7));
            const std::vector<SplatError> errors =
                thin_out.splatErrorsOf(thin, part(level, 0.7, 0.2), judging.errors_every);
            writer_.add(level, thin, errors, first, part(level, 0.9, 0.1));
        }
        return thin;
    }

private:
    const Context& context_;
    const LevelSettings& settings_;
    StreamedWriter& writer_;
};

// Returns the number of splats.
std::uint64_t spillBlocks(const SceneParts& parts, const StreamedWriter::Blocks& blocks,
                          const StreamedWriter& writer, SceneSpill& spill, const Progress& progress) {
    std::uint64_t splats = 0;
    parts([&](Scene part) {
        if (progress) { progress(0.0); }
        splats += part.size();
        const auto sorted = writer.sortInto(blocks, part.positions);
        for (std::size_t block = 0; block < sorted.size(); ++block) {
            if (!sorted[block].empty()) { spill.add(block, pickSplats(part, sorted[block])); }
        }
    });
    return splats;
}

}  // namespace

void writeOneLevel(const SceneParts& parts, const LevelSettings& settings, StreamedWriter& writer,
                   const Progress& progress) {
    SceneSpill spill(writer.scratchFolder());
    const StreamedWriter::Blocks blocks = writer.cutBlocks(settings.block_splats);
    (void)spillBlocks(parts, blocks, writer, spill, progress);
    for (std::size_t i = 0; i < blocks.count; ++i) { writer.add(0, spill.read(i), {}, 0, progress); }
}

void writeSceneLevels(const Context& context, const SceneParts& parts, const LevelSettings& settings,
                      StreamedWriter& writer, const Progress& progress) {
    LevelMaker maker(context, settings, writer);
    const std::size_t last = settings.levels - 1;
    const StreamedWriter::Blocks blocks = writer.cutBlocks(settings.block_splats);
    SceneSpill spill(writer.scratchFolder());
    const std::uint64_t splats = spillBlocks(parts, blocks, writer, spill, progress);
    Scene scene;
    if (blocks.count == 1) {
        (void)maker.make(spill.read(0), 0, last, {settings.eyes}, progress);
        return;
    }
    std::size_t of_blocks = 0;  // the last level made in blocks
    while (of_blocks < last && splats >> of_blocks > settings.block_splats / kPartOfBlock) { ++of_blocks; }
    constexpr double kShareOfBlocks = 0.95;
    for (std::size_t i = 0; i < blocks.count; ++i) {
        const auto done = [&](double share) {
            if (progress) {
                progress(kShareOfBlocks * (static_cast<double>(i) + share) /
                         static_cast<double>(blocks.count));
            }
        };
        const Scene block = spill.read(i);
        std::vector<Eye> eyes = eyesOnto(block, settings.eyes, settings.block_eyes, settings.block_side_px);
        const Scene thin = maker.make(block, 0, of_blocks,
                                      {std::move(eyes), settings.block_steps, settings.block_errors_every,
                                       settings.block_side_of_few_px},
                                      done);
        if (i == 0) { scene = pickSplats(thin, {}); }
        appendSplats(scene, thin);
    }
    const auto done = [&](double share) {
        if (progress) { progress(kShareOfBlocks + (1.0 - kShareOfBlocks) * share); }
    };
    (void)maker.make(scene, of_blocks, last, {settings.eyes}, done);
}

}  // namespace binosplat
