// Two threads for one scene: one reads and activates blocks, the other assembles them.
#pragma once

#include "engine/files/stored_block.h"

#include <array>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace binosplat {

// GCC 12's std::counting_semaphore for Windows may keep sleeping although it was released: it looks at the
// count before it takes the lock under which it sleeps.
class BatchCount {
public:
    explicit BatchCount(std::ptrdiff_t count) : count_(count) {}
    void release() {
        const std::lock_guard lock(mutex_);
        ++count_;
        changed_.notify_one();
    }
    void acquire() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return count_ > 0; });
        --count_;
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::ptrdiff_t count_;
};

// Blocks with `rows` rows in total, filled in order on a thread of their own, a little ahead of their
// consumer. A scene with few rows is filled on the consumer's thread, since starting another would take
// longer.
class ReadAhead {
public:
    struct Block {
        StoredBlock stored;
        ActiveBlock active;
    };
    // `fill(block)` fills stored.rows rows and activates them. If it throws, next() throws the same in place
    // of that block.
    ReadAhead(std::uint64_t rows, std::function<void(Block&)> fill);
    ReadAhead(const ReadAhead&) = delete;
    ReadAhead& operator=(const ReadAhead&) = delete;
    ~ReadAhead();  // also before the last block

    // Valid until the next call; null after the last block.
    [[nodiscard]] const Block* next();

private:
    // Blocks that are handed over together, since waking a thread costs as much as a few blocks.
    struct Batch {
        std::array<Block, 8> blocks;
        std::size_t count = 0;
        std::exception_ptr failure;  // after the `count` blocks
    };
    static constexpr std::ptrdiff_t kBatches = 4;

    void fillBatch(Batch& batch);
    void run();

    std::uint64_t rows_left_;
    std::function<void(Block&)> fill_;
    std::vector<Batch> batches_;
    std::size_t batch_ = 0, taken_ = 0;  // the batch being taken, and how many of its blocks were
    bool holds_batch_ = false;
    BatchCount free_{kBatches}, filled_{0};
    std::atomic<bool> stops_ = false;
    std::thread thread_;
};

}  // namespace binosplat
