// First finds out where the splats are and what a sample of them looks like, then reads all of them.
#include "app/convert_levels.h"

#include "app/keep.h"
#include "app/load.h"
#include "app/terminal/progress.h"
#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/files/compressed_ply.h"
#include "engine/files/ply.h"
#include "engine/levels/scene_levels.h"
#include "engine/levels/surroundings.h"
#include "engine/places/standpoint.h"
#include "engine/scene/pick_splats.h"

#include <filesystem>
#include <numeric>
#include <set>

namespace binosplat {

namespace {

constexpr std::uint64_t kFewSplats = 50000;  // fewer are not halved any further
constexpr std::uint32_t kMostLevels = 10;
constexpr std::uint64_t kPartSplats = LevelSettings{}.block_splats;
// A sample that says as well as all splats where someone could stand, and that fills a chunk of the usual
// size.
constexpr std::uint64_t kSampleSplats = 600'000;

std::uint32_t levelsFor(std::uint64_t splats) {
    std::uint32_t levels = 1;
    while (levels < kMostLevels && splats >> levels >= kFewSplats / 2) { ++levels; }
    return levels;
}

// The count of a PLY file that will be read in parts; otherwise 0.
std::uint64_t countInParts(const ConvertOptions& options) {
    std::error_code unreadable;
    if (options.keep || options.load.lod || isBuiltin(options.scene) || isAddress(options.scene) ||
        !std::filesystem::is_regular_file(options.scene, unreadable)) {
        return 0;
    }
    InputFile file(options.scene);
    if (isCompressedPly(file) || !isPly(file)) { return 0; }
    const std::uint64_t count = countPly(file);
    return count > kPartSplats ? count : 0;
}

// Every `step`-th splat.
Scene pickEvery(const Scene& scene, std::uint64_t step) {
    std::vector<std::uint32_t> some;
    for (std::uint64_t i = 0; i < scene.size(); i += step) { some.push_back(static_cast<std::uint32_t>(i)); }
    return pickSplats(scene, some);
}

// Lines about several parts are printed once.
void keepFirst(std::vector<std::string>& lines) {
    std::set<std::string> said;
    std::erase_if(lines, [&](const std::string& line) { return !said.insert(line).second; });
}

struct Survey {
    std::vector<glm::vec3> centres;
    Scene sample;
};

Survey surveyParts(const SceneParts& parts, std::uint64_t count, const Progress& progress) {
    Survey survey;
    survey.centres.reserve(count);
    bool is_first = true;
    parts([&](Scene part) {
        survey.centres.insert(survey.centres.end(), part.positions.begin(), part.positions.end());
        Scene some = pickEvery(part, count / kSampleSplats + 1);
        if (is_first) {
            survey.sample = std::move(some);
        } else {
            appendSplats(survey.sample, some);
        }
        is_first = false;
        progress(static_cast<double>(survey.centres.size()) / static_cast<double>(count));
    });
    return survey;
}

// The part without what lies outside, which goes to `outside`.
Scene takeOutside(const Scene& part, const Surroundings& around, Scene& outside) {
    std::vector<std::uint32_t> near, far;
    for (std::uint32_t i = 0; i < part.size(); ++i) {
        (around.has(part.positions[i]) ? far : near).push_back(i);
    }
    Scene more = pickSplats(part, far);
    if (outside.size() == 0) {
        outside = std::move(more);
    } else {
        appendSplats(outside, more);
    }
    return pickSplats(part, near);
}

}  // namespace

WrittenLevels writeLevels(const ConvertOptions& options, const std::function<Scene()>& load,
                          LoadNotes& notes) {
    StreamedWriteSettings files;
    if (options.chunk_splats != 0) { files.chunk_splats = options.chunk_splats; }
    StreamedWriter writer(options.out, files);
    SceneParts parts;
    Survey survey;
    if (const std::uint64_t count = countInParts(options)) {
        parts = [&](const std::function<void(Scene)>& take) {
            InputFile file(options.scene);
            readPlyParts(file, kPartSplats, notes, [&](Scene part) {
                drawAs(options.load, part, notes);
                if (options.crop) {
                    keepWithin(part, glm::dvec3(*options.crop) - part.origin, options.crop->w);
                }
                take(std::move(part));
            });
            file.requireUnchanged();
        };
        survey = surveyParts(parts, count, ProgressLine("looking at " + options.scene).progress());
    } else {
        survey.sample = load();
        survey.centres = survey.sample.positions;
        parts = [&](const std::function<void(Scene)>& take) { take(survey.sample); };
    }
    WrittenLevels written{survey.centres.size(), {}};
    Scene environment;
    if (const std::optional<Surroundings> around = findSurroundings(survey.centres)) {
        std::erase_if(survey.centres, [&](const glm::vec3& centre) { return around->has(centre); });
        parts = [&environment, around = *around, all = parts](const std::function<void(Scene)>& take) {
            all([&](const Scene& part) { take(takeOutside(part, around, environment)); });
        };
    }
    writer.cutLeaves(survey.centres);
    LevelSettings settings;
    settings.levels = options.levels != 0 ? options.levels : levelsFor(survey.centres.size());
    settings.near = usualNear(survey.sample);
    survey.centres = {};
    ProgressLine line("writing " + options.out.string());
    if (settings.levels > 1) {
        settings.eyes = judgingEyes(options, survey.sample);
        const Context context({.device = options.device});
        writeSceneLevels(context, parts, settings, writer, line.progress());
    } else {
        writeOneLevel(parts, settings, writer, line.progress());
    }
    if (environment.size() > 0) {
        writer.addEnvironment(environment);
        notes.lines.push_back(
            fmt::format("environment: {} splats, far outside of the others", environment.size()));
    }
    writer.finish();
    keepFirst(notes.lines);
    for (std::size_t level = 0; level < writer.counts().size(); ++level) {
        notes.lines.push_back(fmt::format("level {}: {} splats", level, writer.counts()[level]));
    }
    if (survey.sample.size() > files.chunk_splats) {
        std::vector<std::uint32_t> some(files.chunk_splats);
        std::iota(some.begin(), some.end(), 0u);
        survey.sample = pickSplats(survey.sample, some);
    }
    written.sample = std::move(survey.sample);
    return written;
}

}  // namespace binosplat
