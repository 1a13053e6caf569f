// A scene as `bench` measures it: whole on the device, streamed if the options say so, or moving.
#pragma once

#include "app/load.h"
#include "engine/gpu/gpu_scene.h"

#include <optional>
#include <string>

namespace binosplat {

class BenchScene {
public:
    BenchScene(const Context& context, const RunOptions& run, const std::string& source,
               std::uint64_t builtin_splats = 0)
        : opened_(builtin_splats == 0 && mayLive(source, run.load)
                      ? openLive(context, source, run, StreamFor::kPictures)
                      : std::nullopt) {
        if (opened_) { return; }
        scene_ = loadAs(run, source, builtin_splats);
        whole_.emplace(context, scene_);
    }

    // The whole scene on the host, its coarsest level, or its first frame.
    [[nodiscard]] const Scene& scene() const { return opened_ ? opened_->sample : scene_; }
    [[nodiscard]] const GpuScene& gpuScene() const { return whole_ ? *whole_ : opened_->live->scene(); }
    [[nodiscard]] bool moves() const { return opened_ && opened_->moving != nullptr; }
    // Null if it is whole.
    [[nodiscard]] LiveScene* live() const { return opened_ ? opened_->live.get() : nullptr; }

private:
    std::optional<OpenedScene> opened_;
    Scene scene_;
    std::optional<GpuScene> whole_;
};

}  // namespace binosplat
