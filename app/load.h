// Loading a scene as the options ask for it, from wherever it is.
#pragma once

#include "app/options/options.h"
#include "engine/frame/counters.h"
#include "engine/scene/scene.h"
#include "engine/stream/moving_scene.h"
#include "engine/stream/scene_stream.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace binosplat {

// What a frame needs beside the scene depends on the view and is not known yet: the level's splats alone are held against the limit.
LevelChoice levelChoice(const LoadOptions& options, std::uint64_t memory_limit_mib);

// SCENE of any command: a file, a folder, a built-in scene (then `builtin_splats` sets the size, 0 for its default), or an address.
// `memory_limit_mib` is of the device, 0 for none.
Scene loadAsAsked(const std::string& source, const LoadOptions& options, std::uint64_t memory_limit_mib, LoadNotes& notes,
                  const Progress& progress = {}, std::uint64_t builtin_splats = 0);

// With progress on the terminal.
Scene loadWithProgress(const std::string& source, const LoadOptions& options, LoadNotes& notes, std::uint64_t memory_limit_mib = 0);

// A scene that is not loaded whole: streamed, or moving.
struct OpenedScene {
    std::unique_ptr<LiveScene> live;
    SceneStream* stream = nullptr;  // the same, where it is streamed
    MovingScene* moving = nullptr;  // likewise
    Scene sample;                   // its coarsest level or its first frame, for what asks how a scene lies
    LoadNotes notes;                // of that
};
enum class StreamFor {
    kPictures,  // loaded whole where its finest level fits and nobody asks for less
    kFrames,    // loaded while it is shown
};
// Whether `source` is one, and is not to be loaded whole as a level that the options name. Throws Error where the options ask for splats of
// a scene that has no levels to choose from, or for a level as well.
bool mayLive(const std::string& source, const LoadOptions& options);
// Of such a source; empty where it is to be loaded whole all the same.
std::optional<OpenedScene> openLive(const Context& context, const std::string& source, const RunOptions& run, StreamFor purpose,
                                    const Progress& progress = {});
// Until all is there that the eyes and the time ask for. Says what cannot be had.
void settle(LiveScene& scene, std::span<const Eye> eyes, const Progress& progress = {});
// What there is of it, for reports.
FrameCounters::Streaming streamingOf(const LiveScene& scene);

// For commands that print no notes.
Scene loadAs(const RunOptions& run, const std::string& source, std::uint64_t builtin_splats = 0);

}  // namespace binosplat
