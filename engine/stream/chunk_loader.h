// Loads parts of a streamed scene alongside the frames: what is requested, in that order, on threads of its
// own.
#pragma once

#include "engine/files/sog_splats.h"
#include "engine/gpu/packed_splats.h"
#include "engine/stream/chunk_source.h"
#include "engine/stream/level_chooser.h"
#include "engine/stream/mailbox.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace binosplat {

// A level of a leaf, decoded, with three scales per splat even for discs. It may have fewer splats than the
// tree says: broken ones are skipped.
struct LoadedPart {
    LeafLevel at;
    std::uint32_t splats = 0;
    Scene scene;
    PackedPages pages;  // empty unless LoaderSettings::finish makes them of the scene
};

struct LoaderSettings {
    int threads = 2;                         // that decode at a time
    std::uint64_t waiting_splats = 1 << 20;  // decoded but not taken yet: beyond this, decoding waits
    std::size_t kept_files = 2;              // decoded files, in case more is wanted from them
    // Pause before a file from the web is tried again; it doubles each time.
    std::chrono::milliseconds first_pause{1000};
    std::chrono::milliseconds most_pause{30000};
    std::function<void(LoadedPart&)> finish = {};  // further work on a part, on the loader's threads
};

// The splats that were read, and how long that took: fetching and decoding files, not waiting for space or
// for requests.
struct LoaderWork {
    std::uint64_t splats = 0;
    double seconds = 0.0;
};

class ChunkLoader {
public:
    ChunkLoader(std::unique_ptr<ChunkSource> source, LoaderSettings settings);
    ChunkLoader(const ChunkLoader&) = delete;
    ChunkLoader& operator=(const ChunkLoader&) = delete;
    // Abandons what it can, and waits for the rest.
    ~ChunkLoader();

    [[nodiscard]] const ChunkSource& source() const { return *source_; }

    // From now on, these and nothing else are wanted; they must not include what has been taken already.
    // `finer` is begun when nothing of `coarsest` is left to load. False if the request was not received: for
    // callers that never wait, this and the following return false or nothing while the loader looks through
    // its lists.
    bool want(std::vector<LeafLevel> coarsest, std::vector<LeafLevel> finer, Waits waits = Waits::kBriefly);
    // The parts that have been loaded, in the order in which they were requested.
    [[nodiscard]] std::vector<LoadedPart> take(Waits waits = Waits::kBriefly);
    // A sentence for each file that is broken or missing, and one each time a server does not answer; each
    // only once.
    [[nodiscard]] std::vector<std::string> takeLines(Waits waits = Waits::kBriefly);
    // For each file: true if it is unavailable now. Requests for parts of such files are not loaded.
    [[nodiscard]] std::optional<std::vector<bool>> brokenFiles(Waits waits = Waits::kBriefly) const;
    // True if everything requested has been taken or is unavailable.
    [[nodiscard]] bool isDone(Waits waits = Waits::kBriefly) const;
    [[nodiscard]] std::optional<LoaderWork> tryWork() const;
    // Waits until there is something to take, a file turns out to be broken, or everything is done; false if
    // the time runs out first.
    bool waitForNews(std::chrono::milliseconds most) const;

private:
    using Clock = std::chrono::steady_clock;
    struct Decoded {
        std::size_t file;
        SogSplats splats;
        SogPictures pictures;
    };
    struct Trouble {
        bool broken = false;
        bool is_said = false;                    // until the file comes
        std::optional<Clock::time_point> again;  // from the web: when it is tried again
    };

    void run();
    [[nodiscard]] const LodRange& rangeOf(LeafLevel at) const {
        return source_->leaves()[at.leaf].levels[at.level];
    }
    // With the mutex held: the file of the first request that can be loaded.
    [[nodiscard]] std::optional<std::size_t> nextFile() const;
    [[nodiscard]] std::vector<LeafLevel> wishesIn(std::size_t file) const;
    [[nodiscard]] std::vector<std::size_t> filesAhead() const;
    [[nodiscard]] bool isWished(LeafLevel at) const;
    void removeWish(LeafLevel at);
    // For files whose time has come.
    void forgetTroubles();
    [[nodiscard]] std::optional<Clock::time_point> nextAttempt() const;
    const Decoded& decode(std::size_t file);
    [[nodiscard]] LoadedPart read(const Decoded& decoded, LeafLevel at) const;
    void load(std::size_t file, const std::vector<LeafLevel>& wishes);
    void meetTrouble(std::size_t file, const std::string& why, bool may_pass);

    std::unique_ptr<ChunkSource> source_;
    LoaderSettings settings_;
    std::deque<Decoded> decoded_;  // of the loader's thread; the one used last at the front
    Clock::duration pause_;        // of the loader's thread
    std::size_t came_since_ = 0;   // of the loader's thread: files since one did not come
    Clock::time_point failed_at_;  // of the loader's thread: when that was
    // Used by the loader's thread: the server does not answer, and that was reported.
    bool said_gone_ = false;

    mutable std::mutex mutex_;  // of what follows
    mutable std::condition_variable changed_, news_;
    bool stops_ = false;
    std::vector<LeafLevel> coarsest_, finer_;
    std::deque<LoadedPart> done_;
    std::uint64_t done_splats_ = 0;
    LoaderWork work_;
    std::vector<std::string> lines_;
    std::vector<Trouble> troubles_;  // by file
    std::uint64_t news_count_ = 0;
    mutable std::uint64_t news_seen_ = 0;
    std::thread thread_;  // last
};

}  // namespace binosplat
