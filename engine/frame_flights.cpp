// Frames one after another: what each prepares, when it is waited for, and when it is done again.
#include "engine/frame.h"

#include "engine/error.h"

#include <cassert>
#include <cmath>

namespace binosplat {
namespace {

// What lists hold between two frames changes less than the room ahead of them, unless an eye goes or turns farther than this, or its angles
// change by more than this share. Heads go at up to 3 m/s and turn at up to 400 degrees/s: at 72 frames a second by 4 cm and 5.6 degrees.
// Turns by a step are of 15 degrees and more.
constexpr double kJumpMetres = 0.2;
constexpr double kJumpDegrees = 6.0;
constexpr double kJumpZoom = 0.1;

}  // namespace

StereoFrame::StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options)
    : context_(context),
      passes_(context, options.threads_per_cell),
      warp_passes_(context),
      shown_{ShownTiles(context), ShownTiles(context)},
      first_capacity_(options.first_capacity),
      flights_{Flight(context), Flight(context)} {
    show(scene);
}

void StereoFrame::show(const GpuScene& scene) {
    finish();
    scene_ = &scene;
    first_frame_ = true;
    moves_asked_ = {};
    buffers_ = {};
    buffers_ = makeFrameBuffers(context_, scene.splatCount());
}

void StereoFrame::rebuildKernels() {
    finish();
    passes_.rebuildKernels();
    warp_passes_.rebuildKernels();
}

void StereoFrame::takeKernels(StereoFrame& from) {
    finish();
    from.finish();
    passes_.takeKernels(from.passes_);
    warp_passes_.takeKernels(from.warp_passes_);
}

void StereoFrame::makeKernels(std::span<const Eye> eyes, const FrameSettings& settings) {
    finish();
    prepare(eyes, settings);
    Commands& commands = flights_[turn_].commands;
    // `predicted` may find that moving does not pay.
    if (settings.mode == Mode::kPredicted) {
        may_move_ = false;
        recordFrame(commands, eyes, settings);
        commands.drop();
    }
    may_move_ = true;
    recordFrame(commands, eyes, settings);
    commands.drop();
    // Nothing is known of any frame.
    first_frame_ = true;
}

FrameResult StereoFrame::render(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append) {
    finish();
    prepare(eyes, settings);
    renderUntilComplete(eyes, settings, append);
    FrameResult result = collect(flights_[turn_]);
    may_move_ = settings.mode != Mode::kPredicted || state_.warp_counters.pays != 0;
    return result;
}

void StereoFrame::makeRoom(std::span<const Eye> eyes, const FrameSettings& settings) {
    if (shapeOf(eyes, settings) == shape_) { return; }
    finish();
    shape_ = {};  // some images are new, and some may fail
    setRoles(settings);
    prepareImages(eyes, settings);
}

std::optional<FrameResult> StereoFrame::renderAhead(std::span<const Eye> eyes, const FrameSettings& settings,
                                                    const std::function<void(Commands&)>& append, vk::Semaphore signals) {
    Flight &before_last = flights_[turn_], &last = flights_[1 - turn_];
    std::optional<FrameResult> result = land(before_last);
    bool waits = first_frame_ || jumps(eyes, settings) || isCutShort();
    // What they need grows towards what there is: room is made before it is short, while nothing uses the lists.
    const bool is_short = result && room_ahead_fits_ && !hasRoom(kRoomAhead);
    if (waits || is_short) {
        if (auto newer = land(last)) { result = std::move(newer); }
        waits = waits || isCutShort();
        if (is_short) { makeRoomAhead(); }
    }
    prepare(eyes, settings);
    if (!waits) {
        record(eyes, settings, append);
        flights_[turn_].commands.submit(signals);
        turn_ = 1 - turn_;
        return result;
    }
    makeRoomForVisible(eyes, settings);
    done_again_ += renderAtMostTwice(eyes, settings, append);
    if (isCutShort()) { ++cut_short_; }
    result = collect(flights_[turn_]);
    result->counters["frames_cut_short"] = cut_short_;
    result->counters["frames_done_again"] = done_again_;
    may_move_ = settings.mode != Mode::kPredicted || state_.warp_counters.pays != 0;
    makeRoomAhead();
    if (signals) {
        const std::lock_guard lock(context_.queueMutex());
        context_.queue().submit(vk::SubmitInfo({}, {}, {}, signals));
    }
    return result;
}

std::optional<FrameResult> StereoFrame::finish() {
    std::optional<FrameResult> older = land(flights_[turn_]), newer = land(flights_[1 - turn_]);
    return newer ? std::move(newer) : std::move(older);
}

std::optional<FrameResult> StereoFrame::land(Flight& flight) {
    if (!flight.commands.isUnderWay()) { return std::nullopt; }
    flight.commands.wait();
    state_ = flight.readback.mapped<FrameState>()[0];
    if (isCutShort()) { ++cut_short_; }
    FrameResult result = collect(flight);
    result.counters["frames_cut_short"] = cut_short_;
    result.counters["frames_done_again"] = done_again_;
    if (flight.settings.mode == Mode::kPredicted && flight.moves_asked == moves_asked_) { may_move_ = state_.warp_counters.pays != 0; }
    return result;
}

std::uint64_t StereoFrame::renderUntilComplete(std::span<const Eye> eyes, const FrameSettings& settings,
                                               const std::function<void(Commands&)>& append) {
    for (std::uint64_t times = 0;; ++times) {
        renderOnce(eyes, settings, append);
        if (growIfNeeded()) { return times; }
    }
}

std::uint64_t StereoFrame::renderAtMostTwice(std::span<const Eye> eyes, const FrameSettings& settings,
                                             const std::function<void(Commands&)>& append) {
    renderOnce(eyes, settings, append);
    const bool guesses_affiliated = stereoSettingsOf(settings).patching != Patching::kNone && reprojects(settings.mode) && dominantIsVoid();
    if (!growIfItFits()) {
        first_frame_ = false;
        return 0;
    }
    if (guesses_affiliated) { makeRoomForPatches(); }
    renderOnce(eyes, settings, append);
    // What is still short has room the next time.
    if (!growIfItFits()) { first_frame_ = false; }
    return 1;
}

void StereoFrame::renderOnce(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append) {
    Flight& flight = flights_[turn_];
    record(eyes, settings, append);
    flight.commands.submitAndWait();
    for (ShownTiles& shown : shown_) { shown.forgetUpload(); }
    state_ = flight.readback.mapped<FrameState>()[0];
}

void StereoFrame::makeRoomForVisible(std::span<const Eye> eyes, const FrameSettings& settings) {
    Flight& flight = flights_[turn_];
    const FrameState state = firstStateOf(eyes, settings, stereoSettingsOf(settings));
    flight.commands.begin();
    flight.commands.update(buffers_.state, &state, sizeof(state));
    if (per_eye_) {
        for (const int e : {kLeft, kRight}) {
            passes_.recordCull(flight.commands, *scene_, buffers_, {.first = e, .count = 1, .order_eye = e, .list = e}, Role::kNone);
        }
    } else {
        const int count = static_cast<int>(eyes.size());
        passes_.recordCull(flight.commands, *scene_, buffers_, {.first = 0, .count = count, .order_eye = dominant_, .list = 0},
                           Role::kNone);
    }
    flight.commands.copy(buffers_.state, flight.readback, sizeof(FrameState));
    flight.commands.submitAndWait();
    state_ = flight.readback.mapped<FrameState>()[0];
    growIfItFits();  // of pairs nothing is known yet
}

StereoFrame::Shape StereoFrame::shapeOf(std::span<const Eye> eyes, const FrameSettings& settings) const {
    Shape shape{.mode = settings.mode,
                .dominant = settings.mode == Mode::kMono ? 0 : settings.dominant,
                .per_eye = settings.per_eye,
                .half_floats = settings.half_floats,
                .keep_depth = settings.keep_depth,
                .keep_both_depths = settings.keep_both_depths,
                .keep_moments = settings.keep_moments,
                .keep_classes = settings.keep_classes,
                .center_rois = settings.stereo.center_rois};
    for (std::size_t e = 0; e < eyes.size(); ++e) { shape.sizes_px[e] = eyes[e].size_px; }
    return shape;
}

bool StereoFrame::jumps(std::span<const Eye> eyes, const FrameSettings& settings) const {
    if (eyes.size() != eyes_.size() || shapeOf(eyes, settings) != shape_) { return true; }
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        if (!shown_[e].isOf(settings.hidden_tiles[e], tilesOf(eyes[e].size_px))) { return true; }
        const Pose &from = eyes_[e].world_from_camera, &to = eyes[e].world_from_camera;
        const Intrinsics &lens = eyes_[e].intrinsics, &other_lens = eyes[e].intrinsics;
        const bool turns = std::abs(glm::dot(from.orientation, to.orientation)) < std::cos(0.5 * glm::radians(kJumpDegrees));
        const bool is_far = glm::distance(from.position, to.position) > kJumpMetres * settings.units_per_metre;
        const bool zooms = std::abs(other_lens.fx - lens.fx) + std::abs(other_lens.fy - lens.fy) > kJumpZoom * lens.fx;
        if (turns || is_far || zooms) { return true; }
    }
    return false;
}

void StereoFrame::setRoles(const FrameSettings& settings) {
    mode_ = settings.mode;
    dominant_ = settings.mode == Mode::kMono ? 0 : settings.dominant;
}

void StereoFrame::prepare(std::span<const Eye> eyes, const FrameSettings& settings) {
    assert(eyes.size() == (settings.mode == Mode::kMono ? 1u : 2u));
    check(!reprojects(settings.mode) || eyes[0].size_px == eyes[1].size_px,
          "the eyes have {}x{} and {}x{} pixels: to make one from the other they must be equal", eyes[0].size_px.x, eyes[0].size_px.y,
          eyes.back().size_px.x, eyes.back().size_px.y);
    setRoles(settings);
    per_eye_ = settings.mode == Mode::kTwoPass || (settings.mode == Mode::kPaper && settings.per_eye);
    relation_ = relate(eyes[dominant_], eyes.size() == 2 ? eyes[1 - dominant_] : eyes[dominant_]);
    prepareImages(eyes, settings);
    prepareLists();
    const MovesAsked asked{stereoSettingsOf(settings), dominant_, eyes[0].size_px, settings.hidden_tiles[dominant_].size()};
    if (settings.mode != Mode::kPredicted || asked != moves_asked_) { may_move_ = true; }
    moves_asked_ = asked;
    shape_ = shapeOf(eyes, settings);
    eyes_.assign(eyes.begin(), eyes.end());
}

void StereoFrame::record(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append) {
    Flight& flight = flights_[turn_];
    flight.eyes.assign(eyes.begin(), eyes.end());
    flight.settings = settings;
    flight.settings.hidden_tiles = {};
    flight.relation = relation_;
    flight.moves_asked = moves_asked_;
    flight.may_move = may_move_;
    recordFrame(flight.commands, eyes, settings);
    flight.commands.copy(buffers_.state, flight.readback, sizeof(FrameState));
    if (append) { append(flight.commands); }
}

}  // namespace binosplat
