// All chunks of a level are judged by their meta.json, then decoded one after the other.
#include "engine/scene/streamed_sog.h"

#include "engine/error.h"
#include "engine/scene/lod_meta.h"
#include "engine/scene/scene_builder.h"
#include "engine/scene/sog_splats.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

// A hundred thousand leaves of five levels.
constexpr std::uint64_t kMaxLodMetaBytes = std::uint64_t{1} << 25;

// A chunk and which of its splats are wanted.
struct Chunk {
    SogSplats splats;
    std::vector<SplatRange> ranges;
};

struct Level {
    std::size_t index = 0;
    std::vector<Chunk> chunks;  // the environment last
    std::uint64_t splats = 0;
    int sh_degree = 0;        // the highest of the chunks'
    const char* reason = "";  // why not the finest, if nobody asked for it
};

// lod-meta.json, and where it lies.
struct Streamed {
    fs::path folder;
    std::string place;
    LodMeta meta;
    SceneFiles* elsewhere = nullptr;  // not in `folder`
};

Streamed readLodMeta(const fs::path& folder, const std::string& name) {
    const std::unique_ptr<SogFiles> files = openSogFolder(folder.string());
    const std::string place = files->place(name);
    return {folder, place, parseLodMeta(files->read(name, kMaxLodMetaBytes), place), nullptr};
}

// Opens chunks of one scene: each lies within its folder, whatever links lead to, and is opened once.
class ChunkOpener {
public:
    explicit ChunkOpener(const Streamed& scene) : scene_(scene) {}

    SogSplats open(const std::string& path, const std::string& key) {
        if (scene_.elsewhere != nullptr) { return openElsewhere(path); }
        const std::string place = scene_.place + ": " + key;
        const fs::path file = scene_.folder / path;
        std::error_code error;
        check(fs::is_regular_file(file, error), "{}: {} is not there, expected a chunk of the scene", place, file.string());
        const fs::path folder = fs::canonical(scene_.folder, error), real = fs::canonical(file, error);
        check(!error, "{}: {} cannot be read: {}", place, file.string(), error.message());
        check(std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first == folder.end(),
              "{}: {} is a link to {}, expected a place within {}", place, file.string(), real.string(), folder.string());
        check(opened_.insert(real).second, "{}: {} is a link to a chunk that is named already, expected each chunk once", place,
              file.string());
        const bool is_bundle = file.extension() == ".sog";
        SogSplats splats(is_bundle ? openSogBundle(InputFile(file.string())) : openSogFolder(file.parent_path().string()));
        splats.requirePlausibleCount();
        return splats;
    }

private:
    // Its pictures are asked for when the level is chosen.
    SogSplats openElsewhere(const std::string& path) const {
        SceneFiles& files = *scene_.elsewhere;
        return SogSplats(fs::path(path).extension() == ".sog" ? openSogBundle(files, path) : openSogFolder(files, path));
    }

    const Streamed& scene_;
    std::set<fs::path> opened_;
};

Level openLevel(const Streamed& scene, std::size_t index) {
    Level level;
    level.index = index;
    const auto add = [&](SogSplats splats, std::vector<SplatRange> ranges) {
        level.sh_degree = std::max(level.sh_degree, splats.shDegree());
        for (const SplatRange range : ranges) { level.splats += range.count; }
        level.chunks.push_back({std::move(splats), std::move(ranges)});
    };
    if (scene.elsewhere != nullptr) {
        std::vector<std::string> names;
        for (const auto& [file, ranges] : scene.meta.levels[index].chunks) { names.push_back(scene.meta.files[file]); }
        if (!scene.meta.environment.empty()) { names.push_back(scene.meta.environment); }
        scene.elsewhere->expect(names);
    }
    ChunkOpener opener(scene);
    for (const auto& [file, ranges] : scene.meta.levels[index].chunks) {
        const std::string& path = scene.meta.files[file];
        SogSplats splats = opener.open(path, fmt::format("filenames[{}]", file));
        const SplatRange last = ranges.back();
        check(last.first + last.count <= splats.count(), "{}: tree: a leaf names splat {} of filenames[{}] ({}), which has {}", scene.place,
              last.first + last.count - 1, file, path, splats.count());
        add(std::move(splats), ranges);
    }
    if (!scene.meta.environment.empty()) {
        SogSplats splats = opener.open(scene.meta.environment, "environment");
        const SplatRange all{0, splats.count()};
        add(std::move(splats), {all});
    }
    return level;
}

Level chooseLevel(const Streamed& scene, const LevelChoice& choice) {
    const std::size_t levels = scene.meta.levels.size();
    if (choice.level) {
        check(*choice.level < levels, "{}: lod is {}, expected one of the scene's levels of detail, 0 (the finest) to {}", scene.place,
              *choice.level, levels - 1);
        return openLevel(scene, *choice.level);
    }
    for (std::size_t index = 0;; ++index) {
        // Not even without harmonics: nothing of it need be fetched.
        const bool is_hopeless =
            scene.elsewhere != nullptr && index + 1 < levels && choice.fits && !choice.fits(scene.meta.levels[index].splats, 0);
        if (is_hopeless) { continue; }
        Level level = openLevel(scene, index);
        const bool fits = !choice.fits || choice.fits(level.splats, level.sh_degree);
        level.reason = !fits ? ", as none fits the memory limit" : index > 0 ? ", the finest that fits the memory limit" : "";
        if (fits || index + 1 == levels) { return level; }
    }
}

void noteLevel(const std::string& source, const Streamed& scene, const Level& level, LoadNotes& notes) {
    const LodMeta& meta = scene.meta;
    for (const LodLevel& each : meta.levels) { notes.level_splats.push_back(each.splats); }
    notes.level = static_cast<std::uint32_t>(level.index);
    notes.environment_splats = level.splats - meta.levels[level.index].splats;
    notes.lines.push_back(
        fmt::format("{}: level of detail {} of 0 (the finest) to {}{}", source, level.index, meta.levels.size() - 1, level.reason));
    if (const std::uint64_t without = meta.leaves_without[level.index]; without > 0) {
        notes.lines.back() += fmt::format("; {} of {} leaves have no splats at this level", without, meta.leaves);
    }
}

Scene readStreamedSog(const std::string& source, const Streamed& scene, const LevelChoice& choice, LoadNotes& notes,
                      const Progress& progress) {
    if (progress) { progress(0.0); }
    Level level = chooseLevel(scene, choice);
    if (scene.elsewhere != nullptr) {
        for (const Chunk& chunk : level.chunks) { chunk.splats.expect(); }
        for (const Chunk& chunk : level.chunks) { chunk.splats.requirePlausibleCount(); }
    }
    // One builder for all: room for every splat once, and of the chunks no more than one chunk's pictures at a time.
    SceneBuilder builder(source, level.splats, level.sh_degree, true);
    std::uint64_t done = 0;
    for (Chunk& chunk : level.chunks) {
        const SogPictures pictures = chunk.splats.decode();
        for (const SplatRange range : chunk.ranges) {
            const auto show = [&](double share) {
                progress((static_cast<double>(done) + share * static_cast<double>(range.count)) / static_cast<double>(level.splats));
            };
            chunk.splats.append(pictures, range, level.sh_degree, builder, progress ? Progress(show) : Progress());
            done += range.count;
        }
    }
    if (progress) { progress(1.0); }
    Scene whole = builder.finish(notes);
    whole.antialiased = std::ranges::any_of(level.chunks, [](const Chunk& chunk) { return chunk.splats.antialiased(); });
    if (!level.chunks.empty() && std::ranges::all_of(level.chunks, [](const Chunk& chunk) { return chunk.splats.discs(); })) {
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
    const std::size_t first = start.find_first_not_of(" \t\r\n");
    return first != std::string_view::npos && start[first] == '{' && start.find("\"lodLevels\"") != std::string_view::npos;
}

Scene readStreamedSogFolder(const std::string& folder, const LevelChoice& choice, LoadNotes& notes, const Progress& progress) {
    requireSogDecoder(folder);
    return readStreamedSog(folder, readLodMeta(folder, "lod-meta.json"), choice, notes, progress);
}

Scene readStreamedSogFile(InputFile& file, const LevelChoice& choice, LoadNotes& notes, const Progress& progress) {
    requireSogDecoder(file.name());
    if (file.others() != nullptr) {
        const Streamed scene{{}, file.name(), parseLodMeta(file.readWhole(kMaxLodMetaBytes), file.name()), file.others()};
        return readStreamedSog(file.name(), scene, choice, notes, progress);
    }
    const fs::path path(file.name());
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    return readStreamedSog(file.name(), readLodMeta(folder, path.filename().string()), choice, notes, progress);
}

}  // namespace binosplat
