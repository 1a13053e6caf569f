// The stereo frame as a list of passes.
#include "engine/frame.h"

#include "engine/error.h"
#include "engine/eye_view.h"

#include <cassert>

namespace binosplat {

StereoSettings stereoSettingsOf(const FrameSettings& settings) {
    StereoSettings stereo = settings.stereo;
    stereo.patching = settings.mode == Mode::kPaper       ? Patching::kPaper
                      : settings.mode == Mode::kPredicted ? Patching::kPredicted
                                                          : Patching::kNone;
    return stereo;
}

StereoFrame::StereoFrame(const Context& context, const GpuScene& scene, const FrameOptions& options)
    : context_(context),
      passes_(context, options.threads_per_cell),
      stereo_passes_(context),
      commands_(context),
      shown_{ShownTiles(context), ShownTiles(context)},
      state_readback_(context, "frame state read-back", sizeof(FrameState), MemoryKind::kReadback),
      first_capacity_(options.first_capacity) {
    show(scene);
}

void StereoFrame::show(const GpuScene& scene) {
    scene_ = &scene;
    first_frame_ = true;
    moves_asked_ = {};
    buffers_ = {};
    buffers_ = makeFrameBuffers(context_, scene.splatCount());
}

void StereoFrame::rebuildKernels() {
    passes_.rebuildKernels(context_);
    stereo_passes_.rebuildKernels();
}

FrameResult StereoFrame::render(std::span<const Eye> eyes, const FrameSettings& settings, const std::function<void(Commands&)>& append) {
    assert(eyes.size() == (settings.mode == Mode::kMono ? 1u : 2u));
    check(!reprojects(settings.mode) || eyes[0].size_px == eyes[1].size_px,
          "the eyes have {}x{} and {}x{} pixels: to make one from the other they must be equal", eyes[0].size_px.x, eyes[0].size_px.y,
          eyes.back().size_px.x, eyes.back().size_px.y);
    mode_ = settings.mode;
    dominant_ = settings.mode == Mode::kMono ? 0 : settings.dominant;
    per_eye_ = settings.mode == Mode::kTwoPass || (settings.mode == Mode::kPaper && settings.per_eye);
    relation_ = relate(eyes[dominant_], eyes.size() == 2 ? eyes[1 - dominant_] : eyes[dominant_]);
    prepareImages(eyes, settings);
    prepareLists();
    const MovesAsked asked{stereoSettingsOf(settings), dominant_, eyes[0].size_px, settings.hidden_tiles[dominant_].size()};
    if (settings.mode != Mode::kPredicted || asked != moves_asked_) { may_move_ = true; }
    moves_asked_ = asked;
    do {
        recordFrame(eyes, settings);
        if (append) { append(commands_); }
        commands_.submitAndWait();
        for (ShownTiles& shown : shown_) { shown.forgetUpload(); }
        state_ = state_readback_.mapped<FrameState>()[0];
    } while (!growIfNeeded());
    FrameResult result = collect(eyes, settings);
    may_move_ = settings.mode != Mode::kPredicted || state_.stereo_counters.pays != 0;
    return result;
}

void StereoFrame::recordFrame(std::span<const Eye> eyes, const FrameSettings& settings) {
    const StereoSettings stereo = stereoSettingsOf(settings);
    const FrameState state = firstStateOf(eyes, settings, stereo);
    const int first = dominant_, second = 1 - dominant_;
    std::optional<gpu::Place> middle;
    if (settings.order == Order::kDistance) { middle = placeOf(middleOf(eyes)); }
    const EyesOfList both{.first = 0, .count = 2, .order_eye = first, .list = 0, .middle = middle};
    const auto alone = [&](int eye) { return EyesOfList{.first = eye, .count = 1, .order_eye = eye, .list = eye, .middle = middle}; };
    EyeTarget dominant = targetOf(eyes, settings, first), affiliated = eyes.size() == 2 ? targetOf(eyes, settings, second) : EyeTarget{};

    commands_.begin();
    commands_.update(buffers_.state, &state, sizeof(state));
    for (ShownTiles& shown : shown_) { shown.record(commands_); }
    switch (settings.mode) {
        case Mode::kMono:
            passes_.recordVisible(commands_, *scene_, buffers_, alone(0), "");
            passes_.recordEye(commands_, *scene_, buffers_, dominant, "");
            break;
        case Mode::kTwoPass:
            passes_.recordVisible(commands_, *scene_, buffers_, alone(first), "dominant ");
            passes_.recordEye(commands_, *scene_, buffers_, dominant, "dominant ");
            passes_.recordVisible(commands_, *scene_, buffers_, alone(second), "affiliated ");
            passes_.recordEye(commands_, *scene_, buffers_, affiliated, "affiliated ");
            break;
        case Mode::kShared:
            passes_.recordVisible(commands_, *scene_, buffers_, both, "both ");
            passes_.recordEye(commands_, *scene_, buffers_, dominant, "dominant ");
            recordOrderOfAffiliated(settings.order);
            passes_.recordEye(commands_, *scene_, buffers_, affiliated, "affiliated ");
            break;
        case Mode::kReproject:
        case Mode::kPaper:
        case Mode::kPredicted:
            passes_.recordVisible(commands_, *scene_, buffers_, per_eye_ ? alone(first) : both, per_eye_ ? "dominant " : "both ");
            passes_.recordEye(commands_, *scene_, buffers_, dominant, "dominant ");
            if (per_eye_) { passes_.recordVisible(commands_, *scene_, buffers_, alone(second), "affiliated "); }
            stereo_passes_.record(commands_, {.scene = *scene_,
                                              .buffers = buffers_,
                                              .stereo = stereo_buffers_,
                                              .settings = stereo,
                                              .rectified = relation_.rectified,
                                              .may_move = may_move_,
                                              .list = affiliated.list,
                                              .dominant_eye = first,
                                              .dominant = images_[first],
                                              .affiliated = images_[second],
                                              .dominant_shown = shown_[first],
                                              .affiliated_shown = shown_[second],
                                              .background = affiliated.background});
            if (stereo.patching == Patching::kNone) { break; }
            if (!per_eye_) { recordOrderOfAffiliated(settings.order); }
            if (!may_move_) {
                passes_.recordEye(commands_, *scene_, buffers_, affiliated, "affiliated ");
                break;
            }
            passes_.recordTiles(commands_, *scene_, buffers_, affiliated, {stereo_buffers_.tileMask(), stereo_buffers_.tileList()},
                                "affiliated ");
            break;
    }
    commands_.endPass();
    commands_.copy(buffers_.state, state_readback_, sizeof(FrameState));
}

FrameState StereoFrame::firstStateOf(std::span<const Eye> eyes, const FrameSettings& settings, const StereoSettings& stereo) const {
    FrameState state{};
    for (std::size_t e = 0; e < eyes.size(); ++e) { state.eyes[e] = viewOf(eyes[e], settings.near); }
    if (reprojects(settings.mode)) {
        state.stereo = stereoViewOf(relation_, eyes[0].size_px, stereo_buffers_.rowWords(), stereo);
        state.stereo_counters = firstCountersOf(stereo, eyes[0].size_px);
    }
    return state;
}

EyeTarget StereoFrame::targetOf(std::span<const Eye> eyes, const FrameSettings& settings, int eye) const {
    const EyeImage& image = images_[eye];
    EyeTarget target{.eye = eye,
                     .list = listOf(eye),
                     .size_tiles = tilesOf(eyes[eye].size_px),
                     .pairs = buffers_.pairs.arrays(),
                     .image = &image,
                     .background = glm::vec3(settings.background),
                     .kept = {.depth = image.depths.bytes() > 0, .half_floats = settings.half_floats},
                     .shown = shown_[eye].mask()};
    if (eye != dominant_) { return target; }
    target.kept.moments = settings.keep_moments;
    target.moments = moments_.address<gpu::vec2>();
    if (!reprojects(settings.mode)) { return target; }
    const EyeImage& other = images_[1 - eye];
    if (may_move_) {
        target.kept.moving = true;
        target.kept.spread = settings.mode == Mode::kPredicted;
        target.kept.depth_choice = settings.stereo.depth_choice;
        target.moving = stereo_buffers_.moving(other);
        target.arrivals = stereo_buffers_.arrivals(other);
        target.row_words = stereo_buffers_.rowWords();
    }
    // Until the dominant eye is blended nothing is in the other one's picture.
    if (buffers_.pairs.lentCapacity() > buffers_.pairs.capacity()) {
        target.pairs = buffers_.pairs.arraysWith(other.colours, tileBits(target.size_tiles));
    }
    return target;
}

void StereoFrame::recordOrderOfAffiliated(Order order) {
    if (!sharesOrder(order)) { passes_.recordOrder(commands_, *scene_, buffers_, {.order_eye = 1 - dominant_, .list = 0}, "affiliated "); }
}

}  // namespace binosplat
