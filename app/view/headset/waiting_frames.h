// Frames without a scene: the panel, and what is in the room. As with a scene, the device draws one while the
// next is recorded.
#pragma once

#include "engine/gpu/commands.h"

#include <array>
#include <cstddef>

namespace binosplat {

class WaitingFrames {
public:
    explicit WaitingFrames(const Context& context) : commands_{Commands(context), Commands(context)} {}

    // Waits for the one before the last.
    Commands& begin() {
        commands_[turn_].wait();
        commands_[turn_].begin();
        return commands_[turn_];
    }
    // `signals`, if given, is signalled when it is done.
    void submit(vk::Semaphore signals) {
        commands_[turn_].submit(signals);
        turn_ = 1 - turn_;
    }
    // In place of one, while a scene is shown: waits as begin() does.
    void passOver() {
        commands_[turn_].wait();
        turn_ = 1 - turn_;
    }

private:
    std::array<Commands, 2> commands_;
    std::size_t turn_ = 0;
};

}  // namespace binosplat
