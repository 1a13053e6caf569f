// The device that the options ask for.
#pragma once

#include "app/options/options.h"
#include "engine/gpu/context.h"

namespace binosplat {

inline ContextOptions contextOptions(const RunOptions& run) {
    ContextOptions options;
    options.device = run.device;
    options.memory_limit_bytes = run.memory_limit_mib << 20;
    return options;
}

}  // namespace binosplat
