// Every OpenXR call goes through here: failures throw, with the call's text.
#pragma once

#include "engine/error.h"

#include <openxr/openxr.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace binosplat::xr {

// The session is gone, or the headset; the runtime may give another one. Neither this nor InstanceLost is an
// Error: code that goes on without a failed feature must not go on after these.
class Lost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The whole runtime is gone, and with it the Vulkan device.
class InstanceLost : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// "XR_ERROR_SESSION_LOST", or the number of a result that this build does not know.
std::string nameOf(XrResult result);

inline constexpr const char* kGoingAway = "the OpenXR runtime is going away";

// Returns `result` if it is a success of any kind. Throws Lost or InstanceLost for a loss, otherwise Error
// (exit code 3, for memory 1) with the name of the function in `call`.
XrResult checkResult(XrResult result, const char* call);

#define BINOSPLAT_XR(call) ::binosplat::xr::checkResult((call), #call)

// An OpenXR struct with its type set, otherwise zero.
template <typename Struct>
[[nodiscard]] Struct structure(XrStructureType type) {
    Struct made{};
    made.type = type;
    return made;
}

// The list from a call with the two-call idiom; `call` takes the array's capacity, a pointer to the count,
// and the array.
template <typename Value>
[[nodiscard]] std::vector<Value> listAll(const auto& call) {
    std::uint32_t count = 0;
    call(0u, &count, nullptr);
    std::vector<Value> values(count);
    call(count, &count, values.data());
    values.resize(std::min<std::size_t>(count, values.size()));
    return values;
}

}  // namespace binosplat::xr
