// A scene that moves, as frames see it: the scene frame for a time, or an interpolation between two.
#pragma once

#include "engine/files/scene_series.h"
#include "engine/stream/live_scene.h"
#include "engine/stream/resident_scene.h"
#include "engine/stream/series_loader.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace binosplat {

struct MovingSettings {
    double rate_hz = 30.0;           // scene frames per second
    bool blend = false;              // interpolate between two frames, if their splats correspond
    std::uint64_t memory_bytes = 0;  // of the host, for frames that are read ahead; 0: SeriesLoader's default
    int threads = 1;                 // that read
    // How the scene is drawn; on any thread.
    std::function<void(Scene&, LoadNotes&)> draw_as = {};
};

class MovingScene final : public LiveScene {
public:
    // Reads the first frame; see notes(). Throws Error if it cannot be loaded, or the device does not have
    // enough memory for it.
    MovingScene(const Context& context, SceneSeries series, MovingSettings settings,
                const Progress& progress = {});

    [[nodiscard]] const std::string& name() const override { return series_.name(); }
    [[nodiscard]] const GpuScene& scene() const override { return resident_->scene(); }
    [[nodiscard]] const SceneTraits& traits() const override { return traits_; }
    [[nodiscard]] const SceneSeries& series() const { return series_; }
    // The length of the loop.
    [[nodiscard]] double seconds() const { return static_cast<double>(series_.size()) / settings_.rate_hz; }
    [[nodiscard]] double rateHz() const { return settings_.rate_hz; }
    // The frame for a time, 0 .. size() - 1.
    [[nodiscard]] std::size_t frameAt(double time_s) const { return momentAt(time_s).frame; }
    // The first frame, to find out how the scene lies; can be taken once.
    [[nodiscard]] Scene takeFirst() { return std::move(first_); }
    [[nodiscard]] const LoadNotes& notes() const { return notes_; }

    // Times before or after the loop are mapped into it.
    void setTime(double time_s) override { time_s_ = time_s; }
    void update(std::span<const Eye> eyes, double step_seconds) override;
    void settle(std::span<const Eye> eyes, const Progress& progress = {}) override;
    [[nodiscard]] bool isSettled() const override;
    [[nodiscard]] double share() const override { return 1.0; }
    [[nodiscard]] StreamCounters counters() const override;
    // Broken files are reported here only for display, which never waits: settle() throws if something that
    // it needs is missing.
    [[nodiscard]] std::vector<std::string> takeLines(Waits waits) override;

private:
    // A scene frame, and how far it is on the way to the next.
    struct Moment {
        std::size_t frame = 0;
        float share = 0.0f;
        bool operator==(const Moment&) const = default;
    };
    // A step from what is shown to another moment.
    struct Step {
        Moment moment;
        FrameStep frame;
    };
    struct Question {
        Moment moment;
        SeriesLoader::Held first, second;  // `second` is null if nothing is interpolated
    };

    [[nodiscard]] Moment momentAt(double time_s) const;
    [[nodiscard]] std::size_t sceneAfter(std::size_t frame) const;
    [[nodiscard]] bool isBetween(Moment moment) const;
    [[nodiscard]] Step stepTo(const Question& question) const;
    // The question, once everything that the moment needs has been read.
    [[nodiscard]] std::optional<Question> questionFor(Moment moment) const;
    void wantFrom(std::size_t frame);
    void ask(Moment moment);
    // Waits for a step that is being made, and drops it.
    void dropSteps();
    // Why there is no capacity for a step; empty if there is.
    [[nodiscard]] std::string noCapacityFor(const Step& step) const;
    void take(Step&& step);

    const Context& context_;
    SceneSeries series_;
    MovingSettings settings_;
    Scene first_;
    LoadNotes notes_;
    SceneTraits traits_;
    std::unique_ptr<SeriesLoader> loader_;
    std::unique_ptr<ResidentScene> resident_;
    std::vector<ResidentScene::Part> parts_;  // by page
    std::vector<std::string> lines_;          // for takeLines
    SceneFrame shown_;                        // not touched while is_asked_: the thread reads it
    Moment moment_;                           // of what is shown
    double time_s_ = 0.0, told_s_ = 0.0;
    std::optional<std::size_t> late_, wanted_from_;
    std::uint64_t late_count_ = 0;
    bool is_asked_ = false;                         // and has not been answered yet
    bool is_stale_ = false;                         // and the time has been set since
    std::optional<Step> next_;                      // none while is_asked_
    std::optional<Mailbox<Question, Step>> steps_;  // last
};

}  // namespace binosplat
