// One question at a time.
#include "engine/stream/level_planner.h"

#include <utility>

namespace binosplat {

LevelPlanner::LevelPlanner(std::span<const LodLeaf> leaves) : chooser_(leaves), thread_([this] { run(); }) {}

LevelPlanner::~LevelPlanner() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    asked_.notify_all();
    thread_.join();
}

bool LevelPlanner::ask(const LevelQuestion& question) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) { return false; }
    question_ = question;
    asked_.notify_all();
    return true;
}

std::optional<LevelChoices> LevelPlanner::take() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? std::exchange(answer_, std::nullopt) : std::nullopt;
}

void LevelPlanner::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        asked_.wait(lock, [&] { return stops_ || question_; });
        if (stops_) { return; }
        const LevelQuestion question = *std::exchange(question_, std::nullopt);
        lock.unlock();
        LevelChoices answer = chooser_.choose(question.eyes, question.settings, question.there);
        lock.lock();
        answer_ = std::move(answer);
    }
}

}  // namespace binosplat
