#include "xr/simulated/answer.h"

#include <cstdio>
#include <cstdlib>

#include "xr/simulated/names.h"

namespace simulated {

std::mutex& runtimeLock() {
    static std::mutex lock;
    return lock;
}

void explain(const char* function, const Refusal& refusal) {
    // A failure of the runtime itself is always said: no application can know what to do about it. The loader asks for every function
    // that it has heard of; that is no mistake of the application's.
    const bool is_wanted = std::getenv("BINOSPLAT_SIMULATED_EXPLAIN") != nullptr && refusal.result != XR_ERROR_FUNCTION_UNSUPPORTED;
    if (!is_wanted && refusal.result != XR_ERROR_RUNTIME_FAILURE) return;
    std::fprintf(stderr, "simulated runtime: %s: %s: %s\n", function, nameOf(refusal.result), refusal.reason);
}

void explainFailure(const char* function, const char* what) { std::fprintf(stderr, "simulated runtime: %s: %s\n", function, what); }

}  // namespace simulated
