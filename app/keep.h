// `convert --keep`: fewer splats, those that show most.
#pragma once

#include "app/options/options.h"
#include "engine/files/scene_targets.h"
#include "engine/geometry.h"
#include "engine/gpu/context.h"
#include "engine/levels/thin_out.h"

#include <memory>
#include <vector>

namespace binosplat {

// The device, and a scene on it, judged from some of the options' cameras or from where a person could stand.
// With progress on the terminal.
std::vector<Eye> judgingEyes(const ConvertOptions& options, const Scene& scene);

class JudgedScene {
public:
    JudgedScene(const ConvertOptions& options, const Scene& scene);

    // How many of the scene's splats `keep` leaves in such a file.
    [[nodiscard]] std::uint64_t countOf(const Keep& keep, const SceneTarget& target) const;
    [[nodiscard]] Scene keep(std::uint64_t count);

private:
    const Scene& scene_;
    Context context_;
    std::unique_ptr<ThinOut> thin_out_;
};

}  // namespace binosplat
