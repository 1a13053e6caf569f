// The subcommands except `bench` and `view`, which have folders of their own. Each throws Error; none catches
// one.
#pragma once

#include "app/options/options.h"

namespace binosplat {

void runRender(const RenderOptions& options);
void runInfo(const InfoOptions& options);
void runScene(const SceneOptions& options);
void runConvert(const ConvertOptions& options);
void runCompare(const CompareOptions& options);
void runKernels(const KernelsOptions& options);
void runStability(const StabilityOptions& options);

}  // namespace binosplat
