// Reads and writes files beside the frames, which must not wait for a disk or a network.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace binosplat {

// One thread, which does one task after the other.
class FileWorker {
public:
    // Uses the result; runs on the thread that calls deliver().
    using Done = std::function<void()>;
    // Runs on the worker's thread; deliver() rethrows its exceptions.
    using Work = std::function<Done()>;

    FileWorker();
    FileWorker(const FileWorker&) = delete;
    FileWorker& operator=(const FileWorker&) = delete;
    // Finishes all writing first.
    ~FileWorker();

    // `what` in words: "reading /a/folder".
    void read(std::string what, Work work) { ask({std::move(what), std::move(work), false}); }
    // Like read(), but done even if the program ends.
    void write(std::string what, Work work) { ask({std::move(what), std::move(work), true}); }
    // The task in progress, in words; empty: none.
    [[nodiscard]] std::string now() const;

    // Between frames: calls the Done functions of finished tasks. Does not wait.
    void deliver();
    // Waits until all is written, drops reads that have not begun, and delivers what is done.
    void finish();

private:
    struct Task {
        std::string what;
        Work work;
        bool writes = false;
    };
    void ask(Task task);
    void run();
    void dropReading();

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Task> tasks_;  // the first one is under way
    std::vector<Done> done_;
    bool ends_ = false;
    std::thread thread_;
};

}  // namespace binosplat
