// How a function of the API answers: what is wrong with a call is thrown as a Refusal and becomes the result code in one place.
#pragma once

#include <mutex>
#include <new>
#include <string>
#include <utility>

#include "xr/simulated/openxr.h"

namespace simulated {

struct Refusal {
    XrResult result;
    std::string reason;
};

inline void require(bool holds, XrResult otherwise, const char* reason) {
    if (!holds) throw Refusal{otherwise, reason};
}
inline void require(bool holds, XrResult otherwise, const std::string& reason) {
    if (!holds) throw Refusal{otherwise, reason};
}

// One lock for the whole runtime: calls are short, and only xrWaitFrame waits (and lets go of it meanwhile).
std::mutex& runtimeLock();

// With SIMULATED_OPENXR_EXPLAIN set, says on standard error which call was refused and why; failures of the runtime are always said.
void explain(const char* function, const Refusal& refusal);
void explainFailure(const char* function, const char* what);

template <class Body>
XrResult answerUnlocked(const char* function, Body&& body) {
    try {
        return std::forward<Body>(body)();
    } catch (const Refusal& refusal) {
        explain(function, refusal);
        return refusal.result;
    } catch (const std::bad_alloc&) { return XR_ERROR_OUT_OF_MEMORY; } catch (const std::exception& failure) {
        explainFailure(function, failure.what());
        return XR_ERROR_RUNTIME_FAILURE;
    }
}

// What explain() has for the application's own function (messages.h), once the lock is free.
void deliverMessages();

template <class Body>
XrResult answer(const char* function, Body&& body) {
    XrResult result = XR_SUCCESS;
    {
        const std::lock_guard guard(runtimeLock());
        result = answerUnlocked(function, std::forward<Body>(body));
    }
    deliverMessages();
    return result;
}

}  // namespace simulated
