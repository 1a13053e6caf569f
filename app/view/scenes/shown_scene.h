// The scene that is shown, another one that it is compared with, and those that are loading to replace them.
#pragma once

#include "app/terminal/frame_log.h"
#include "app/view/files/file_worker.h"
#include "app/view/files/picture_shot.h"
#include "app/view/scenes/frame_maker.h"
#include "app/view/scenes/scene_loader.h"
#include "app/view/settings/view_state.h"
#include "engine/error.h"
#include "engine/ready.h"

#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// Images for some settings: their size, and whether frames may be drawn into them without a wait.
struct ImagesFor {
    glm::uvec2 size_px{0, 0};
    bool are_there = false;
};

class ShownScene {
public:
    // Begins to load the scene of the options. `context`, `options` and `log` must outlive this. With
    // `ahead`, scenes come with their kernels.
    ShownScene(const Context& context, const ViewOptions& options, const FrameLog& log,
               std::optional<FramesAhead> ahead = {});

    // Null until the first scene is loaded.
    [[nodiscard]] LoadedScene* get() const { return shown_.scene.get(); }
    // The one that frames draw: the same, or the other one of a comparison, see draw().
    [[nodiscard]] LoadedScene* drawn() const { return drawing().scene.get(); }
    // The frame of the scene that is drawn, once there is one; and another one, made at the first call, for
    // the insets of a headset that has them. Throws Error if the device lacks the memory.
    [[nodiscard]] StereoFrame& frame() const { return *drawing().frames.frame; }
    [[nodiscard]] StereoFrame& insets();
    void dropInsets() { shown_.frames.insets.reset(), other_.frames.insets.reset(); }
    // Of the drawn scene; to be taken before another one is.
    [[nodiscard]] PictureShot shotOf(std::vector<Eye> eyes, const FrameSettings& settings) const {
        return {context_, drawing().scene->gpu_scene, std::move(eyes), settings};
    }
    // Makes their kernels anew, see StereoFrame.
    void rebuildKernels();
    // The scene's name or, until it is loaded, that of the requested one; with the other one's, if there is
    // one.
    [[nodiscard]] const std::string& name() const { return shown_.scene ? shown_.scene->name : asked_; }
    [[nodiscard]] std::string names() const;
    // The share done of the next scene or, if none is loading, of the visible part of a streamed one; empty
    // if all of that is loaded.
    [[nodiscard]] std::optional<double> loading() const;
    // True if a thread still loads or compiles anything, wanted or given up.
    [[nodiscard]] bool isLoading() const;
    // True if it can be taken, and no thread makes kernels for the current one any more.
    [[nodiscard]] bool isNextReady() const { return next_.isLoaded() && (!maker_ || maker_->isDone()); }
    // The same for the other scene of a comparison.
    [[nodiscard]] bool isOtherReady() const {
        return shown_.scene && other_next_.isLoaded() && (!maker_ || maker_->isDone());
    }
    // Nothing of what was asked for at the start is missing.
    [[nodiscard]] bool isComplete() const {
        return shown_.scene && compared_next_.empty() && !other_next_.loader;
    }

    // Such a scene for which no frames have been made: where the wearer would stand in it. Empty if there is
    // none.
    [[nodiscard]] std::optional<Similarity> placeWithoutFrames(const ViewState& state) const;
    // Makes frames like these of that scene on a thread, so that taking it, and showing it, needs no wait.
    void makeFrames(FramesWanted wanted);
    // Ready to be taken without a wait.
    [[nodiscard]] bool isNextMet() const { return isNextReady() && next_.isMet(); }
    [[nodiscard]] bool isOtherMet() const { return isOtherReady() && other_next_.isMet(); }
    // True while kernels or frames for drawable() are being made.
    [[nodiscard]] bool isMakingMethod() const {
        return maker_ != nullptr || shown_.remade.valid() || other_.remade.valid();
    }

    // The wearer's settings of frames. The next scene comes with kernels for them; for the current one they
    // are made beside the frames, and then remakeFrames() is due, unless the options have the scene loaded
    // first, so that runs are repeatable. Before each frame.
    // `images` are those for the settings, `size_px` is what an eye sees in them.
    void expect(const ViewSettings& asked, glm::uvec2 size_px, const ImagesFor& images);
    // `settings`, with the method, the resolution and axes replaced by those that are drawn until kernels,
    // frames and images are ready.
    [[nodiscard]] ViewSettings drawable(ViewSettings settings) const;
    // After each frame's preparation: its frames have memory for these settings, or no pictures at all.
    void keepDrawn(const ViewSettings& drawn, glm::uvec2 images_px);
    void forgetDrawn() { drawing().met.reset(); }
    // Where the eyes of the drawn scene are in one whose frames are of another method than is expected, or
    // for images of another size; empty if there is none.
    [[nodiscard]] std::optional<Similarity> toRemake() const;
    // Makes frames of that one on a thread; a later expect() exchanges them for those that it has.
    void remakeFrames(FramesWanted wanted);
    // True if lists have capacity for frames of this size, see StereoFrame.
    [[nodiscard]] bool growFor(glm::uvec2 size_px, glm::uvec2 inset_px);

    // Begins to load another scene, and then `compared`, if given, to compare with it; the current one stays
    // until that is loaded. If the next scene is to be compared with the current one, it does that instead.
    void begin(const std::string& scene, const std::string& compared = {});
    // The same for the scene `step` further on in the folder of the last requested one, once `files` has
    // found it.
    void beginBeside(int step, FileWorker& files);
    // Waits for the next scene, shows it (or, where it lacks memory beside the one shown, has that one go and
    // begins again: then there is none for a while) and places the wearer: where they left it, where `state`
    // was asked for (only for the first scene), or where the scene was saved. Returns what went wrong, or
    // empty; throws it if the options' scene cannot be loaded and there is no other to stay with.
    [[nodiscard]] std::string take(ViewState& state);

    // A scene of the same place that the shown one is compared with; null: none. It goes when another scene
    // is shown.
    [[nodiscard]] LoadedScene* other() const { return other_.scene.get(); }
    [[nodiscard]] StereoFrame& otherFrame() const { return *other_.frames.frame; }
    // Of the shown scene's eyes and placements, in the coordinates of the other one: both count from origins
    // of their own.
    [[nodiscard]] glm::dvec3 otherFromShown() const { return shown_.scene->origin - other_.scene->origin; }
    // Ends the comparison or, if there is none, has the next scene that is begun compared with this one, or
    // no more. Says so in a line.
    [[nodiscard]] std::string toggleComparison();
    [[nodiscard]] bool comparesNext() const { return compares_next_; }
    // Waits for the other scene. Returns what went wrong, and then there is no comparison, or empty.
    [[nodiscard]] std::string takeOther();
    // The other one cannot be drawn after all, and goes. Returns why, in a line.
    [[nodiscard]] std::string goOnAlone(const Error& error);
    // Before frames of it are shown: makes what such frames need, and draws two, so that showing it needs no
    // wait. Does nothing if there is no other scene, or if frames are as they were. The eyes are those of the
    // shown one. Throws Error if the device lacks the memory.
    void meetOther(std::span<const Eye> eyes, const FrameSettings& frame, std::span<const Eye> inset_eyes,
                   const FrameSettings& inset);
    // From now on frames draw the other scene, if there is one, or the shown one again. No frame has a
    // history across such a cut.
    void draw(bool other);
    [[nodiscard]] bool drawsOther() const { return draws_other_; }
    // In the coordinates of the drawn scene.
    [[nodiscard]] Similarity drawnFrom(Similarity scene_from_room) const;
    [[nodiscard]] std::vector<Eye> seenFromDrawn(std::vector<Eye> eyes) const;
    // Before a frame of these eyes of the drawn scene: both request what they need, and both move on. Never
    // waits.
    void follow(std::span<const Eye> eyes, double step_seconds);
    // If it moves: plays or pauses it, steps, or goes to a frame, as asked.
    void moveTime(bool play, int step, std::optional<std::size_t> frame);
    // In each frame: the scene that is not drawn waits for its own frame before the last, as the drawn one
    // does; and so do those that are shown no more. If `nothing` is drawn, all do.
    void passOver(bool nothing = false);
    // Instead, for those that are shown no more: waits until they are freed.
    void freeGone();

private:
    // A scene, and the frames that show it.
    struct Held {
        std::unique_ptr<LoadedScene> scene;
        SceneFrames frames;                // before the scene goes, they wait for the device
        std::optional<FramesAhead> ready;  // the frames that there are kernels for
        std::optional<FramesAhead> met;    // and those that there is memory for; absent: not known
        std::optional<FramesAhead> remade_for;
        std::future<RemadeFrames> remade;  // last: its thread reads the scene

        [[nodiscard]] bool hasRemade() const { return isReady(remade); }
    };
    // A scene that loads, and then its frames.
    struct Coming {
        std::unique_ptr<SceneLoader> loader;  // null: there is none
        std::optional<FramesAhead> like;      // the frames that it is to have; absent: not known
        std::future<SceneFrames> frames;      // that are made; its thread ends before the loader's scene goes

        [[nodiscard]] bool isLoaded() const { return loader && loader->isDone(); }
        [[nodiscard]] bool hasMade() const { return isReady(frames); }
        [[nodiscard]] bool isMaking() const { return frames.valid() && !hasMade(); }
        // It could not be loaded, or there are frames of it.
        [[nodiscard]] bool isMet() const { return loader->loaded() == nullptr || hasMade(); }
    };
    // One that is shown no more, which frames on the device may still read.
    struct Leaving {
        Held held;
        int frames_left = 2;
    };
    [[nodiscard]] const Held& drawing() const { return draws_other_ ? other_ : shown_; }
    [[nodiscard]] Held& drawing() { return draws_other_ ? other_ : shown_; }
    [[nodiscard]] Held& resting() { return draws_other_ ? shown_ : other_; }
    void load(const std::string& scene);
    [[nodiscard]] std::unique_ptr<SceneLoader> makeLoader(const std::string& scene, RunOptions options);
    // The one of these for which frames are made next; null: none.
    [[nodiscard]] const Coming* lacksFrames() const;
    // Empty if none were made, or if the device lacks the memory for them and those that are shown.
    [[nodiscard]] static SceneFrames takeFrames(Coming& coming);
    [[nodiscard]] bool isPlaceGiven(const LoadedScene& scene) const;
    [[nodiscard]] Similarity placementOf(const LoadedScene& scene, const ViewState& state) const;
    // Nobody waits for that one.
    void giveUp(Coming& coming);
    void forgetGivenUp();
    // It is freed on a thread, once frames are over that may read it.
    void letGo(Held& held);
    void beginOther(const std::string& scene);
    void dropOther();
    [[nodiscard]] std::string place(ViewState& state);
    void showInFrames(const LoadedScene& scene);
    // By place: where the wearer stood when another scene replaced this one.
    std::map<std::string, Similarity> left_;
    void lookBeside(FileWorker& files);
    void haveReady(Held& held, const FramesAhead& ahead);
    [[nodiscard]] bool hasExpectedFrames(const Held& held) const {
        return !held.scene || !held.met || held.met->hasFramesOf(*ahead_);
    }
    // While a scene loads, no other kernels are made; those of another size are then made with the frames.
    [[nodiscard]] bool lacksNewFrames(const Held& held) const {
        const bool loads = next_.loader || other_next_.loader;
        return !hasExpectedFrames(held) && !held.remade.valid() &&
               (loads ? held.ready->hasMethodOf(*ahead_) : held.ready->isLike(*ahead_));
    }
    // Both scenes' frames are exchanged at once, since they are drawn into the same images.
    void takeRemade();
    // If there are new ones: frames of the scene go on with them.
    void takeRemade(Held& held);
    // Eyes of the drawn scene, as the other one counts.
    [[nodiscard]] std::vector<Eye> seenFromResting(std::span<const Eye> eyes) const;
    // Within a handler: the next scene cannot be shown. Returns `why`, or rethrows.
    [[nodiscard]] std::string goOnWithout(const std::string& why);
    // What is shown goes, so that the scene that was asked for has its memory, and that one is loaded again;
    // says so.
    [[nodiscard]] std::string makeWay(const ViewState& state);

    const Context& context_;
    const ViewOptions& options_;
    const FrameLog& log_;
    PassKernels kernels_;  // of all frames
    std::optional<FramesAhead> ahead_;
    std::string asked_;          // the scene asked for last, even if it could not be loaded
    std::string compared_next_;  // with it, once it is shown; empty: none
    std::uint64_t asked_count_ = 0;
    int steps_asked_ = 0;  // from that one, not looked for yet
    bool is_looking_ = false;
    std::string gone_first_;             // the scene that made way for that one, if any
    std::unique_ptr<GpuScene> nothing_;  // that frames show meanwhile
    std::string other_name_;
    bool compares_next_ = false, draws_other_ = false;
    Held shown_, other_;
    std::vector<Leaving> leaving_;
    std::vector<std::future<void>> freeing_;
    Held* made_for_ = nullptr;            // the one of the first two that kernels are made for
    std::unique_ptr<KernelMaker> maker_;  // for that one
    std::vector<Coming> given_up_;
    Coming next_, other_next_;  // last: their threads end first
};

}  // namespace binosplat
