// loadScene: finds the reader for a source.
#include "engine/files/load_scene.h"

#include "engine/builtin/procedural.h"
#include "engine/error.h"
#include "engine/files/compressed_ply.h"
#include "engine/files/gltf.h"
#include "engine/files/input_file.h"
#include "engine/files/ksplat.h"
#include "engine/files/not_a_scene.h"
#include "engine/files/packed_scene.h"
#include "engine/files/ply.h"
#include "engine/files/scene_folder.h"
#include "engine/files/scene_series.h"
#include "engine/files/sog.h"
#include "engine/files/splat_file.h"
#include "engine/files/spz.h"
#include "engine/files/streamed_sog.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <new>
#include <system_error>

namespace binosplat {

namespace {

// What the user chose: a directory, or a file (then open, with nothing read yet).
struct Source {
    std::string path;
    std::unique_ptr<InputFile> file;  // null for a directory
    const LevelChoice& level;
};

// A format is recognized by its content, never by its name; the first that matches reads. A new format is one
// more file and one more line below.
struct SceneFormat {
    const char* name;
    bool (*matches)(Source& source);
    Scene (*read)(Source& source, LoadNotes& notes, const Progress& progress);
    bool has_levels = false;
};
constexpr std::array<SceneFormat, 10> kSceneFormats{{
    {"PlayCanvas compressed PLY", [](Source& source) { return source.file && isCompressedPly(*source.file); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readCompressedPly(*source.file, notes, progress);
     }},
    {"PLY (2DGS or 3DGS)", [](Source& source) { return source.file && isPly(*source.file); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readPly(*source.file, notes, progress);
     }},
    {"streamed SOG (directory)",
     [](Source& source) { return !source.file && isStreamedSogFolder(source.path); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readStreamedSogFolder(source.path, source.level, notes, progress);
     },
     true},
    {"streamed SOG (lod-meta.json)",
     [](Source& source) { return source.file && isStreamedSogFile(*source.file); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readStreamedSogFile(*source.file, source.level, notes, progress);
     },
     true},
    {"SOG (directory)", [](Source& source) { return !source.file && isSogFolder(source.path); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readSogFolder(source.path, notes, progress);
     }},
    {"SOG (.sog)", [](Source& source) { return source.file && isSogFile(*source.file); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readSogFile(*source.file, notes, progress);
     }},
    {"glTF with KHR_gaussian_splatting (.gltf, .glb)",
     [](Source& source) { return source.file && isGltf(*source.file); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readGltf(*source.file, notes, progress);
     }},
    {"SPZ", [](Source& source) { return source.file && isSpz(*source.file); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readSpz(*source.file, notes, progress);
     }},
    {".ksplat", [](Source& source) { return source.file && isKsplat(*source.file); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readKsplat(*source.file, notes, progress);
     }},
    // A guess, so it comes last.
    {".splat", [](Source& source) { return source.file && isSplatFile(*source.file); },
     [](Source& source, LoadNotes& notes, const Progress& progress) {
         return readSplatFile(*source.file, notes, progress);
     }},
}};

// If a file changes meanwhile, that is the reason for anything else that is wrong with it.
Scene readWhole(const SceneFormat& format, Source& source, LoadNotes& notes, const Progress& progress) {
    const auto requireUnchanged = [&] {
        if (source.file) { source.file->requireUnchanged(); }
    };
    try {
        Scene scene = format.read(source, notes, progress);
        requireUnchanged();
        return scene;
    } catch (const Error&) {
        requireUnchanged();
        throw;
    }
}

void requireNoLevel(const std::string& source, const char* kind, const LevelChoice& choice) {
    check(
        !choice.level,
        "{}: lod is {}, but a scene of this kind ({}) has no levels of detail, expected a streamed SOG scene",
        source, choice.level.value_or(0), kind);
}

const SceneFormat* findFormat(Source& source) {
    const auto* found = std::ranges::find_if(
        kSceneFormats, [&](const SceneFormat& format) { return format.matches(source); });
    return found == kSceneFormats.end() ? nullptr : found;
}

// For a folder that is not a scene's.
[[noreturn]] void refuseFolder(const Source& folder) {
    std::error_code error;
    static_cast<void>(std::filesystem::directory_iterator(folder.path, error));
    check(!error, "{}: cannot be read: {}", folder.path, error.message());
    const std::string other = describeOtherFolder(folder.path);
    check(other.empty(), "{}: {}", folder.path, other);
    fail(
        "{}: is a directory, expected one with lod-meta.json (streamed SOG), meta.json (SOG), "
        "point_cloud/iteration_N/point_cloud.ply (a training's output), numbered files of one format (a "
        "moving scene) or one scene file",
        folder.path);
}

// Unpacking's share of loading.
constexpr double kUnpackingShare = 0.4;

Scene loadFrom(Source& source, LoadNotes& notes, const Progress& progress) {
    if (source.file && isPacked(*source.file)) {
        const auto part = [&](double first, double share) {
            return progress ? Progress([&, first, share](double done) { progress(first + share * done); })
                            : Progress();
        };
        Source unpacked{source.path, unpackScene(std::move(source.file), part(0.0, kUnpackingShare)),
                        source.level};
        check(!isPacked(*unpacked.file), "{}: is packed twice, expected once", source.path);
        return loadFrom(unpacked, notes, part(kUnpackingShare, 1.0 - kUnpackingShare));
    }
    if (const SceneFormat* format = findFormat(source)) {
        if (!format->has_levels) { requireNoLevel(source.path, format->name, source.level); }
        Scene scene = readWhole(*format, source, notes, progress);
        notes.format = format->name;  // now that the reader has written its own
        return scene;
    }
    if (source.file == nullptr) {
        const auto loadOne = [&](const std::string& path, const std::string& of) {
            Source one{path, std::make_unique<InputFile>(path), source.level};
            Scene scene = loadFrom(one, notes, progress);
            notes.lines.push_back(fmt::format("{}: {}, of which {} was loaded", source.path, of, path));
            return scene;
        };
        if (const std::optional<TrainingOutput> training = findTrainingOutput(source.path)) {
            Scene scene = loadOne(training->scene, "a training's output");
            if (!training->older.empty()) {
                notes.lines.back() += fmt::format("; older ones: {}", fmt::join(training->older, ", "));
            }
            return scene;
        }
        if (!isMovingScene(source.path)) {
            const std::optional<std::string> only = findOnlyScene(source.path);
            if (!only) { refuseFolder(source); }
            Scene scene = loadOne(*only, "a folder");
            notes.lines.back() += ", its only scene";
            return scene;
        }
        const SceneSeries series(source.path);
        return loadOne(series.nameOf(0), fmt::format("a moving scene of {} frames", series.size()));
    }
    check(source.file->sizeBytes() > 0, "{}: is empty, expected a scene file", source.path);
    const std::string other = describeOther(source.file->peek(std::size_t{1} << 16), source.path);
    check(other.empty(), "{}: {}", source.path, other);
    fail(
        "{}: not a scene file of a known format, expected PLY, SOG, SPZ, glTF, .ksplat, .splat or "
        "builtin:NAME",
        source.path);
}

}  // namespace

std::string formatOfFile(const std::string& path) {
    constexpr std::uint64_t kFirstBytes = 65536;  // formats look at no more than this before one is chosen
    const LevelChoice no_level;
    Source source{path, openUnpacked(path, {.first_bytes = kFirstBytes}), no_level};
    const SceneFormat* const format = findFormat(source);
    return format == nullptr ? "" : format->name;
}

Scene loadScene(const std::string& source, std::uint64_t builtin_splats, LoadNotes* notes,
                const Progress& progress, const LevelChoice& level) {
    LoadNotes ignored;
    LoadNotes& met = notes != nullptr ? *notes : ignored;
    met = {};
    std::error_code unreadable;  // InputFile says why
    try {
        if (isBuiltin(source)) {
            requireNoLevel(source, "built-in", level);
            Scene scene = makeBuiltin(source, builtin_splats, progress);
            met.splats_in_file = scene.size();
            met.sh_degree_in_file = scene.sh_degree;
            met.axes = "x right, y down, z front; right-handed";
            met.colour_space = "display-encoded (sRGB)";
            return scene;
        }
        Source opened{
            source,
            std::filesystem::is_directory(source, unreadable) ? nullptr : std::make_unique<InputFile>(source),
            level};
        return loadFrom(opened, met, progress);
    } catch (const std::bad_alloc&) { fail("{}: needs more memory than this machine gives", source); }
}

Scene loadScene(std::unique_ptr<InputFile> file, LoadNotes& notes, const Progress& progress,
                const LevelChoice& level) {
    notes = {};
    const std::string name = file->name();
    try {
        Source opened{name, std::move(file), level};
        return loadFrom(opened, notes, progress);
    } catch (const std::bad_alloc&) { fail("{}: needs more memory than this machine gives", name); }
}

}  // namespace binosplat
