// A scene whose content on the device changes between frames: with what the eyes see, or with time.
#pragma once

#include "engine/geometry.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/stream/mailbox.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

struct StreamCounters {
    // Splats on the device, and how many of them the next frame reads.
    std::uint64_t splats_resident = 0, splats_read = 0;
    std::uint64_t chunks_resident = 0;            // levels of leaves, or pages of a scene that moves
    std::uint64_t frames_waited_for_loading = 0;  // update() never waits
    std::uint64_t scene_frames_late = 0;          // that were not loaded when their time came
};

// For the thread that records frames.
class LiveScene {
public:
    LiveScene() = default;
    LiveScene(const LiveScene&) = delete;
    LiveScene& operator=(const LiveScene&) = delete;
    virtual ~LiveScene() = default;

    [[nodiscard]] virtual const std::string& name() const = 0;
    // The scene that frames render.
    [[nodiscard]] virtual const GpuScene& scene() const = 0;
    [[nodiscard]] virtual const SceneTraits& traits() const = 0;

    // From the next call on: seconds since the first frame of a scene that moves.
    virtual void setTime(double time_s) { static_cast<void>(time_s); }
    // For display, before each frame: takes what has been loaded, and advances exchanges by a frame of
    // `step_seconds`. Never waits.
    virtual void update(std::span<const Eye> eyes, double step_seconds) = 0;
    // For rendering pictures: returns when everything that these eyes need is on the device or goes there
    // with the next frame, except what cannot be loaded. The same calls always give the same splats in the
    // same order.
    virtual void settle(std::span<const Eye> eyes, const Progress& progress = {}) = 0;

    // True if update() has nothing left to do for the latest eyes and time, except what cannot be loaded.
    [[nodiscard]] virtual bool isSettled() const = 0;
    // The loaded share of what is needed, 0 to 1.
    [[nodiscard]] virtual double share() const = 0;
    [[nodiscard]] virtual StreamCounters counters() const = 0;
    // Problems with files and servers, one sentence each, once.
    [[nodiscard]] virtual std::vector<std::string> takeLines(Waits waits) = 0;
};

}  // namespace binosplat
