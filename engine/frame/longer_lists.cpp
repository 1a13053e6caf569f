// Memory is made and freed where no frame waits for it.
#include "engine/frame/longer_lists.h"

#include "engine/error.h"
#include "engine/ready.h"

#include <utility>

namespace binosplat {

bool LongerLists::isUnderWay() const {
    return making_.valid() || old_ || (freeing_.valid() && !isReady(freeing_));
}

void LongerLists::begin(FrameCapacity now, std::vector<FrameCapacity> wanted) {
    wanted_ = wanted.size();
    making_ = std::async(std::launch::async, [this, now, wanted = std::move(wanted)] {
        Made made;
        for (; made.which < wanted.size(); ++made.which) {
            try {
                made.lists = makeLongerLists(context_, now, wanted[made.which]);
                break;
            } catch (const Error&) {}  // the next one is smaller
        }
        return made;
    });
}

std::optional<std::size_t> LongerLists::exchange(FrameBuffers& lists) {
    Made made = making_.get();
    if (made.which < wanted_) { old_ = exchangeLists(lists, std::move(made.lists)); }
    return made.which;
}

std::optional<std::size_t> LongerLists::bring(FrameBuffers& lists) {
    if (old_) {
        // The frame that used them was the last one at the exchange.
        freeing_ = std::async(std::launch::async, [old = std::move(*old_)]() mutable { old = {}; });
        old_.reset();
    }
    if (!isReady(making_)) { return std::nullopt; }
    return exchange(lists);
}

std::optional<std::size_t> LongerLists::finish(FrameBuffers& lists) {
    std::optional<std::size_t> which;
    if (making_.valid()) { which = exchange(lists); }
    drop();
    return which;
}

void LongerLists::drop() {
    if (making_.valid()) { static_cast<void>(making_.get()); }
    old_.reset();
    if (freeing_.valid()) { freeing_.get(); }
}

}  // namespace binosplat
