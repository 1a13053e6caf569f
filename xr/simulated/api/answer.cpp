// The lock that every call takes, and what is said of calls that were refused or failed.
#include "xr/simulated/api/answer.h"

#include <cstdio>
#include <cstring>
#include <string>

#include "xr/simulated/api/messages.h"
#include "xr/simulated/environment.h"
#include "xr/simulated/names.h"

namespace simulated {

std::mutex& runtimeLock() {
    static std::mutex lock;
    return lock;
}

void explain(const char* function, const Refusal& refusal) {
    // A failure of the runtime itself is always said: no application can know what to do about it. The loader asks for every function
    // that it has heard of, also without an instance after one was refused; that is no mistake of the application's.
    const bool is_loaders = std::strcmp(function, "xrGetInstanceProcAddr") == 0 && refusal.result != XR_ERROR_VALIDATION_FAILURE;
    if (!is_loaders) queueMessage(XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT, nameOf(refusal.result), function, refusal.reason);
    const bool is_wanted = settingOf("EXPLAIN").value != nullptr && !is_loaders;
    if (!is_wanted && refusal.result != XR_ERROR_RUNTIME_FAILURE) return;
    std::fprintf(stderr, "simulated runtime: %s: %s: %s\n", function, nameOf(refusal.result), refusal.reason.c_str());
}

void explainFailure(const char* function, const char* what) {
    queueMessage(XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT, nameOf(XR_ERROR_RUNTIME_FAILURE), function, what);
    // A program that asks again each frame is told once.
    static std::string last;
    std::string said = std::string(function) + ": " + what;
    if (said == last) return;
    last = std::move(said);
    std::fprintf(stderr, "simulated runtime: %s\n", last.c_str());
}

}  // namespace simulated
