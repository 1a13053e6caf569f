// Files that are read and written beside the frames, which must wait for no disk and no network.
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

// One thread, which does one thing after the other.
class FileWorker {
public:
    // What is to be done with what was read, by whoever calls deliver().
    using Done = std::function<void()>;
    // On the worker's thread. What it throws, deliver() throws.
    using Work = std::function<Done()>;

    FileWorker();
    FileWorker(const FileWorker&) = delete;
    FileWorker& operator=(const FileWorker&) = delete;
    // What is to be written is written first.
    ~FileWorker();

    // `what` in words: "reading /a/folder".
    void read(std::string what, Work work) { ask({std::move(what), std::move(work), false}); }
    // Likewise; it is done even if the program ends.
    void write(std::string what, Work work) { ask({std::move(what), std::move(work), true}); }
    // What goes on, in words; empty: nothing does.
    [[nodiscard]] std::string now() const;

    // Between frames: what is done is handed over, to the functions that go with it. Waits for nothing.
    void deliver();
    // Waits until all is written, without what else was only asked for, and hands over what is done.
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
