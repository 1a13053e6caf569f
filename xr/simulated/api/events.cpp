// Putting events into the queue and taking them out, removing a session's events, and xrPollEvent.
#include "xr/simulated/api/events.h"

#include <algorithm>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/instance.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr std::size_t kMostEvents = 64;

// Events of sessions have the session right after type and next.
XrSession sessionOf(const XrEventDataBuffer& event) {
    constexpr XrStructureType kOfSessions[] = {
        XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED, XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED,
        XR_TYPE_EVENT_DATA_VISIBILITY_MASK_CHANGED_KHR, XR_TYPE_EVENT_DATA_REFERENCE_SPACE_CHANGE_PENDING,
        XR_TYPE_EVENT_DATA_USER_PRESENCE_CHANGED_EXT};
    if (std::ranges::find(kOfSessions, event.type) == std::end(kOfSessions)) { return XR_NULL_HANDLE; }
    return reinterpret_cast<const XrEventDataInteractionProfileChanged&>(event).session;
}

}  // namespace

void Events::pushBuffer(const XrEventDataBuffer& event) {
    if (waiting_.size() < kMostEvents) {
        waiting_.push_back(event);
    } else {
        ++lost_;
    }
}

bool Events::pop(XrEventDataBuffer& event) {
    if (waiting_.empty() && lost_ > 0) {
        XrEventDataEventsLost loss{XR_TYPE_EVENT_DATA_EVENTS_LOST, nullptr, lost_};
        lost_ = 0;
        push(loss);
    }
    if (waiting_.empty()) { return false; }
    event = waiting_.front();
    waiting_.pop_front();
    return true;
}

void Events::forget(XrSession session) {
    std::erase_if(waiting_, [&](const auto& event) { return sessionOf(event) == session; });
}

XrResult xrPollEvent(XrInstance instance, XrEventDataBuffer* eventData) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        XrEventDataBuffer& event = checkStruct(eventData, XR_TYPE_EVENT_DATA_BUFFER);
        if (owner.events.pop(event)) { return XR_SUCCESS; }
        if (owner.session != nullptr) { owner.session->idle(); }
        return XR_EVENT_UNAVAILABLE;
    });
}

}  // namespace simulated
