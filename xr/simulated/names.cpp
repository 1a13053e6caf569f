#include "xr/simulated/names.h"

#include <openxr/openxr_reflection.h>

namespace simulated {

#define SIMULATED_CASE(name, value) \
    case name:                      \
        return #name;

const char* nameOf(XrResult result) {
    switch (result) {
        XR_LIST_ENUM_XrResult(SIMULATED_CASE);
        default:
            return nullptr;
    }
}

const char* nameOf(XrStructureType type) {
    switch (type) {
        XR_LIST_ENUM_XrStructureType(SIMULATED_CASE);
        default:
            return nullptr;
    }
}

#define SIMULATED_WORD(name, value) \
    case name:                      \
        return #name + sizeof "XR_SESSION_STATE_" - 1;

const char* wordOf(XrSessionState state) {
    switch (state) {
        XR_LIST_ENUM_XrSessionState(SIMULATED_WORD);
        default:
            return nullptr;
    }
}

#undef SIMULATED_CASE
#undef SIMULATED_WORD

}  // namespace simulated
