// XR_EXT_debug_utils: tells the application's callback why a call was refused. Messages wait until the
// runtime's lock is free, so that the callback may call whatever it likes.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "xr/simulated/api/handles.h"

namespace simulated {

struct Instance;

struct Messenger : Object {
    using Handle = XrDebugUtilsMessengerEXT;

    XrDebugUtilsMessengerCreateInfoEXT info{};  // as the application gave it; its chain may be gone
};

// By type and handle, for messages that mention the object.
using ObjectNames = std::map<std::pair<XrObjectType, std::uint64_t>, std::string>;

// Regions that a session is in, and the label inserted last; the latest at the end.
struct Labels {
    std::vector<std::string> regions;
    std::optional<std::string> inserted;
};

// While it lives, the messenger in the chain of an xrCreateInstance gets this thread's refusals.
class CreationMessenger {
public:
    explicit CreationMessenger(const XrInstanceCreateInfo* info);
    ~CreationMessenger();
    CreationMessenger(const CreationMessenger&) = delete;
    CreationMessenger& operator=(const CreationMessenger&) = delete;
};

void queueMessage(XrDebugUtilsMessageTypeFlagsEXT type, const char* id, const char* function,
                  const std::string& text);
// Call it without the runtime's lock.
void deliverMessages();

}  // namespace simulated
