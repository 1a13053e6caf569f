// The scene that is shown, where the wearer stands in it, and the one on its way to take its place.
#pragma once

#include "app/view/frame_log.h"
#include "app/view/scenes/scene_loader.h"
#include "app/view/view_settings.h"

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
    // Its name, or until it is there what was asked for.
    [[nodiscard]] const std::string& name() const { return scene_ ? scene_->name : asked_; }
    // Share done of the next one; empty if none is on its way.
    [[nodiscard]] std::optional<double> loading() const;
    // Whether a thread still loads anything, wanted or given up.
    [[nodiscard]] bool isLoading() const;
    [[nodiscard]] bool isNextReady() const { return loader_ && loader_->isDone(); }

    // Another one, beside the one that is shown, which stays until the other is there.
    void begin(const std::string& scene);
    // The one `step` further on in the folder of the one that was asked for last.
    void beginBeside(int step);
    // Shows the next one, waiting for it, and places the wearer: where it was left, where `settings` say, which are of the first scene
    // alone, or where the scene was saved. Returns what went wrong, empty if nothing did; throws it where that of the options cannot be
    // loaded and none is there to stay.
    [[nodiscard]] std::string take(ViewSettings& settings);

    Similarity scene_from_room;

private:
    [[nodiscard]] std::string place(ViewSettings& settings);
    // By name: where the wearer stood when another scene took the place of one.
    std::map<std::string, Similarity> left_;
    // Within a handler: the next one cannot be shown. Returns `why`, or throws on.
    [[nodiscard]] std::string goOnWithout(const std::string& why);

    const Context& context_;
    const ViewOptions& options_;
    const FrameLog& log_;
    std::optional<FramesAhead> ahead_;
    std::string asked_;  // the last one, whether it could be loaded or not
    std::unique_ptr<LoadedScene> scene_;
    std::vector<std::unique_ptr<SceneLoader>> given_up_;
    std::unique_ptr<SceneLoader> loader_;  // last: its thread ends first
};

}  // namespace binosplat
