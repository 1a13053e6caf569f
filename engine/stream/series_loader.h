// Reads the frames of a moving scene ahead, on threads of its own, as many as memory allows.
#pragma once

#include "engine/stream/mailbox.h"
#include "engine/stream/scene_frames.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace binosplat {

class SeriesLoader {
public:
    // A frame of the scene. It stays in place while it is held, on any thread; the loader must exist for as
    // long.
    struct Frame {
        SceneFrame splats;
        mutable std::atomic<int> holders = 0;  // more of them only with the mutex held, fewer at any time
    };
    struct LetGo {
        void operator()(const Frame* frame) const { --frame->holders; }
    };
    using Held = std::unique_ptr<const Frame, LetGo>;
    struct Settings {
        // Limit for frames that are kept; at least kLeastKept of them are.
        std::uint64_t most_bytes = std::uint64_t{1} << 30;
        int threads = 1;
    };
    static constexpr std::size_t kLeastKept = 3;
    // Called on any thread, for several scenes at a time; throws Error.
    using Load = std::function<Scene(std::size_t scene)>;

    SeriesLoader(Load load, std::size_t scenes, const SceneTraits& traits, const Settings& settings);
    SeriesLoader(const SeriesLoader&) = delete;
    SeriesLoader& operator=(const SeriesLoader&) = delete;
    // Waits for what is being read.
    ~SeriesLoader();

    // The scenes that will be needed, the next one first; of those read earlier that are not held, the one
    // needed last is dropped. Never waits: false if the loader is searching its lists right now, ask again.
    [[nodiscard]] bool tryWant(const std::vector<std::size_t>& scenes);
    // Null if it is not loaded now. Never waits.
    [[nodiscard]] Held tryGet(std::size_t scene) const;
    // True if it cannot be loaded. Never waits; perhaps later.
    [[nodiscard]] bool isSurelyBroken(std::size_t scene) const;
    // Waits until it is loaded. Throws Error if it cannot be.
    [[nodiscard]] Held get(std::size_t scene);
    // One sentence for each scene that cannot be loaded, once.
    [[nodiscard]] std::vector<std::string> takeLines(Waits waits);
    [[nodiscard]] std::uint64_t bytesKept() const;

private:
    struct Trouble {
        std::string what;
        bool said = false;
    };

    void run();
    // With the mutex held. What to read next, once there is memory.
    [[nodiscard]] std::optional<std::size_t> next();
    [[nodiscard]] std::size_t orderOf(std::size_t scene) const;
    [[nodiscard]] Held hold(std::size_t scene) const;

    Load load_;
    SceneTraits traits_;
    Settings settings_;

    mutable std::mutex mutex_;  // of what follows
    mutable std::condition_variable wanted_changed_, news_;
    bool stops_ = false;
    std::vector<std::size_t> wanted_;
    std::vector<bool> reading_;
    std::map<std::size_t, Frame> kept_;
    std::map<std::size_t, Trouble> troubles_;
    std::uint64_t bytes_ = 0, largest_ = 0;
    std::vector<std::thread> threads_;  // last
};

}  // namespace binosplat
