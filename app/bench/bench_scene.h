// A scene as `bench` measures it: whole on the device, or streamed where the options have it so.
#pragma once

#include "app/load.h"
#include "engine/gpu/gpu_scene.h"

#include <optional>
#include <string>

namespace binosplat {

class BenchScene {
public:
    BenchScene(const Context& context, const RunOptions& run, const std::string& source, std::uint64_t builtin_splats = 0)
        : streamed_(mayStream(source, run.load) ? openStreamed(context, source, run, StreamFor::kPictures) : std::nullopt) {
        if (streamed_) { return; }
        scene_ = loadAs(run, source, builtin_splats);
        whole_.emplace(context, scene_);
    }

    // All of it on the host, or its coarsest level.
    [[nodiscard]] const Scene& scene() const { return streamed_ ? streamed_->coarsest : scene_; }
    [[nodiscard]] const GpuScene& gpuScene() const { return whole_ ? *whole_ : streamed_->stream->scene(); }
    // Null where it is whole.
    [[nodiscard]] SceneStream* stream() const { return streamed_ ? streamed_->stream.get() : nullptr; }

private:
    std::optional<StreamedScene> streamed_;
    Scene scene_;
    std::optional<GpuScene> whole_;
};

}  // namespace binosplat
