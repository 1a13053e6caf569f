// How API functions answer: an error in a call is thrown as a Refusal and becomes the result code in one
// place.
#pragma once

#include <charconv>
#include <cstdint>
#include <mutex>
#include <new>
#include <string>
#include <string_view>
#include <type_traits>

#include "xr/simulated/openxr.h"

namespace simulated {

struct Refusal {
    XrResult result;
    std::string reason;
};

inline void append(std::string& reason, std::string_view part) { reason += part; }
// The type's name, or its number.
void append(std::string& reason, XrStructureType type);
template <class Number>
requires std::is_arithmetic_v<Number>
void append(std::string& reason, Number number) {
    char digits[32];
    reason.append(digits, std::to_chars(digits, digits + sizeof digits, number).ptr);
}
template <class Enumerant>
requires std::is_enum_v<Enumerant>
void append(std::string& reason, Enumerant value) { append(reason, static_cast<std::int64_t>(value)); }

template <class... Parts>
[[noreturn]] void refuse(XrResult result, const Parts&... parts) {
    Refusal refusal{result, {}};
    (append(refusal.reason, parts), ...);
    throw refusal;
}

// The reason names what was refused; it is put together from words and values only if it is needed.
template <class... Parts>
void require(bool holds, XrResult otherwise, const Parts&... parts) {
    if (!holds) { refuse(otherwise, parts...); }
}

// One lock for the whole runtime: calls are short, and only xrWaitFrame waits (and releases it meanwhile).
std::mutex& getRuntimeLock();

// With SIMULATED_OPENXR_EXPLAIN set, says on standard error which call was refused and why; failures of the
// runtime are always reported.
void explain(const char* function, const Refusal& refusal);
void explainFailure(const char* function, const char* what);
// Repeated lines are counted: a line is printed at ten times, at a hundred and so on, and here, at the end.
void sayTotals();

// A body without a result of its own succeeds.
template <class Body, class... Objects>
XrResult resultOf(const Body& body, Objects&... objects) {
    if constexpr (std::is_void_v<decltype(body(objects...))>) {
        body(objects...);
        return XR_SUCCESS;
    } else {
        return body(objects...);
    }
}

template <class Body>
XrResult answerUnlocked(const char* function, const Body& body) {
    try {
        return resultOf(body);
    } catch (const Refusal& refusal) {
        explain(function, refusal);
        return refusal.result;
    } catch (const std::bad_alloc&) { return XR_ERROR_OUT_OF_MEMORY; } catch (const std::exception& failure) {
        explainFailure(function, failure.what());
        return XR_ERROR_RUNTIME_FAILURE;
    }
}

// Passes explain()'s messages to the application's own function (messages.h), once the lock is free.
void deliverMessages();

template <class Body>
XrResult answer(const char* function, const Body& body) {
    XrResult result = XR_SUCCESS;
    {
        const std::lock_guard guard(getRuntimeLock());
        result = answerUnlocked(function, body);
    }
    deliverMessages();
    return result;
}

}  // namespace simulated
