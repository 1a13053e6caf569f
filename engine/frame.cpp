// The stereo frame as a list of passes.
#include "engine/frame.h"

#include "engine/error.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <string_view>

namespace binosplat {
namespace {

// Components of holes that get a box of their own: 64 KiB.
constexpr std::uint32_t kHoleBoxes = 4096;

// Splits what the device holds in two floats.
template <typename Wide, typename Narrow>
void split(const Wide& value, Narrow& high, Narrow& low) {
    high = Narrow(value);
    low = Narrow(value - Wide(high));
}

gpu::EyeView viewOf(const Eye& eye, double near) {
    const glm::dmat3 world_from_camera = glm::mat3_cast(eye.world_from_camera.orientation);
    const Intrinsics& k = eye.intrinsics;
    gpu::EyeView view{};
    split(world_from_camera[0], view.camera_from_world_x, view.camera_from_world_x_low);
    split(world_from_camera[1], view.camera_from_world_y, view.camera_from_world_y_low);
    split(world_from_camera[2], view.camera_from_world_z, view.camera_from_world_z_low);
    split(eye.world_from_camera.position, view.position, view.position_low);
    split(glm::dvec2(k.fx, k.fy), view.focal_px, view.focal_px_low);
    split(glm::dvec2(k.cx, k.cy), view.principal_px, view.principal_px_low);
    view.size_px = eye.size_px;
    view.size_tiles = tilesOf(eye.size_px);
    view.near = static_cast<float>(near);
    view.max_inverse_depth = static_cast<float>(1.0 / near);
    return view;
}

// Whether every point is as deep for one eye as for the other: then one depth order serves both. Canted eyes differ.
bool haveSameDepths(const Eye& a, const Eye& b) {
    const glm::dvec3 forward_a = a.world_from_camera.orientation * glm::dvec3(0, 0, 1);
    const glm::dvec3 forward_b = b.world_from_camera.orientation * glm::dvec3(0, 0, 1);
    const glm::dvec3 shift = b.world_from_camera.position - a.world_from_camera.position;
    return glm::length(forward_a - forward_b) < 1e-9 && std::abs(glm::dot(shift, forward_a)) <= 1e-9 * std::max(1.0, glm::length(shift));
}

bool reprojects(Mode mode) { return mode == Mode::kReproject || mode == Mode::kPaper || mode == Mode::kPredicted; }

StereoSettings stereoSettingsOf(const FrameSettings& settings) {
    StereoSettings stereo = settings.stereo;
    stereo.patching = settings.mode == Mode::kPaper       ? Patching::kPaper
                      : settings.mode == Mode::kPredicted ? Patching::kPredicted
                                                          : Patching::kNone;
    return stereo;
}

}  // namespace

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
    prepareImages(eyes, settings);
    prepareLists();
    do {
        recordFrame(eyes, settings);
        if (append) { append(commands_); }
        commands_.submitAndWait();
        for (ShownTiles& shown : shown_) { shown.forgetUpload(); }
        state_ = state_readback_.mapped<FrameState>()[0];
    } while (!growIfNeeded());
    return collect(eyes, settings);
}

void StereoFrame::recordFrame(std::span<const Eye> eyes, const FrameSettings& settings) {
    const int first = dominant_, second = 1 - dominant_;
    StereoSettings stereo = stereoSettingsOf(settings);
    stereo.hidden_tiles = shown_[second].hiddenCount();
    FrameState state{};
    for (std::size_t e = 0; e < eyes.size(); ++e) { state.eyes[e] = viewOf(eyes[e], settings.near); }
    if (reprojects(settings.mode)) { state.stereo = stereoViewOf(eyes[first], eyes[second], stereo); }

    const auto targetOf = [&](int eye, int list) {
        EyeTarget target{eye,
                         list,
                         tilesOf(eyes[eye].size_px),
                         buffers_.pairs.arrays(),
                         &images_[eye],
                         moments_.address<gpu::StereoPixel>(),
                         glm::vec3(settings.background),
                         {}};
        target.kept.depth = images_[eye].depths.bytes() > 0;
        target.shown = {shown_[eye].before(), {}};
        return target;
    };
    const auto dominantOf = [&](int list) {
        EyeTarget target = targetOf(first, list);
        target.kept.stereo_pixels = target.kept.inverse_depth_moments = settings.keep_moments;
        return target;
    };

    commands_.begin();
    commands_.update(buffers_.state, &state, sizeof(state));
    for (ShownTiles& shown : shown_) { shown.record(commands_); }
    switch (settings.mode) {
        case Mode::kMono:
            passes_.recordVisible(commands_, *scene_, buffers_, 0, 1, 0, 0, "");
            passes_.recordEye(commands_, *scene_, buffers_, dominantOf(0), "");
            break;
        case Mode::kTwoPass:
            passes_.recordVisible(commands_, *scene_, buffers_, first, 1, first, first, "dominant ");
            passes_.recordEye(commands_, *scene_, buffers_, dominantOf(first), "dominant ");
            passes_.recordVisible(commands_, *scene_, buffers_, second, 1, second, second, "affiliated ");
            passes_.recordEye(commands_, *scene_, buffers_, targetOf(second, second), "affiliated ");
            break;
        case Mode::kShared:
            passes_.recordVisible(commands_, *scene_, buffers_, 0, 2, first, 0, "both ");
            passes_.recordEye(commands_, *scene_, buffers_, dominantOf(0), "dominant ");
            if (!haveSameDepths(eyes[0], eyes[1])) { passes_.recordOrder(commands_, *scene_, buffers_, second, 0, "affiliated "); }
            passes_.recordEye(commands_, *scene_, buffers_, targetOf(second, 0), "affiliated ");
            break;
        case Mode::kReproject:
        case Mode::kPaper:
        case Mode::kPredicted: {
            passes_.recordVisible(commands_, *scene_, buffers_, 0, 2, first, 0, "both ");
            EyeTarget dominant = dominantOf(0);
            // Until the dominant eye is blended nothing is in the other one's picture.
            if (buffers_.pairs.lentCapacity() > buffers_.pairs.capacity()) {
                dominant.pairs = buffers_.pairs.arraysWith(images_[second].colours, tileBits(dominant.size_tiles));
            }
            dominant.stereo_pixels = images_[second].colours.address<gpu::StereoPixel>();
            dominant.kept.stereo_pixels = true;
            dominant.kept.inverse_depth_moments = settings.mode == Mode::kPredicted || stereo.depth_choice == gpu::kDepthInverse;
            passes_.recordEye(commands_, *scene_, buffers_, dominant, "dominant ");
            recordAffiliated(eyes, stereo, targetOf(second, 0));
            break;
        }
    }
    commands_.endPass();
    commands_.copy(buffers_.state, state_readback_, sizeof(FrameState));
}

void StereoFrame::recordAffiliated(std::span<const Eye> eyes, const StereoSettings& stereo, EyeTarget target) {
    const bool rectified = isRectified(stereoViewOf(eyes[dominant_], eyes[1 - dominant_], stereo));
    stereo_buffers_.borrow(buffers_.pairs.buffer().address<gpu::uint>());
    stereo_passes_.record(commands_, *scene_, buffers_, stereo_buffers_, stereo, rectified, dominant_, images_[dominant_],
                          images_[target.eye], shown_);
    if (stereo.patching != Patching::kNone) { recordPatches(eyes, stereo, target); }
    // Last, since the classes of pixels take the pairs' place.
    stereo_passes_.recordResample(commands_, buffers_, stereo_buffers_, rectified, images_[dominant_], images_[target.eye],
                                  target.background);
}

void StereoFrame::recordPatches(std::span<const Eye> eyes, const StereoSettings& stereo, EyeTarget target) {
    target.shifted = isShifted(stereoViewOf(eyes[dominant_], eyes[target.eye], stereo));
    if (!haveSameDepths(eyes[0], eyes[1])) { passes_.recordOrder(commands_, *scene_, buffers_, target.eye, 0, "affiliated "); }
    passes_.recordTiles(commands_, *scene_, buffers_, target, {stereo_buffers_.tilesBefore(), stereo_buffers_.tileList()}, "affiliated ");
}

void StereoFrame::prepareImages(std::span<const Eye> eyes, const FrameSettings& settings) {
    const auto resize = [&](Buffer& buffer, const char* name, std::uint64_t bytes) {
        if (buffer.bytes() == bytes) { return; }
        buffer = {};
        buffer = Buffer(context_, name, bytes);
    };
    const bool read_depth = reprojects(settings.mode) && settings.stereo.depth_choice != gpu::kDepthInverse;
    std::uint64_t most_tiles = 0;
    for (int e = 0; e < 2; ++e) {
        const bool used = static_cast<std::size_t>(e) < eyes.size();
        sizes_px_[e] = used ? eyes[e].size_px : glm::uvec2(0);
        const std::uint64_t pixels = std::uint64_t{sizes_px_[e].x} * sizes_px_[e].y;
        const glm::uvec2 tiles = tilesOf(sizes_px_[e]);
        most_tiles = std::max(most_tiles, std::uint64_t{tiles.x} * tiles.y);
        const std::span<const std::uint8_t> hidden = used ? settings.hidden_tiles[e] : std::span<const std::uint8_t>{};
        assert(hidden.empty() || hidden.size() == std::size_t{tiles.x} * tiles.y);
        shown_[e].set(hidden);
        const bool dominant = used && e == dominant_;
        resize(images_[e].colours, "colours", pixels * sizeof(gpu::vec4));
        const bool keeps_depth = dominant ? settings.keep_depth || read_depth : settings.keep_both_depths;
        resize(images_[e].depths, "depths", keeps_depth ? pixels * sizeof(float) : 0);
        if (dominant) { resize(moments_, "inverse depth moments", settings.keep_moments ? pixels * sizeof(gpu::StereoPixel) : 0); }
    }
    resize(buffers_.tile_ranges, "tile ranges", (most_tiles + 1) * sizeof(gpu::uvec2));  // one more for pairs in no tile
    const glm::uvec2 stereo_px = reprojects(settings.mode) ? sizes_px_[0] : glm::uvec2(0);
    const std::uint32_t boxes = settings.mode == Mode::kPaper && settings.stereo.center_rois ? kHoleBoxes : 0;
    if (stereo_buffers_.sizePx() != stereo_px || stereo_buffers_.boxCapacity() != boxes) {
        stereo_buffers_ = {};
        if (stereo_px.x > 0) { stereo_buffers_ = StereoBuffers(context_, stereo_px, boxes); }
    }
}

std::uint32_t StereoFrame::mostLentPairs() const {
    if (!reprojects(mode_)) { return 0; }
    return static_cast<std::uint32_t>(std::min<std::uint64_t>(images_[1 - dominant_].colours.bytes() / sizeof(gpu::uint), UINT32_MAX));
}

FrameCapacity StereoFrame::lendWhatFits(FrameCapacity capacity) const {
    capacity.lent_pairs = std::min(capacity.lent_pairs, mostLentPairs());
    capacity.lent_words = capacity.lent_pairs == 0 ? 0 : std::min(mostLentPairs() / capacity.lent_pairs, PairBuffers::kMostLentWords);
    return capacity;
}

void StereoFrame::prepareLists() {
    FrameCapacity capacity = buffers_.capacity();
    if (capacity == FrameCapacity{}) {
        capacity = {std::min(first_capacity_.visible, std::max(scene_->splatCount(), 1u)), first_capacity_.pairs, 0, 0};
        if (reprojects(mode_)) {
            // What is rendered again has far fewer pairs.
            capacity.lent_pairs = capacity.pairs;
            capacity.pairs = (capacity.pairs + 3) / 4;
        }
    }
    const auto borrowed_pairs = static_cast<std::uint32_t>(stereo_buffers_.borrowedBytes() / PairBuffers::kBytesPerPair + 1);
    capacity.pairs = std::max(capacity.pairs, borrowed_pairs);
    growFrameBuffers(context_, buffers_, lendWhatFits(capacity));
}

bool StereoFrame::growIfNeeded() {
    // Just enough the first time, since a single picture needs no more; with room to spare once the view moves.
    const double slack = first_frame_ ? 1.0 : 1.25;
    const auto enough = [&](std::uint32_t needed, std::uint32_t capacity) {
        if (needed <= capacity) { return capacity; }
        const double roomy = std::min(std::ceil(needed * slack / 1024.0) * 1024.0, 4294966272.0);
        return std::max(needed, static_cast<std::uint32_t>(roomy));
    };
    const FrameCapacity now = buffers_.capacity();
    FrameCapacity wanted = now;
    for (int e = 0; e < 2; ++e) {
        const std::uint32_t visible = state_.visible[e].needed, pairs = state_.pairs[e].needed;
        check(pairs != UINT32_MAX, "the eyes see more than 4,294,967,295 pairs of tile and splat: fewer splats or pixels are needed");
        wanted.visible = std::max(wanted.visible, std::min(enough(visible, now.visible), std::max(scene_->splatCount(), 1u)));
        const bool lends = e == dominant_ && pairs <= mostLentPairs();
        if (!lends) {
            wanted.pairs = std::max(wanted.pairs, enough(pairs, now.pairs));
        } else if (pairs > now.pairs) {
            wanted.lent_pairs = enough(pairs, now.lent_pairs);
        }
    }
    wanted = lendWhatFits(wanted);
    if (wanted == now) {
        first_frame_ = false;
        return true;
    }
    growFrameBuffers(context_, buffers_, wanted);
    return false;
}

FrameResult StereoFrame::collect(std::span<const Eye> eyes, const FrameSettings& settings) const {
    FrameResult result;
    result.gpu_ms = commands_.times();
    result.gpu_total_ms = commands_.totalMs();
    result.peak_gpu_bytes = context_.memoryUse().peak_bytes;
    auto& counters = result.counters;
    counters["splats_read"] = scene_->splatCount();
    counters["scene_bytes"] = scene_->bytes();
    counters["visible_bytes"] = buffers_.visible.bytes();
    counters["pair_bytes"] = buffers_.pairs.bytes();
    counters["scratch_bytes"] = buffers_.scratch.bytes();
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const std::string suffix = settings.mode == Mode::kMono ? "" : e == kLeft ? "_left" : "_right";
        const glm::uvec2 tiles = tilesOf(eyes[e].size_px);
        counters["splats_visible" + suffix] = state_.visible[settings.mode == Mode::kTwoPass ? e : 0].count;
        counters["tile_pairs" + suffix] = state_.pairs[e].count;
        counters["square_box_tile_pairs" + suffix] =
            (std::uint64_t{state_.counters[e].square_box_pairs_high} << 32) | state_.counters[e].square_box_pairs_low;
        counters["tiles" + suffix] = std::uint64_t{tiles.x} * tiles.y;
        if (shown_[e].hideAny()) { counters["tiles_hidden" + suffix] = shown_[e].hiddenCount(); }
        counters["pixels" + suffix] = std::uint64_t{eyes[e].size_px.x} * eyes[e].size_px.y;
        counters["pixel_bytes" + suffix] = images_[e].colours.bytes() + images_[e].depths.bytes();
    }
    if (reprojects(settings.mode)) {
        const gpu::StereoCounters& stereo = state_.stereo_counters;
        counters["pixels_covered"] = stereo.covered_pixels;
        counters["pixels_gap"] = stereo.gap_pixels;
        counters["pixels_hole"] = stereo.hole_pixels;
        counters["tiles_patched"] = state_.masked_tiles.count;
        counters["tiles_edge"] = stereo.edge_tiles;
        counters["tiles_center"] = stereo.center_tiles;
        counters["tiles_predicted"] = stereo.predicted_tiles;
        counters["hole_components"] = stereo.components;
        counters["splats_newcomers"] = stereo.newcomers;
        counters["stereo_bytes"] = stereo_buffers_.bytes();
    }
    explainLeftOut(eyes, settings, result);
    return result;
}

void StereoFrame::explainLeftOut(std::span<const Eye> eyes, const FrameSettings& settings, FrameResult& result) const {
    const auto leaveOut = [&](bool condition, std::string_view sentence) {
        if (condition) { result.left_out.emplace_back(sentence); }
    };
    const bool reprojected = reprojects(settings.mode);
    const bool patched = settings.mode == Mode::kPaper || settings.mode == Mode::kPredicted;
    const bool moments =
        settings.keep_moments || settings.mode == Mode::kPredicted || (reprojected && settings.stereo.depth_choice == gpu::kDepthInverse);
    const gpu::StereoCounters& stereo = state_.stereo_counters;
    leaveOut(scene_->shDegree() < kMaxShDegree, fmt::format("SH bands above {}: the scene has none", scene_->shDegree()));
    leaveOut(!moments, "moments of inverse depth: no stage of this mode reads them");
    leaveOut(eyes.size() == 2 && images_[1 - dominant_].depths.bytes() == 0, "depth of the affiliated eye: nothing reads it");
    leaveOut(eyes.size() == 2 && settings.mode != Mode::kTwoPass, "culling for the affiliated eye alone: both eyes are culled at once");
    leaveOut(eyes.size() == 2 && settings.mode != Mode::kTwoPass && haveSameDepths(eyes[0], eyes.back()),
             "depth sort of the affiliated eye: the eyes are parallel, so the dominant eye's order is exact");
    for (std::size_t e = 0; e < eyes.size(); ++e) {
        const std::uint64_t tiles = std::uint64_t{tilesOf(eyes[e].size_px).x} * tilesOf(eyes[e].size_px).y;
        leaveOut(shown_[e].hideAny(), fmt::format("{} of the {} tiles of the {} eye: its lens never shows them", shown_[e].hiddenCount(),
                                                  tiles, e == kLeft ? "left" : "right"));
    }
    leaveOut(patched && state_.masked_tiles.count == 0, "patching: no tile needs to be rendered again");
    leaveOut(settings.mode == Mode::kPaper && !settings.stereo.center_rois, "centre ROIs: not asked for");
    leaveOut(settings.mode == Mode::kPaper && settings.stereo.center_rois && stereo.hole_pixels == 0,
             "centre ROIs: the picture has no holes");
    leaveOut(settings.mode == Mode::kPredicted && stereo.newcomers == 0,
             "errors of newcomers: the affiliated eye sees no splat that the dominant one does not");
}

template <typename T>
std::vector<T> StereoFrame::readBuffer(const Buffer& buffer, std::uint64_t first_bytes) {
    const std::uint64_t bytes = std::min(buffer.bytes(), first_bytes);
    if (bytes == 0) { return {}; }
    const Buffer readback(context_, "read-back", bytes, MemoryKind::kReadback);
    commands_.begin();
    commands_.copy(buffer, readback, bytes);
    commands_.submitAndWait();
    const auto values = readback.mapped<T>();
    return {values.begin(), values.end()};
}

Image StereoFrame::readPicture(int eye) { return {sizes_px_[eye], 4, readBuffer<float>(images_[eye].colours)}; }
Image StereoFrame::readDepth(int eye) { return {sizes_px_[eye], 1, readBuffer<float>(images_[eye].depths)}; }

Image StereoFrame::readInverseDepthMoments() {
    const std::vector<gpu::StereoPixel> pixels = readBuffer<gpu::StereoPixel>(moments_);
    Image image{sizes_px_[dominant_], 2, {}};
    for (const gpu::StereoPixel& pixel : pixels) {
        image.values.insert(image.values.end(), {pixel.inverse_depth_sum, pixel.inverse_depth_square_sum});
    }
    return image;
}

std::vector<std::uint32_t> StereoFrame::readTileKinds() {
    if (!reprojects(mode_)) { return {}; }
    const std::vector<std::uint32_t> tiles = readBuffer<std::uint32_t>(stereo_buffers_.tiles());
    const auto kinds = tiles.begin() + static_cast<std::ptrdiff_t>(stereo_buffers_.tileCount());
    return {kinds, kinds + static_cast<std::ptrdiff_t>(stereo_buffers_.tileCount())};
}

std::vector<std::uint8_t> StereoFrame::readPixelClasses() {
    if (!reprojects(mode_)) { return {}; }
    const std::vector<std::uint32_t> words = readBuffer<std::uint32_t>(buffers_.pairs.buffer(), stereo_buffers_.pixelClassBytes());
    const glm::uvec2 size = sizes_px_[0];
    const std::size_t row_words = tilesOf(size).x;
    std::vector<std::uint8_t> classes(std::size_t{size.x} * size.y);
    for (std::size_t y = 0; y < size.y; ++y) {
        for (std::size_t x = 0; x < size.x; ++x) {
            classes[y * size.x + x] =
                static_cast<std::uint8_t>((words[y * row_words + x / gpu::kTileSize] >> (2 * (x % gpu::kTileSize))) & 3);
        }
    }
    return classes;
}

}  // namespace binosplat
