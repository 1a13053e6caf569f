// Every object behind a handle, in a tree: children end with their parent. Numbers are never reused, so that
// a handle that was destroyed, or is of another type, is known to be invalid.
#pragma once

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <vector>

#include "xr/simulated/api/answer.h"
#include "xr/simulated/openxr.h"

namespace simulated {

struct Object {
    std::uint64_t number = 0;
    Object* parent = nullptr;
    std::vector<std::unique_ptr<Object>> children;

    Object() = default;
    Object(const Object&) = delete;
    Object& operator=(const Object&) = delete;
    virtual ~Object() = default;
};

struct Session;

// Anything that a session's calls make.
struct SessionChild : Object {
    Session& session;

    explicit SessionChild(Session& owner) : session(owner) {}
};

// Like destroyObject, for objects that end with the process.
inline void endChildren(Object& object) {
    for (; !object.children.empty(); object.children.pop_back()) { endChildren(*object.children.back()); }
}

// The only objects without an owner above them: the root, and the process's table of all of them.
Object& root();
Object* findObject(std::uint64_t number);

// XR_ERROR_LIMIT_REACHED if the parent has as many children as this runtime allows.
void adoptObject(Object& parent, std::unique_ptr<Object> child);
// Children first, in the reverse order of their creation.
void destroyObject(Object& object);

template <class Handle>
std::uint64_t numberOf(Handle handle) {
    return reinterpret_cast<std::uint64_t>(handle);
}

// Handle types as the specification names them.
constexpr const char* typeOf(XrInstance) { return "XrInstance"; }
constexpr const char* typeOf(XrSession) { return "XrSession"; }
constexpr const char* typeOf(XrSpace) { return "XrSpace"; }
constexpr const char* typeOf(XrSwapchain) { return "XrSwapchain"; }
constexpr const char* typeOf(XrActionSet) { return "XrActionSet"; }
constexpr const char* typeOf(XrAction) { return "XrAction"; }
constexpr const char* typeOf(XrPassthroughFB) { return "XrPassthroughFB"; }
constexpr const char* typeOf(XrPassthroughLayerFB) { return "XrPassthroughLayerFB"; }
constexpr const char* typeOf(XrHandTrackerEXT) { return "XrHandTrackerEXT"; }
constexpr const char* typeOf(XrDebugUtilsMessengerEXT) { return "XrDebugUtilsMessengerEXT"; }

template <class T>
typename T::Handle handleOf(const T& object) {
    return reinterpret_cast<typename T::Handle>(object.number);
}

template <class T>
T* find(typename T::Handle handle) {
    return dynamic_cast<T*>(findObject(numberOf(handle)));
}

// "0x51a000000002 is not an XrSession that exists".
template <class Handle>
[[noreturn]] void refuseHandle(Handle handle, const char* why) {
    char digits[16];
    const std::string_view number(
        digits, std::to_chars(digits, digits + sizeof digits, numberOf(handle), 16).ptr - digits);
    refuse(XR_ERROR_HANDLE_INVALID, "0x", number, " is not an ", typeOf(handle), why);
}

template <class T>
T& get(typename T::Handle handle) {
    T* const object = find<T>(handle);
    if (object == nullptr) { refuseHandle(handle, " that exists"); }
    return *object;
}

template <class T>
T& adopt(Object& parent, std::unique_ptr<T> child) {
    T& object = *child;
    adoptObject(parent, std::move(child));
    return object;
}

// Answers a call on an instance, a session or a session's child, which is passed to the body.
template <class T, class Body>
XrResult answerFor(const char* function, typename T::Handle handle, const Body& body) {
    return answer(function, [&] {
        T& object = get<T>(handle);
        checkNotLost(object);
        return successOf(object, resultOf(body, object));
    });
}

}  // namespace simulated
