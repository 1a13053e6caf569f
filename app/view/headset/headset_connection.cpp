// Begins the next session.
#include "app/view/headset/headset_connection.h"

#include "app/terminal/interrupt.h"
#include "engine/error.h"

#include <mutex>
#include <thread>
#include <utility>

namespace binosplat {

namespace {

// How often to check whether an unplugged headset is back.
constexpr std::chrono::milliseconds kBetweenSearches(200), kPause(5);
// How many times, and how far apart, to ask again for a session that a headset refuses just after it was
// plugged in.
constexpr int kMostFailures = 10;
constexpr std::chrono::milliseconds kBetweenFailures(1000);

}  // namespace

HeadsetConnection::HeadsetConnection(xr::Instance& instance, const Context& context, glm::uvec2 panel_px,
                                     const Say& say)
    : instance_(instance), context_(context), panel_px_(panel_px) {
    const auto tryTo = [this](const auto& begin) {
        try {
            begin();
        } catch (const xr::Lost& lost) { lose(lost.what()); }
    };
    tryTo([&] { headset_ = std::make_unique<ConnectedHeadset>(instance_, context_, panel_px_); });
    while (!headset_) {
        stopIfInterrupted();
        tryTo([&] {
            if (search(say) == Search::kLater) { std::this_thread::sleep_for(kPause); }
        });
    }
    format_ = headset_->format;
}

void HeadsetConnection::lose(const std::string& why) {
    if (!losses_.add(std::chrono::steady_clock::now())) {
        throw Error(ExitCode::kNoDevice,
                    fmt::format("{}: {} times in a row before a frame was shown", why, losses_.count()));
    }
    why_lost_ = why;
    is_gone_ = false;
    next_search_ = {};
    context_.waitForQueue();
    headset_.reset();
}

HeadsetConnection::Search HeadsetConnection::search(const Say& say) {
    const auto now = std::chrono::steady_clock::now();
    if (now < next_search_) { return Search::kLater; }
    next_search_ = now + kBetweenSearches;
    if (!instance_.findHeadset(context_)) {
        if (!std::exchange(is_gone_, true)) { say(why_lost_ + "; the headset is gone: waiting for it"); }
        return Search::kNone;
    }
    say(is_gone_ ? "the headset is back; a new session begins" : why_lost_ + "; another one begins");
    try {
        headset_ = std::make_unique<ConnectedHeadset>(instance_, context_, panel_px_);
        failures_ = 0;
    } catch (const Error& error) {
        // The headset was found, but is not awake yet.
        if (++failures_ > kMostFailures) { throw; }
        why_lost_ = error.what();
        next_search_ = now + kBetweenFailures;
        return Search::kNone;
    }
    if (format_ != vk::Format::eUndefined && headset_->format != format_) {
        throw Error(ExitCode::kNoDevice, why_lost_ + ": the next one has other image formats");
    }
    return Search::kFound;
}

}  // namespace binosplat
