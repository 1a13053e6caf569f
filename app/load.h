// Loads a scene by the options, wherever it is.
#pragma once

#include "app/options/options.h"
#include "engine/files/load_scene.h"
#include "engine/frame/counters.h"
#include "engine/stream/moving_scene.h"
#include "engine/stream/scene_stream.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace binosplat {

// A frame's other memory depends on the view and is not known yet: only the level's splats are compared with
// the limit.
LevelChoice levelChoice(const LoadOptions& options, std::uint64_t memory_limit_mib);

// Limits the SH degree, flattens 3D Gaussians to discs, or dims them, if the options say so; a file may
// itself ask for dimming.
void drawAs(const LoadOptions& options, Scene& scene, LoadNotes& notes);

// SCENE of any command: a file, a folder, a built-in scene (then `builtin_splats` sets the size, 0 for its
// default), or an address. `memory_limit_mib` limits device memory, 0: no limit.
Scene loadAsAsked(const std::string& source, const LoadOptions& options, std::uint64_t memory_limit_mib,
                  LoadNotes& notes, const Progress& progress = {}, std::uint64_t builtin_splats = 0);

// With progress on the terminal.
Scene loadWithProgress(const std::string& source, const LoadOptions& options, LoadNotes& notes,
                       std::uint64_t memory_limit_mib = 0);

// A scene that is not loaded whole: streamed, or moving.
struct OpenedScene {
    std::unique_ptr<LiveScene> live;
    SceneStream* stream = nullptr;  // the same, if it is streamed
    MovingScene* moving = nullptr;  // the same, if it moves
    Scene sample;                   // its coarsest level or its first frame, to find a view of it
    LoadNotes notes;                // of the sample
};
enum class StreamFor {
    kPictures,  // loaded whole if the finest level fits and no budget is set
    kFrames,    // loaded while it is shown
};
// True if `source` is streamed or moving, unless the options name a level, which is loaded whole. Throws
// Error if the options set a splat budget for a scene without levels to choose from, or together with a
// level.
bool mayLive(const std::string& source, const LoadOptions& options);
// Opens such a source; empty if it should be loaded whole after all.
std::optional<OpenedScene> openLive(const Context& context, const std::string& source, const RunOptions& run,
                                    StreamFor purpose, const Progress& progress = {});
// Waits until everything that the eyes and the time need has been loaded. Prints what cannot be loaded.
void settle(LiveScene& scene, std::span<const Eye> eyes, const Progress& progress = {});
// What has been loaded of it, for reports.
FrameCounters::Streaming streamingOf(const LiveScene& scene);

// For commands that print no notes.
Scene loadAs(const RunOptions& run, const std::string& source, std::uint64_t builtin_splats = 0);

}  // namespace binosplat
