// Longer lists for frames that nobody waits for: made, and the ones before freed, on a thread of their own.
#pragma once

#include "engine/passes/frame_buffers.h"

#include <cstddef>
#include <future>
#include <optional>
#include <vector>

namespace binosplat {

class LongerLists {
public:
    // `context` outlives this.
    explicit LongerLists(const Context& context) : context_(context) {}
    LongerLists(const LongerLists&) = delete;
    LongerLists& operator=(const LongerLists&) = delete;

    // True from begin() until nothing of it is left to do; then another one may begin.
    [[nodiscard]] bool isUnderWay() const;
    // Begins to make what lists of the capacity `now` lack for the first of `wanted` that the device has
    // memory for.
    void begin(FrameCapacity now, std::vector<FrameCapacity> wanted);
    // Before each frame, once all but the last one have finished. If the new lists are there, exchanges them
    // for those of `lists`, and says which of the wanted ones they are; their number: none fitted. Does not
    // wait.
    std::optional<std::size_t> bring(FrameBuffers& lists);
    // The same while no frame is on the device: waits for the new lists, and until the old ones are freed.
    std::optional<std::size_t> finish(FrameBuffers& lists);
    // Waits for the new ones, and frees them; the old ones, too, which no frame may use any more.
    void drop();

private:
    struct Made {
        FrameLists lists;
        std::size_t which = 0;
    };
    std::optional<std::size_t> exchange(FrameBuffers& lists);

    const Context& context_;
    std::optional<FrameLists> old_;  // that the last frame may use
    std::size_t wanted_ = 0;
    std::future<Made> making_;
    std::future<void> freeing_;
};

}  // namespace binosplat
