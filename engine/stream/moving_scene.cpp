// Finds the scene frames for a time, and brings them to the device.
#include "engine/stream/moving_scene.h"

#include "engine/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace binosplat {
namespace {

// A time at which a frame should begin may be slightly before it.
constexpr double kHairFrames = 1e-4;
// If the time advances by more than this, or goes back, it was set.
constexpr double kMostStepSeconds = 0.5;
// For frames with more splats than the sizes of files suggest.
constexpr double kSpareCapacity = 1.25;
constexpr std::uint32_t kSparePages = 8;

}  // namespace

MovingScene::MovingScene(const Context& context, SceneSeries series, MovingSettings settings,
                         const Progress& progress)
    : context_(context), series_(std::move(series)), settings_(std::move(settings)) {
    const auto drawn = [this](Scene scene, LoadNotes& notes) {
        if (settings_.draw_as) { settings_.draw_as(scene, notes); }
        return scene;
    };
    first_ = drawn(series_.load(series_.sceneOf(0), notes_, progress), notes_);
    notes_.lines.insert(notes_.lines.end(), series_.lines().begin(), series_.lines().end());
    traits_ = traitsOf(first_);
    SeriesLoader::Settings reading;
    if (settings_.memory_bytes > 0) { reading.most_bytes = settings_.memory_bytes; }
    reading.threads = settings_.threads;
    loader_ = std::make_unique<SeriesLoader>(
        [this, drawn](std::size_t scene) {
            LoadNotes ignored;
            return drawn(series_.load(scene, ignored), ignored);
        },
        series_.sceneCount(), traits_, reading);
    shown_ = makeSceneFrame(first_, traits_);
    const auto pages = static_cast<double>(shown_.size());
    ResidentScene::Options options;
    options.capacity_pages =
        static_cast<std::uint32_t>(std::min(pages * series_.growth() * kSpareCapacity,
                                            double{gpu::kMaxItems / gpu::kPageSplats} - kSparePages)) +
        kSparePages;
    // A scene frame is shown as a whole, or not yet.
    options.most_bytes_a_frame = options.capacity_pages * ChunkLayout(gpu::kPageSplats, traits_).bytes;
    resident_ = std::make_unique<ResidentScene>(context_, traits_, options);
    for (const PackedPages& page : shown_) { parts_.push_back(resident_->add(PackedPages(page)).value()); }
    wantFrom(0);
    steps_.emplace([this](const Question& question) { return stepTo(question); });
}

MovingScene::Moment MovingScene::momentAt(double time_s) const {
    const auto frames = static_cast<double>(series_.size());
    double place = time_s * settings_.rate_hz;
    place -= frames * std::floor(place / frames);
    const double frame = std::floor(place + kHairFrames);
    if (frame >= frames) { return {}; }
    const bool is_between = settings_.blend && place - frame > kHairFrames;
    return {static_cast<std::size_t>(frame), is_between ? static_cast<float>(place - frame) : 0.0f};
}

// A loop of files need not end as it begins.
std::size_t MovingScene::sceneAfter(std::size_t frame) const {
    return series_.sceneOf(std::min(frame + 1, series_.size() - 1));
}

bool MovingScene::isBetween(Moment moment) const {
    return moment.share > 0.0f && sceneAfter(moment.frame) != series_.sceneOf(moment.frame);
}

void MovingScene::wantFrom(std::size_t frame) {
    if (wanted_from_ == frame) { return; }
    std::vector<std::size_t> scenes;
    for (std::size_t i = 0; i < series_.size(); ++i) {
        const std::size_t scene = series_.sceneOf((frame + i) % series_.size());
        if (scenes.empty() || scenes.back() != scene) { scenes.push_back(scene); }
    }
    if (scenes.size() > 1 && scenes.back() == scenes.front()) { scenes.pop_back(); }
    if (loader_->tryWant(scenes)) { wanted_from_ = frame; }
}

std::optional<MovingScene::Question> MovingScene::questionFor(Moment moment) const {
    Question question{moment, loader_->tryGet(series_.sceneOf(moment.frame)), nullptr};
    if (!question.first) { return std::nullopt; }
    if (!isBetween(moment)) { return question; }
    question.second = loader_->tryGet(sceneAfter(moment.frame));
    // Frames that cannot be loaded are not waited for.
    if (!question.second && !loader_->isSurelyBroken(sceneAfter(moment.frame))) { return std::nullopt; }
    return question;
}

MovingScene::Step MovingScene::stepTo(const Question& question) const {
    const SceneFrame* const next = question.second ? &question.second->splats : nullptr;
    return {question.moment,
            stepBetween(shown_, question.first->splats, traits_, next, question.moment.share)};
}

void MovingScene::ask(Moment moment) {
    if (std::optional<Question> question = questionFor(moment)) {
        is_asked_ = steps_->ask(*std::move(question));
    }
}

void MovingScene::dropSteps() {
    if (is_asked_) { (void)steps_->waitForAnswer(); }
    next_.reset();
    is_asked_ = is_stale_ = false;
}

std::string MovingScene::noCapacityFor(const Step& step) const {
    const std::uint64_t room = std::uint64_t{resident_->capacityPages()} * gpu::kPageSplats;
    if (step.frame.splats <= room) { return {}; }
    return fmt::format("{}: has {} splats, there is room for {}, going by the sizes of the files",
                       series_.nameOf(series_.sceneOf(step.moment.frame)), step.frame.splats, room);
}

void MovingScene::take(Step&& step) {
    moment_ = step.moment;
    if (const std::string trouble = noCapacityFor(step); !trouble.empty()) {
        lines_.push_back(trouble + "; it is left out");
        return;
    }
    for (const std::uint32_t page : step.frame.pages) {
        if (page < parts_.size()) { resident_->remove(parts_[page], ResidentScene::Note::kNone); }
    }
    shown_.resize((step.frame.splats + gpu::kPageSplats - 1) / gpu::kPageSplats);
    parts_.resize(shown_.size());
    // The lowest free places are those of these pages: splats keep their order.
    for (std::size_t i = 0; i < step.frame.now.size(); ++i) {
        const std::uint32_t page = step.frame.pages[i];
        shown_[page] = std::move(step.frame.now[i]);
        parts_[page] = resident_->add(PackedPages(shown_[page]), 1.0f, ResidentScene::Note::kNone).value();
    }
    for (const SceneChange& change : step.frame.changes) { resident_->note(change); }
}

void MovingScene::update(std::span<const Eye> /*eyes*/, double /*step_seconds*/) {
    const double passed_s = time_s_ - std::exchange(told_s_, time_s_);
    const bool goes_on = passed_s >= 0.0 && passed_s <= kMostStepSeconds;
    const double step_s = goes_on ? passed_s : 0.0;
    const Moment now = momentAt(time_s_);
    wantFrom(now.frame);
    if (!goes_on) {
        is_stale_ = is_asked_;
        next_.reset();
    }
    if (std::optional<Step> step = steps_->take()) {
        is_asked_ = false;
        if (!std::exchange(is_stale_, false)) { next_ = std::move(step); }
    }

    const auto frames = static_cast<double>(series_.size());
    const auto placeOf = [](Moment moment) {
        return static_cast<double>(moment.frame) + static_cast<double>(moment.share);
    };
    // How far one moment is behind another, the shorter way around the loop.
    const auto behind = [&](Moment moment, Moment other) {
        const double distance = placeOf(other) - placeOf(moment);
        return distance - frames * std::round(distance / frames);
    };
    const double early = settings_.blend ? 0.5 * step_s * settings_.rate_hz + kHairFrames : 0.0;
    if (next_ && behind(next_->moment, now) >= -early) { take(*std::exchange(next_, std::nullopt)); }
    const bool is_broken = loader_->isSurelyBroken(series_.sceneOf(now.frame));
    const bool is_late = settings_.blend ? std::abs(behind(moment_, now)) >= 1.0 : moment_.frame != now.frame;
    if (is_late && !is_broken && late_ != now.frame) {
        late_ = now.frame;
        ++late_count_;
    }
    Moment following = momentAt(time_s_ + step_s);
    if (!settings_.blend && following.frame == now.frame && (moment_.frame == now.frame || is_broken)) {
        following.frame = (now.frame + 1) % series_.size();
    }
    // A step to a later time than that was prepared for another pace.
    if (next_ && behind(following, next_->moment) > kHairFrames) { next_.reset(); }
    if (!next_ && !is_asked_ && !(following == moment_)) { ask(following); }
}

void MovingScene::settle(std::span<const Eye> /*eyes*/, const Progress& progress) {
    const Moment moment = momentAt(time_s_);
    told_s_ = time_s_;
    dropSteps();
    if (moment == moment_) { return; }
    if (progress) { progress(0.0); }
    wantFrom(moment.frame);
    Question question{moment, loader_->get(series_.sceneOf(moment.frame)), nullptr};
    if (isBetween(moment)) { question.second = loader_->get(sceneAfter(moment.frame)); }
    Step step = stepTo(question);
    const std::string trouble = noCapacityFor(step);
    check(trouble.empty(), "{}", trouble);
    take(std::move(step));
}

bool MovingScene::isSettled() const { return moment_ == momentAt(time_s_) && !resident_->hasChanges(); }

StreamCounters MovingScene::counters() const {
    return {resident_->splatsAdded(), resident_->splatsShown(), parts_.size(), 0, late_count_};
}

std::vector<std::string> MovingScene::takeLines(Waits waits) {
    std::vector<std::string> lines = std::exchange(lines_, {});
    if (waits == Waits::kNever) { std::ranges::move(loader_->takeLines(waits), std::back_inserter(lines)); }
    return lines;
}

}  // namespace binosplat
