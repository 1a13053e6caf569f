// The three kinds of bench, and what they have in common.
#pragma once

#include "app/bench_plan.h"

namespace binosplat {

// A scene that is not there is found out before the others are measured. Throws Error naming it.
void requireScenes(const BenchPlan& plan);

}  // namespace binosplat
