// The device that the options ask for.
#pragma once

#include "app/options/options.h"
#include "engine/gpu/context.h"

namespace binosplat {

inline ContextOptions contextOptions(const RunOptions& run) {
    return {.device = run.device, .memory_limit_bytes = run.memory_limit_mib << 20};
}

}  // namespace binosplat
