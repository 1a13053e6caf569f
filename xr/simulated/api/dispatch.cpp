// Functions by name. Those of an extension exist only for instances that enabled it.
#include <cstring>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/instance.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

struct Entry {
    const char* name;
    PFN_xrVoidFunction function;
    const char* extension;
    bool is_1_1 = false;
};

const Entry kEntries[] = {
#define SIMULATED_ENTRY(name) {#name, reinterpret_cast<PFN_xrVoidFunction>(&name), nullptr},
#define SIMULATED_1_1_ENTRY(name) {#name, reinterpret_cast<PFN_xrVoidFunction>(&name), nullptr, true},
#define SIMULATED_EXTENSION_ENTRY(name, extension) \
    {#name, reinterpret_cast<PFN_xrVoidFunction>(&name), extension},
    SIMULATED_CORE_FUNCTIONS(SIMULATED_ENTRY) SIMULATED_CORE_1_1_FUNCTIONS(SIMULATED_1_1_ENTRY)
        SIMULATED_EXTENSION_FUNCTIONS(SIMULATED_EXTENSION_ENTRY)
#undef SIMULATED_ENTRY
#undef SIMULATED_1_1_ENTRY
#undef SIMULATED_EXTENSION_ENTRY
};

// Functions that exist without an instance.
bool needsNoInstance(const char* name) {
    for (const char* candidate :
         {"xrEnumerateInstanceExtensionProperties", "xrEnumerateApiLayerProperties", "xrCreateInstance"}) {
        if (std::strcmp(name, candidate) == 0) { return true; }
    }
    return false;
}

}  // namespace

XrResult xrGetInstanceProcAddr(XrInstance instance, const char* name, PFN_xrVoidFunction* function) {
    return answer(__func__, [&] {
        PFN_xrVoidFunction& output = checkOutput(function);
        output = nullptr;
        require(name != nullptr, XR_ERROR_VALIDATION_FAILURE, "a name is missing");
        const Instance* owner = nullptr;
        if (instance != XR_NULL_HANDLE) {
            owner = &get<Instance>(instance);
        } else {
            require(needsNoInstance(name), XR_ERROR_HANDLE_INVALID, name, " needs an instance");
        }
        for (const Entry& entry : kEntries) {
            if (std::strcmp(entry.name, name) != 0) { continue; }
            if (entry.extension != nullptr && !owner->extensions.contains(entry.extension)) { break; }
            if (entry.is_1_1 && !owner->is_1_1) { break; }
            output = entry.function;
            return XR_SUCCESS;
        }
        refuse(XR_ERROR_FUNCTION_UNSUPPORTED, name,
               ": no such function, or its extension or version was not asked for");
    });
}

}  // namespace simulated
