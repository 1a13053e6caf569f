// All chunks of a level are judged by their meta.json, then decoded one after the other.
#include "engine/files/streamed_sog.h"

#include "engine/error.h"
#include "engine/files/json_node.h"
#include "engine/files/load_scene.h"
#include "engine/files/scene_builder.h"
#include "engine/files/sog_splats.h"
#include "engine/files/streamed_chunks.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

// A chunk, and which of its splats are wanted.
struct Chunk {
    SogSplats splats;
    std::vector<SplatRange> ranges;
};

struct ReadLevel {
    std::size_t index = 0;
    std::vector<Chunk> chunks;  // the environment last
    std::uint64_t splats = 0;
    int sh_degree = 0;        // the highest of the chunks'
    const char* reason = "";  // why it is not the finest, if nobody asked for it
};

ReadLevel openLevel(StreamedChunks& scene, std::size_t index) {
    const LodMeta& meta = scene.meta();
    ReadLevel level;
    level.index = index;
    const auto add = [&](SogSplats splats, std::vector<SplatRange> ranges) {
        level.sh_degree = std::max(level.sh_degree, splats.shDegree());
        for (const SplatRange range : ranges) { level.splats += range.count; }
        level.chunks.push_back({std::move(splats), std::move(ranges)});
    };
    std::vector<std::size_t> files;
    for (const auto& [file, ranges] : meta.levels[index].chunks) { files.push_back(file); }
    if (scene.hasEnvironment()) { files.push_back(scene.environmentIndex()); }
    scene.expect(files);
    for (const auto& [file, ranges] : meta.levels[index].chunks) {
        SogSplats splats = scene.open(file);
        scene.requireRange(file, ranges.back(), splats);
        add(std::move(splats), ranges);
    }
    if (std::optional<SogSplats> environment = scene.openEnvironment()) {
        const SplatRange all{0, environment->count()};
        add(std::move(*environment), {all});
    }
    return level;
}

ReadLevel chooseLevel(StreamedChunks& scene, const LevelChoice& choice) {
    const std::size_t levels = scene.meta().levels.size();
    if (choice.level) {
        check(*choice.level < levels,
              "{}: lod is {}, expected one of the scene's levels of detail, 0 (the finest) to {}",
              scene.place(), *choice.level, levels - 1);
        return openLevel(scene, *choice.level);
    }
    for (std::size_t index = 0;; ++index) {
        // It does not fit even without harmonics, so none of it need be fetched.
        const bool is_hopeless = scene.areElsewhere() && index + 1 < levels && choice.fits &&
                                 !choice.fits(scene.meta().levels[index].splats, 0);
        if (is_hopeless) { continue; }
        ReadLevel level = openLevel(scene, index);
        const bool fits = !choice.fits || choice.fits(level.splats, level.sh_degree);
        level.reason = !fits       ? ", as none fits the memory limit"
                       : index > 0 ? ", the finest that fits the memory limit"
                                   : "";
        if (fits || index + 1 == levels) { return level; }
    }
}

void noteLevel(const std::string& source, const StreamedChunks& scene, const ReadLevel& level,
               LoadNotes& notes) {
    const LodMeta& meta = scene.meta();
    for (const LodLevel& each : meta.levels) { notes.level_splats.push_back(each.splats); }
    notes.level = static_cast<std::uint32_t>(level.index);
    notes.environment_splats = level.splats - meta.levels[level.index].splats;
    notes.lines.push_back(fmt::format("{}: level of detail {} of 0 (the finest) to {}{}", source, level.index,
                                      meta.levels.size() - 1, level.reason));
    if (const std::uint64_t without = meta.leaves_without[level.index]; without > 0) {
        notes.lines.back() +=
            fmt::format("; {} of {} leaves have no splats at this level", without, meta.leaves);
        const std::uint64_t coarser = meta.leaves_coarser[level.index];
        if (coarser > 0) { notes.lines.back() += fmt::format(", {} of them show a coarser one", coarser); }
    }
    if (!scene.missingEnvironment().empty()) {
        notes.lines.push_back(
            fmt::format("{}: is shown without its environment: {}", source, scene.missingEnvironment()));
    }
}

Scene readStreamedSog(const std::string& source, StreamedChunks scene, const LevelChoice& choice,
                      LoadNotes& notes, const Progress& progress) {
    if (progress) { progress(0.0); }
    ReadLevel level = chooseLevel(scene, choice);
    if (scene.areElsewhere()) {
        for (const Chunk& chunk : level.chunks) { chunk.splats.expect(); }
        for (const Chunk& chunk : level.chunks) { chunk.splats.requirePlausibleCount(); }
    }
    // One builder for all: memory for every splat once, and for the pictures of one chunk at a time.
    SceneBuilder builder(source, level.splats, level.sh_degree, true);
    std::uint64_t done = 0;
    for (Chunk& chunk : level.chunks) {
        const SogPictures pictures = chunk.splats.decode();
        for (const SplatRange range : chunk.ranges) {
            const auto show = [&](double share) {
                progress((static_cast<double>(done) + share * static_cast<double>(range.count)) /
                         static_cast<double>(level.splats));
            };
            chunk.splats.append(pictures, range, level.sh_degree, builder,
                                progress ? Progress(show) : Progress());
            done += range.count;
        }
    }
    if (progress) { progress(1.0); }
    Scene whole = builder.finish(notes);
    whole.antialiased =
        std::ranges::any_of(level.chunks, [](const Chunk& chunk) { return chunk.splats.antialiased(); });
    if (!level.chunks.empty() &&
        std::ranges::all_of(level.chunks, [](const Chunk& chunk) { return chunk.splats.discs(); })) {
        takeAsDiscs(whole, notes);
    }
    noteLevel(source, scene, level, notes);
    return whole;
}

}  // namespace

bool isStreamedSogFolder(const std::string& folder) {
    std::error_code unreadable;
    return fs::is_regular_file(fs::path(folder) / "lod-meta.json", unreadable);
}

bool isStreamedSogFile(InputFile& file) {
    if (fs::path(file.name()).filename() == "lod-meta.json") { return true; }
    const std::string_view start = file.peek(4096);
    return startsObject(start) && start.find("\"lodLevels\"") != std::string_view::npos;
}

Scene readStreamedSogFolder(const std::string& folder, const LevelChoice& choice, LoadNotes& notes,
                            const Progress& progress) {
    requireSogDecoder(folder);
    return readStreamedSog(folder, StreamedChunks(folder), choice, notes, progress);
}

Scene readStreamedSogFile(InputFile& file, const LevelChoice& choice, LoadNotes& notes,
                          const Progress& progress) {
    requireSogDecoder(file.name());
    return readStreamedSog(file.name(), StreamedChunks(file), choice, notes, progress);
}

}  // namespace binosplat
