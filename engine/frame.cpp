// The passes of a frame in each mode, in order.
#include "engine/frame.h"

#include "engine/eye_view.h"

namespace binosplat {

StereoSettings stereoSettingsOf(const FrameSettings& settings) {
    StereoSettings stereo = settings.stereo;
    stereo.patching = settings.mode == Mode::kPaper       ? Patching::kPaper
                      : settings.mode == Mode::kPredicted ? Patching::kPredicted
                                                          : Patching::kNone;
    return stereo;
}

void StereoFrame::recordFrame(Commands& commands, std::span<const Eye> eyes, const FrameSettings& settings) {
    const StereoSettings stereo = stereoSettingsOf(settings);
    const FrameState state = firstStateOf(eyes, settings, stereo);
    const int first = dominant_, second = 1 - dominant_;
    std::optional<gpu::Place> middle;
    if (settings.order == Order::kDistance) { middle = placeOf(middleOf(eyes)); }
    const EyesOfList both{.first = 0, .count = 2, .order_eye = first, .list = 0, .middle = middle};
    const auto alone = [&](int eye) { return EyesOfList{.first = eye, .count = 1, .order_eye = eye, .list = eye, .middle = middle}; };
    Target dominant = targetOf(eyes, settings, first), affiliated = eyes.size() == 2 ? targetOf(eyes, settings, second) : Target{};

    commands.begin();
    commands.update(buffers_.state, &state, sizeof(state));
    for (ShownTiles& shown : shown_) { shown.record(commands); }
    switch (settings.mode) {
        case Mode::kMono:
            passes_.recordVisible(commands, *scene_, buffers_, alone(0), Role::kNone);
            passes_.recordEye(commands, *scene_, buffers_, dominant, Role::kNone);
            break;
        case Mode::kTwoPass:
            passes_.recordVisible(commands, *scene_, buffers_, alone(first), Role::kDominant);
            passes_.recordEye(commands, *scene_, buffers_, dominant, Role::kDominant);
            passes_.recordVisible(commands, *scene_, buffers_, alone(second), Role::kAffiliated);
            passes_.recordEye(commands, *scene_, buffers_, affiliated, Role::kAffiliated);
            break;
        case Mode::kShared:
            passes_.recordVisible(commands, *scene_, buffers_, both, Role::kBoth);
            passes_.recordEye(commands, *scene_, buffers_, dominant, Role::kDominant);
            recordOrderOfAffiliated(commands, settings.order);
            passes_.recordEye(commands, *scene_, buffers_, affiliated, Role::kAffiliated);
            break;
        case Mode::kReproject:
        case Mode::kPaper:
        case Mode::kPredicted:
            passes_.recordVisible(commands, *scene_, buffers_, per_eye_ ? alone(first) : both, per_eye_ ? Role::kDominant : Role::kBoth);
            passes_.recordEye(commands, *scene_, buffers_, dominant, Role::kDominant);
            if (per_eye_) { passes_.recordVisible(commands, *scene_, buffers_, alone(second), Role::kAffiliated); }
            recordMoving(commands, eyes, settings, stereo, affiliated);
            if (stereo.patching == Patching::kNone) { break; }
            if (!per_eye_) { recordOrderOfAffiliated(commands, settings.order); }
            if (!may_move_) {
                passes_.recordEye(commands, *scene_, buffers_, affiliated, Role::kAffiliated);
                break;
            }
            passes_.recordTiles(commands, *scene_, buffers_, affiliated,
                                {stereo_buffers_.tileMask(), stereo_buffers_.tileList(), stereo_buffers_.tilesWithPairs()},
                                Role::kAffiliated);
            break;
    }
    commands.endPass();
}

void StereoFrame::recordMoving(Commands& commands, std::span<const Eye> eyes, const FrameSettings& settings, const StereoSettings& stereo,
                               const Target& affiliated) {
    const int first = dominant_, second = 1 - dominant_;
    warp_passes_.record(commands, {.scene = *scene_,
                                   .buffers = buffers_,
                                   .warp = stereo_buffers_,
                                   .settings = stereo,
                                   .rectified = relation_.rectified,
                                   .may_move = may_move_,
                                   .list = affiliated.list,
                                   .target_view = second,
                                   .source = images_[first],
                                   .target = images_[second],
                                   .source_shown = shown_[first],
                                   .target_shown = shown_[second],
                                   .background = affiliated.background,
                                   .target_lens = eyes[static_cast<std::size_t>(second)].intrinsics,
                                   .target_gaze = settings.gazes[static_cast<std::size_t>(second)]});
}

FrameState StereoFrame::firstStateOf(std::span<const Eye> eyes, const FrameSettings& settings, const StereoSettings& stereo) const {
    FrameState state{};
    for (std::size_t e = 0; e < eyes.size(); ++e) { state.eyes[e] = viewOf(eyes[e], settings.near); }
    if (reprojects(settings.mode)) {
        state.warp = warpViewOf(relation_, eyes[0].size_px, stereo_buffers_.rowWords(), stereo);
        state.warp_counters = firstCountersOf(stereo, eyes[0].size_px);
    }
    return state;
}

Target StereoFrame::targetOf(std::span<const Eye> eyes, const FrameSettings& settings, int eye) const {
    const Picture& image = images_[eye];
    Target target{.eye = eye,
                  .list = listOf(eye),
                  .size_px = eyes[eye].size_px,
                  .size_tiles = tilesOf(eyes[eye].size_px),
                  .pairs = buffers_.pairs.arrays(),
                  .image = &image,
                  .background = glm::vec3(settings.background),
                  .kept = {.depth = image.depths.bytes() > 0, .half_floats = settings.half_floats},
                  .square_boxes = settings.square_boxes,
                  .shown = shown_[eye].mask()};
    if (eye != dominant_) { return target; }
    target.kept.moments = settings.keep_moments;
    target.moments = moments_.address<gpu::vec2>();
    if (!reprojects(settings.mode)) { return target; }
    const Picture& other = images_[1 - eye];
    if (may_move_) {
        target.kept.moving = true;
        target.kept.spread = settings.mode == Mode::kPredicted;
        target.kept.even_rows = sumsEvenRows(settings, relation_);
        target.kept.depth_choice = settings.stereo.depth_choice;
        target.moving = stereo_buffers_.moving(other);
        if (!movesRows(relation_.rectified, stereo_buffers_)) { target.arrivals = stereo_buffers_.arrivals(other); }
        target.row_words = stereo_buffers_.rowWords();
    }
    // Until the dominant eye is blended nothing is in the other one's picture.
    if (buffers_.pairs.lentCapacity() > buffers_.pairs.capacity()) {
        target.pairs = buffers_.pairs.arraysWith(other.colours, tileBits(target.size_tiles));
    }
    return target;
}

void StereoFrame::recordOrderOfAffiliated(Commands& commands, Order order) {
    if (!sharesOrder(order)) {
        passes_.recordOrder(commands, *scene_, buffers_, {.order_eye = 1 - dominant_, .list = 0}, Role::kAffiliated);
    }
}

}  // namespace binosplat
