// The queue that xrPollEvent empties. It is bounded: events that do not fit are counted, and the application
// is told how many were lost.
#pragma once

#include <cstdint>
#include <cstring>
#include <deque>

#include "xr/simulated/openxr.h"

namespace simulated {

class Events {
public:
    template <class Event>
    void push(const Event& event) {
        static_assert(sizeof(Event) <= sizeof(XrEventDataBuffer));
        XrEventDataBuffer buffer{};
        std::memcpy(&buffer, &event, sizeof event);
        pushBuffer(buffer);
    }

    // False: nothing is waiting.
    bool pop(XrEventDataBuffer& event);

    // Drops the events of a session that is gone.
    void forget(XrSession session);

private:
    void pushBuffer(const XrEventDataBuffer& event);

    std::deque<XrEventDataBuffer> waiting_;
    std::uint32_t lost_ = 0;
};

}  // namespace simulated
