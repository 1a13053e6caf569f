// Questions to a thread of its own, one at a time. The caller never waits: it takes an answer once there is
// one.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace binosplat {

// Whether a call waits while another thread looks through what both use. Frames never do: they call again.
enum class Waits { kNever, kBriefly };

inline std::unique_lock<std::mutex> lockOf(std::mutex& mutex, Waits waits) {
    return waits == Waits::kBriefly ? std::unique_lock(mutex) : std::unique_lock(mutex, std::try_to_lock);
}

template <typename Question, typename Answer>
class Mailbox {
public:
    // `find` runs on the thread.
    explicit Mailbox(std::function<Answer(const Question&)> find)
        : find_(std::move(find)), thread_([this] { run(); }) {}
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;
    // Waits for an answer that is being found.
    ~Mailbox() {
        {
            const std::lock_guard lock(mutex_);
            stops_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }

    // Replaces a question that has not been begun yet. False if the thread is just looking: ask again.
    [[nodiscard]] bool ask(Question&& question) {
        const std::unique_lock lock = lockOf(mutex_, Waits::kNever);
        if (!lock) { return false; }
        question_ = std::move(question);
        changed_.notify_all();
        return true;
    }
    // The latest answer, once.
    [[nodiscard]] std::optional<Answer> take() {
        const std::unique_lock lock = lockOf(mutex_, Waits::kNever);
        return lock ? std::exchange(answer_, std::nullopt) : std::nullopt;
    }
    // Waits for it: there is a question, or an answer that was not taken.
    Answer waitForAnswer() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return answer_.has_value(); });
        return *std::exchange(answer_, std::nullopt);
    }

private:
    void run() {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [&] { return stops_ || question_; });
            if (stops_) { return; }
            const Question question = *std::exchange(question_, std::nullopt);
            lock.unlock();
            Answer answer = find_(question);
            lock.lock();
            answer_ = std::move(answer);
            changed_.notify_all();
        }
    }

    std::function<Answer(const Question&)> find_;
    std::mutex mutex_;  // of what follows
    std::condition_variable changed_;
    bool stops_ = false;
    std::optional<Question> question_;
    std::optional<Answer> answer_;
    std::thread thread_;  // last
};

}  // namespace binosplat
