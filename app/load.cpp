// Passes options on to the loader.
#include "app/load.h"

#include "app/terminal/interrupt.h"
#include "app/terminal/progress.h"
#include "engine/address.h"
#include "engine/error.h"
#include "engine/files/load_scene.h"
#include "engine/files/scene_series.h"
#include "engine/files/web/web_files.h"
#include "engine/gpu/gpu_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

namespace binosplat {

namespace {

// A picture needs what it shows, and hardly anything else.
constexpr double kPictureLookAhead = 0.1;

// The most device memory for the finest level; frames need the rest.
std::uint64_t memoryForScene(const Context& context, std::uint64_t memory_limit_mib) {
    const std::uint64_t bytes = context.deviceMemoryBytes() / 4 * 3;
    return memory_limit_mib > 0 ? std::min(bytes, memory_limit_mib << 20) : bytes;
}

bool fitsWhole(const Context& context, ChunkSource& source, const RunOptions& run) {
    const LodRange* finest = nullptr;
    for (const LodLeaf& leaf : source.leaves()) {
        if (finest == nullptr || leaf.levels.front().level < finest->level) { finest = &leaf.levels.front(); }
    }
    if (finest == nullptr) { return true; }
    const int sh_degree = std::min(source.open(finest->file).shDegree(),
                                   static_cast<int>(run.load.sh_degree.value_or(kMaxShDegree)));
    const std::uint64_t splats = source.meta().levels.front().splats + source.environmentSplats();
    return splats <=
           memoryForScene(context, run.memory_limit_mib) / deviceBytesPerSplat(sh_degree, !run.load.flatten);
}

// The coarsest level that can be loaded and has splats.
Scene loadCoarsest(const std::string& source, const RunOptions& run, std::size_t levels, LoadNotes& notes,
                   const Progress& progress) {
    LoadOptions load = run.load;
    for (load.lod = static_cast<std::uint32_t>(levels - 1);; --*load.lod) {
        try {
            Scene scene = loadAsAsked(source, load, 0, notes, progress);
            if (scene.size() > 0 || load.lod == 0u) { return scene; }
        } catch (const Error&) {
            if (load.lod == 0u) { throw; }
        }
    }
}

OpenedScene openMoving(const Context& context, const std::string& source, const RunOptions& run,
                       const Progress& progress) {
    MovingSettings settings;
    settings.rate_hz = run.load.scene_rate_hz;
    settings.blend = run.load.scene_blend;
    settings.memory_bytes = run.memory_limit_mib << 20;
    settings.threads = std::clamp(static_cast<int>(std::thread::hardware_concurrency()) / 2, 1, 4);
    settings.draw_as = [load = run.load](Scene& scene, LoadNotes& notes) { drawAs(load, scene, notes); };
    auto moving = std::make_unique<MovingScene>(context, SceneSeries(source), std::move(settings), progress);
    OpenedScene scene;
    scene.moving = moving.get();
    scene.sample = moving->takeFirst();
    scene.sample.name = source;
    scene.notes = moving->notes();
    scene.notes.lines.push_back(fmt::format("{}: a moving scene of {} frames, {} a second", source,
                                            moving->series().size(), run.load.scene_rate_hz));
    scene.live = std::move(moving);
    return scene;
}

}  // namespace

LevelChoice levelChoice(const LoadOptions& options, std::uint64_t memory_limit_mib) {
    if (memory_limit_mib == 0) { return {options.lod, {}}; }
    return {
        options.lod, [limit_bytes = memory_limit_mib << 20, options](std::uint64_t splats, int sh_degree) {
            const int kept = std::min(sh_degree, static_cast<int>(options.sh_degree.value_or(kMaxShDegree)));
            return splats <= limit_bytes / deviceBytesPerSplat(kept, !options.flatten);
        }};
}

void drawAs(const LoadOptions& options, Scene& scene, LoadNotes& notes) {
    if (options.sh_degree) { limitShDegree(scene, static_cast<int>(*options.sh_degree), notes); }
    if (options.flatten) { flatten(scene, notes); }
    if (options.antialiased) { scene.antialiased = scene.isGaussian3d(); }
}

Scene loadAsAsked(const std::string& source, const LoadOptions& options, std::uint64_t memory_limit_mib,
                  LoadNotes& notes, const Progress& progress, std::uint64_t builtin_splats) {
    const WebSettings web{webCacheFolder(), options.cache_limit_mib << 20, {}};
    Scene scene = loadSceneFromAnywhere(source, builtin_splats, notes, progress,
                                        levelChoice(options, memory_limit_mib), web);
    drawAs(options, scene, notes);
    return scene;
}

Scene loadWithProgress(const std::string& source, const LoadOptions& options, LoadNotes& notes,
                       std::uint64_t memory_limit_mib) {
    return loadAsAsked(source, options, memory_limit_mib, notes,
                       ProgressLine("loading " + source).progress());
}

bool mayLive(const std::string& source, const LoadOptions& options) {
    check(options.splat_budget == 0 || !options.lod,
          "{}: lod {} asks for one level, splat-budget for all of them: expected one of the two", source,
          options.lod.value_or(0));
    if (options.lod) { return false; }
    const bool is_streamed = isStreamedScene(source);
    check(options.splat_budget == 0 || is_streamed,
          "{}: has no levels of detail, expected a streamed SOG scene (lod-meta.json) for --splat-budget to "
          "choose among",
          source);
    return is_streamed || isMovingScene(source);
}

std::optional<OpenedScene> openLive(const Context& context, const std::string& source, const RunOptions& run,
                                    StreamFor purpose, const Progress& progress) {
    if (!isStreamedScene(source)) { return openMoving(context, source, run, progress); }
    const LoadOptions& load = run.load;
    const bool whole_if_it_fits = purpose == StreamFor::kPictures && load.splat_budget == 0;
    // Nothing is fetched merely to find out whether it fits.
    if (whole_if_it_fits && isAddress(source) && run.memory_limit_mib == 0) { return std::nullopt; }
    WebSettings web{webCacheFolder(), load.cache_limit_mib << 20, {}};
    web.fetch.attempts = 2;  // the loader retries by itself
    auto chunks = std::make_unique<ChunkSource>(source, web, progress);
    if (whole_if_it_fits && fitsWhole(context, *chunks, run)) { return std::nullopt; }
    OpenedScene scene;
    scene.sample = loadCoarsest(source, run, chunks->meta().levels.size(), scene.notes, progress);
    StreamSettings settings;
    settings.splat_budget = load.splat_budget > 0 ? load.splat_budget : load.most_splats;
    if (load.sh_degree) { settings.sh_degree = static_cast<int>(*load.sh_degree); }
    settings.flatten = load.flatten;
    settings.antialiased = load.antialiased;
    settings.pictures = purpose == StreamFor::kPictures;
    if (settings.pictures) { settings.look_ahead_rad = kPictureLookAhead; }
    // The sample's level is of no interest to the user.
    std::erase_if(scene.notes.lines, [](const std::string& line) {
        return line.find(": level of detail ") != std::string::npos;
    });
    scene.notes.lines.push_back(fmt::format("{}: streamed, {} leaves, at levels chosen by the view", source,
                                            chunks->leaves().size()));
    auto stream = std::make_unique<SceneStream>(context, std::move(chunks), settings);
    scene.stream = stream.get();
    scene.live = std::move(stream);
    return scene;
}

void settle(LiveScene& scene, std::span<const Eye> eyes, const Progress& progress) {
    scene.settle(eyes, [&](double share) {
        stopIfInterrupted();
        if (progress) { progress(share); }
    });
    for (const std::string& said : scene.takeLines(Waits::kBriefly)) {
        fmt::print(stderr, "binosplat: {}\n", said);
    }
}

FrameCounters::Streaming streamingOf(const LiveScene& scene) {
    const StreamCounters counters = scene.counters();
    return {counters.splats_resident, counters.chunks_resident, counters.frames_waited_for_loading,
            counters.scene_frames_late};
}

Scene loadAs(const RunOptions& run, const std::string& source, std::uint64_t builtin_splats) {
    LoadNotes notes;
    ProgressLine line("loading " + source);
    Scene scene = loadAsAsked(source, run.load, run.memory_limit_mib, notes,
                              isAddress(source) ? line.progress() : nullptr, builtin_splats);
    if (!notes.stale.empty()) { fmt::print(stderr, "binosplat: {}\n", notes.stale); }
    return scene;
}

}  // namespace binosplat
