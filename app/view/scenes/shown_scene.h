// The scene that is shown, and the one on its way to take its place.
#pragma once

#include "app/terminal/frame_log.h"
#include "app/view/files/file_worker.h"
#include "app/view/scenes/scene_loader.h"
#include "app/view/settings/view_state.h"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

class ShownScene {
public:
    // Begins to load the scene of the options. `context`, `options` and `log` outlive this. With `ahead` a scene comes with its kernels.
    ShownScene(const Context& context, const ViewOptions& options, const FrameLog& log, std::optional<FramesAhead> ahead = {});

    // Null until the first one is there.
    [[nodiscard]] LoadedScene* get() const { return scene_.get(); }
    // The frame of whatever scene is shown, once there is one; and another one, made at the first call, for the insets of a headset that
    // takes some. Throws Error if the device lacks the memory.
    [[nodiscard]] StereoFrame& frame() const { return *frame_; }
    [[nodiscard]] StereoFrame& insets();
    void dropInsets() { insets_.reset(); }
    // Makes their kernels anew, see StereoFrame.
    void rebuildKernels();
    // Its name, or until it is there what was asked for.
    [[nodiscard]] const std::string& name() const { return scene_ ? scene_->name : asked_; }
    // Share done of the next one or, where none is on its way, of what the wearer sees of a streamed one; empty if that is all there.
    [[nodiscard]] std::optional<double> loading() const;
    // Whether a thread still loads anything, wanted or given up.
    [[nodiscard]] bool isLoading() const;
    // Ready to be taken; nobody makes kernels of the one that is shown any more.
    [[nodiscard]] bool isNextReady() const { return loader_ && loader_->isDone() && (!maker_ || maker_->isDone()); }
    // Whether drawable() waits for kernels.
    [[nodiscard]] bool isMakingKernels() const { return maker_ != nullptr; }

    // What the wearer sets for frames. The next scene comes with kernels for it; for the one that is shown they are made beside the frames,
    // unless the options have the scene loaded first, so that runs repeat.
    void expect(const StereoOptions& stereo, glm::uvec2 size_px, bool tint);
    // `settings`, or what is drawn in place of their method until its kernels are there.
    [[nodiscard]] ViewSettings drawable(ViewSettings settings) const;

    // Another one, beside the one that is shown, which stays until the other is there.
    void begin(const std::string& scene);
    // The one `step` further on in the folder of the one that was asked for last, once `files` has found it.
    void beginBeside(int step, FileWorker& files);
    // Shows the next one, waiting for it, and places the wearer: where it was left, where `state` was asked for, which is of the
    // first scene alone, or where the scene was saved. Returns what went wrong, empty if nothing did; throws it where that of the options
    // cannot be loaded and none is there to stay.
    [[nodiscard]] std::string take(ViewState& state);

private:
    [[nodiscard]] std::string place(ViewState& state);
    void showInFrames(const LoadedScene& scene);
    // By name: where the wearer stood when another scene took the place of one.
    std::map<std::string, Similarity> left_;
    void lookBeside(FileWorker& files);
    void haveReady(const FramesAhead& ahead);
    // Within a handler: the next one cannot be shown. Returns `why`, or throws on.
    [[nodiscard]] std::string goOnWithout(const std::string& why);

    const Context& context_;
    const ViewOptions& options_;
    const FrameLog& log_;
    std::optional<FramesAhead> ahead_;
    std::optional<FramesAhead> ready_;  // what the scene that is shown has kernels for
    std::string asked_;                 // the last one, whether it could be loaded or not
    std::uint64_t asked_count_ = 0;
    int steps_asked_ = 0;  // beside the last one, that were not looked for yet
    bool is_looking_ = false;
    std::unique_ptr<LoadedScene> scene_;
    std::unique_ptr<StereoFrame> frame_, insets_;  // of it
    std::unique_ptr<KernelMaker> maker_;           // likewise
    std::vector<std::unique_ptr<SceneLoader>> given_up_;
    std::unique_ptr<SceneLoader> loader_;  // last: its thread ends first
};

}  // namespace binosplat
