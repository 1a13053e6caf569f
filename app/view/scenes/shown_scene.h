// The scene that is shown, and the one that is loading to replace it.
#pragma once

#include "app/terminal/frame_log.h"
#include "app/view/files/file_worker.h"
#include "app/view/scenes/scene_loader.h"
#include "app/view/settings/view_state.h"

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

class ShownScene {
public:
    // Begins to load the scene of the options. `context`, `options` and `log` outlive this. With `ahead`
    // scenes come with their kernels.
    ShownScene(const Context& context, const ViewOptions& options, const FrameLog& log, std::optional<FramesAhead> ahead = {});

    // Null until the first scene is loaded.
    [[nodiscard]] LoadedScene* get() const { return scene_.get(); }
    // The frame of whatever scene is shown, once there is one; and another one, made at the first call, for
    // the insets of a headset that has them. Throws Error if the device lacks the memory.
    [[nodiscard]] StereoFrame& frame() const { return *frame_; }
    [[nodiscard]] StereoFrame& insets();
    void dropInsets() { insets_.reset(); }
    // What these eyes see of the scene now, by a frame of its own: those under way go on as they were. Waits
    // for the device. Throws Error if it lacks the memory.
    [[nodiscard]] std::vector<Image> picturesOf(std::span<const Eye> eyes, const FrameSettings& settings);
    // Makes their kernels anew, see StereoFrame.
    void rebuildKernels();
    // The scene's name or, until it is loaded, that of the requested one.
    [[nodiscard]] const std::string& name() const { return scene_ ? scene_->name : asked_; }
    // The share done of the next scene or, if none is loading, of the visible part of a streamed one; empty
    // if all of that is loaded.
    [[nodiscard]] std::optional<double> loading() const;
    // True if a thread still loads or compiles anything, wanted or given up.
    [[nodiscard]] bool isLoading() const;
    // True if it can be taken, and no thread makes kernels for the current one any more.
    [[nodiscard]] bool isNextReady() const { return loader_ && loader_->isDone() && (!maker_ || maker_->isDone()); }
    // True while kernels for drawable() are being made.
    [[nodiscard]] bool isMakingKernels() const { return maker_ != nullptr; }

    // The wearer's settings of frames. The next scene comes with kernels for them; for the current one they
    // are made beside the frames, unless the options have the scene loaded first, so that runs are
    // repeatable.
    void expect(const StereoOptions& stereo, glm::uvec2 size_px, bool tint);
    // `settings`, with the method replaced by one that can be drawn until its kernels are ready.
    [[nodiscard]] ViewSettings drawable(ViewSettings settings) const;

    // Begins to load another scene; the current one stays until that is loaded.
    void begin(const std::string& scene);
    // The same for the scene `step` further on in the folder of the last requested one, once `files` has
    // found it.
    void beginBeside(int step, FileWorker& files);
    // Waits for the next scene, shows it (or, where it lacks memory beside the one shown, has that one go and
    // begins again: then there is none for a while) and places the wearer: where they left it, where `state`
    // was asked for (only for the first scene), or where the scene was saved. Returns what went wrong, or
    // empty; throws it if the options' scene cannot be loaded and there is no other to stay with.
    [[nodiscard]] std::string take(ViewState& state);

private:
    [[nodiscard]] std::string place(ViewState& state);
    void showInFrames(const LoadedScene& scene);
    // By place: where the wearer stood when another scene replaced this one.
    std::map<std::string, Similarity> left_;
    void lookBeside(FileWorker& files);
    void haveReady(const FramesAhead& ahead);
    // Within a handler: the next scene cannot be shown. Returns `why`, or rethrows.
    [[nodiscard]] std::string goOnWithout(const std::string& why);
    // What is shown goes, so that the scene that was asked for has its memory, and that one is loaded again;
    // says so.
    [[nodiscard]] std::string makeWay(const ViewState& state);

    const Context& context_;
    const ViewOptions& options_;
    const FrameLog& log_;
    std::optional<FramesAhead> ahead_;
    std::optional<FramesAhead> ready_;  // the frames that the current scene has kernels for
    std::string asked_;                 // the scene asked for last, even if it could not be loaded
    std::uint64_t asked_count_ = 0;
    int steps_asked_ = 0;  // from that one, not looked for yet
    bool is_looking_ = false;
    std::string gone_first_;             // the scene that made way for that one, if any
    std::unique_ptr<GpuScene> nothing_;  // that frames show meanwhile
    std::unique_ptr<LoadedScene> scene_;
    std::unique_ptr<StereoFrame> frame_, insets_;  // of the current scene
    std::unique_ptr<KernelMaker> maker_;           // for the current scene
    std::vector<std::unique_ptr<SceneLoader>> given_up_;
    std::unique_ptr<SceneLoader> loader_;  // last: its thread ends first
};

}  // namespace binosplat
