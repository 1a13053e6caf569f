// A queue and its thread.
#include "app/view/files/file_worker.h"

#include <algorithm>
#include <exception>

namespace binosplat {

FileWorker::FileWorker() : thread_([this] { run(); }) {}

FileWorker::~FileWorker() {
    {
        const std::lock_guard lock(mutex_);
        dropReading();
        ends_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void FileWorker::ask(Task task) {
    {
        const std::lock_guard lock(mutex_);
        tasks_.push_back(std::move(task));
    }
    changed_.notify_all();
}

void FileWorker::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return ends_ || !tasks_.empty(); });
        if (tasks_.empty()) { return; }
        const Work work = std::move(tasks_.front().work);
        lock.unlock();
        Done done;
        try {
            done = work();
        } catch (...) {
            done = [error = std::current_exception()] { std::rethrow_exception(error); };
        }
        lock.lock();
        done_.push_back(std::move(done));
        tasks_.pop_front();
        changed_.notify_all();
    }
}

// Except the task in progress.
void FileWorker::dropReading() {
    if (tasks_.empty()) { return; }
    const auto second = tasks_.begin() + 1;
    tasks_.erase(std::remove_if(second, tasks_.end(), [](const Task& task) { return !task.writes; }),
                 tasks_.end());
}

std::string FileWorker::now() const {
    const std::lock_guard lock(mutex_);
    return tasks_.empty() ? std::string() : tasks_.front().what;
}

void FileWorker::deliver() {
    std::vector<Done> done;
    {
        const std::lock_guard lock(mutex_);
        done.swap(done_);
    }
    for (const Done& act : done) {
        if (act) { act(); }
    }
}

void FileWorker::finish() {
    {
        std::unique_lock lock(mutex_);
        dropReading();
        changed_.wait(lock, [this] { return tasks_.empty(); });
    }
    deliver();
}

}  // namespace binosplat
