// Records the passes that reproject one eye into the other.
#include "engine/baselines/warp_passes.h"

#include <cstddef>

namespace binosplat {
namespace {

// This many workgroups stride over the boxes of holes.
constexpr gpu::uint kMarkGroups = 64;

// The passes of one frame, one function each, and what several of them need.
class WarpRecorder {
public:
    WarpRecorder(PassKernels& kernels, Commands& commands, const WarpInputs& in)
        : kernels_(kernels), commands_(commands), in_(in) {}

    [[nodiscard]] bool predicts() const { return in_.settings.choice == TileChoice::kPredicted; }
    [[nodiscard]] bool followsPaper() const { return in_.settings.choice == TileChoice::kPaper; }
    [[nodiscard]] bool groupsHoles() const { return followsPaper() && in_.settings.center_rois; }

    void weigh();
    void clearTiles();
    void findDepthBounds();
    void findEdgeRois();
    void reproject();
    // Every row or, if errors are predicted, the even ones; resampleOdd: the odd ones.
    void resample();
    void resampleOdd();
    void findNewcomers();
    void groupHoles();
    void price();
    void select();

private:
    void resampleFrom(gpu::uint first_row, gpu::uint row_source, bool predict_errors);
    template <typename K>
    void begin() {
        commands_.beginPass({in_.role, K::kStage, K::kShader});
    }
    template <typename K>
    void dispatch(const K& kernel, const typename K::Pass& pass, std::uint32_t groups_x,
                  std::uint32_t groups_y = 1) {
        commands_.dispatch(kernels_.get(kernel), pass, groups_x, groups_y);
    }
    template <typename K>
    void dispatchByCounter(const K& kernel, const typename K::Pass& pass, std::uint64_t counter) {
        commands_.dispatchIndirect(kernels_.get(kernel), pass, in_.buffers.state,
                                   field(offsetof(TargetState, warp_counters)) + counter);
    }
    [[nodiscard]] std::uint64_t field(std::uint64_t offset) const {
        return FrameBuffers::targetField(in_.index, offset);
    }
    [[nodiscard]] auto target() const { return in_.buffers.state.address<gpu::TargetState>(field(0)); }
    [[nodiscard]] auto view() const {
        return in_.buffers.state.address<gpu::WarpView>(field(offsetof(TargetState, warp)));
    }
    [[nodiscard]] auto counters() const {
        return in_.buffers.state.address<gpu::WarpCounters>(field(offsetof(TargetState, warp_counters)));
    }
    [[nodiscard]] auto listAt(std::uint64_t offset) const {
        return in_.buffers.state.address<gpu::ListState>(offset);
    }
    [[nodiscard]] auto visible() const { return listAt(FrameBuffers::visibleList(in_.list)); }
    [[nodiscard]] auto chosen() const { return listAt(field(offsetof(TargetState, chosen_tiles))); }
    [[nodiscard]] bool hidesSource() const { return in_.source_shown.isMasked(); }
    [[nodiscard]] bool halfFloats() const { return in_.source.half_floats; }
    // True if resample moves the source's pixels itself.
    [[nodiscard]] bool movesRows() const { return binosplat::movesRows(in_.rectified, in_.warp); }
    [[nodiscard]] bool copiesColours() const { return in_.settings.forward && !predicts(); }
    [[nodiscard]] gpu::uint tileGroups() const {
        return (in_.warp.tileCount() + gpu::kWarpGroup - 1) / gpu::kWarpGroup;
    }

    PassKernels& kernels_;
    Commands& commands_;
    const WarpInputs& in_;
};

void WarpRecorder::weigh() {
    begin<WeighKernel>();
    in_.target_shown.recordKinds(commands_, in_.warp.tiles(), WarpBuffers::tileKindsOffset());
    const gpu::WeighPass pass{.warp = view(),
                              .ranges = in_.buffers.tile_ranges.address<gpu::uvec2>(),
                              // If it may not move, the source came without them.
                              .moving = in_.may_move ? in_.words.moving : gpu::DeviceAddress<gpu::uint>{},
                              .tile_kinds = in_.warp.tileKinds(),
                              .tile_costs = in_.warp.tileCosts(),
                              .tile_errors = in_.warp.tileErrors(),
                              .tile_depths = in_.warp.tileDepths(),
                              .tile_mask = in_.warp.tileMask(),
                              .price_bins = in_.warp.bins(),
                              .shown_mask = in_.source_shown.mask(),
                              .visible = visible(),
                              .masked_tiles = chosen(),
                              .counters = counters(),
                              .kinds_given = in_.target_shown.isMasked()};
    dispatch(WeighKernel{.rectified = in_.rectified}, pass, tileGroups());
}

// Timed with the next pass.
void WarpRecorder::clearTiles() {
    if (followsPaper()) {
        begin<DepthBoundsKernel>();
    } else if (movesRows()) {
        begin<ResampleKernel>();
    } else {
        begin<ReprojectKernel>();
    }
    commands_.fillZero(in_.warp.tiles());
    in_.target_shown.recordKinds(commands_, in_.warp.tiles(), WarpBuffers::tileKindsOffset());
}

void WarpRecorder::findDepthBounds() {
    const gpu::DepthBoundsPass bounds{.warp = view(),
                                      .colours = in_.source.colours.address<gpu::vec4>(),
                                      .half_colours = in_.source.colours.address<gpu::uvec2>(),
                                      .moving = in_.words.moving,
                                      .bins = in_.warp.bins()};
    const glm::uvec2 tiles = in_.warp.sizeTiles();
    dispatch(DepthBoundsKernel{.half_colours = halfFloats()}, bounds,
             (tiles.x + gpu::kBoundsTiles - 1) / gpu::kBoundsTiles, tiles.y);
}

void WarpRecorder::findEdgeRois() {
    begin<EdgeRoisKernel>();
    const gpu::EdgeRoisPass edges{.warp = view(),
                                  .bins = in_.warp.bins(),
                                  .tile_kinds = in_.warp.tileKinds(),
                                  .shown_mask = in_.source_shown.mask(),
                                  .counters = counters()};
    dispatch(EdgeRoisKernel{.rectified = in_.rectified}, edges, tileGroups());
}

void WarpRecorder::reproject() {
    if (movesRows()) { return; }
    begin<ReprojectKernel>();
    const gpu::ReprojectPass pass{.warp = view(),
                                  .moving = in_.words.moving,
                                  .arrivals = in_.words.arrivals,
                                  .shown_mask = in_.source_shown.mask()};
    dispatchByCounter(ReprojectKernel{.rectified = in_.rectified, .forward = copiesColours()}, pass,
                      offsetof(gpu::WarpCounters, per_pixel_block));
}

void WarpRecorder::resample() {
    const bool whole = predicts() && !hidesSource() && !in_.warp.needs().classes;
    resampleFrom(0,
                 !movesRows() ? gpu::kArrivalsGiven
                 : whole      ? gpu::kWholeRowMoved
                              : gpu::kRowMoved,
                 predicts());
}

void WarpRecorder::resampleOdd() {
    resampleFrom(1, in_.rectified ? gpu::kPlacesGiven : gpu::kArrivalsGiven, false);
}

void WarpRecorder::resampleFrom(gpu::uint first_row, gpu::uint row_source, bool predict_errors) {
    begin<ResampleKernel>();
    const bool knows_errors = predict_errors || (first_row == 1 && in_.target_gaze);
    const gpu::ResamplePass pass{
        .warp = view(),
        .source = in_.source.colours.address<gpu::vec4>(),
        .half_source = in_.source.colours.address<gpu::uvec2>(),
        .moving = movesRows() ? in_.words.moving : in_.words.arrivals,
        .target = in_.target.colours.address<gpu::vec4>(),
        .half_target = in_.target.colours.address<gpu::uvec2>(),
        .depths = in_.target.depths.address<float>(),
        .tile_kinds = in_.warp.tileKinds(),
        .tile_errors = knows_errors ? in_.warp.tileErrors() : gpu::DeviceAddress<gpu::uint>{},
        .pixel_classes = in_.warp.pixelClasses(),
        .counters = counters(),
        .shown_mask = in_.source_shown.mask(),
        .background = in_.background,
        .first_row = first_row,
        .copies_colours = copiesColours() ? 1u : 0u,
        .groups_holes = groupsHoles() ? 1u : 0u};
    const ResampleKernel resample_kernel{
        .rectified = in_.rectified,
        .row_steps = row_source == gpu::kPlacesGiven ? 0 : in_.warp.rowSteps(),
        .half_colours = halfFloats(),
        .row_source = row_source,
        .way = in_.warp.needs().classes ? gpu::kDoesAny
               : predict_errors         ? gpu::kPredicts
               : copiesColours()        ? gpu::kCopies
                                        : gpu::kSamples};
    dispatchByCounter(resample_kernel, pass, offsetof(gpu::WarpCounters, per_row));
}

void WarpRecorder::findNewcomers() {
    begin<NewcomersKernel>();
    const gpu::NewcomersPass pass{.chunks = in_.scene.chunks(),
                                  .eyes = in_.buffers.eyes(),
                                  .warp = view(),
                                  .tile_depths = in_.warp.tileDepths(),
                                  .order = in_.buffers.visible.arrays().order,
                                  .visible = visible(),
                                  .source_sets = in_.buffers.visible.arrays().tile_sets,
                                  .tile_kinds = in_.warp.tileKinds(),
                                  .tile_errors = in_.warp.tileErrors(),
                                  .counters = counters(),
                                  .chunk_bits = in_.scene.chunkBits(),
                                  .eye = static_cast<gpu::uint>(in_.index),
                                  .is_dimmed = in_.scene.traits().is_dimmed};
    dispatchByCounter(NewcomersKernel{.splat_kind = in_.scene.splatKind(), .placed = in_.scene.isPlaced()},
                      pass, offsetof(gpu::WarpCounters, per_visible));
}

void WarpRecorder::groupHoles() {
    begin<ComponentsKernel>();
    const gpu::ComponentsPass pass{.warp = view(),
                                   .pixels = in_.target.colours.address<gpu::ComponentPixel>(),
                                   .pixel_classes = in_.warp.pixelClasses(),
                                   .boxes = in_.warp.boxes(),
                                   .tile_kinds = in_.warp.tileKinds(),
                                   .counters = counters(),
                                   .box_capacity = in_.warp.needs().boxes,
                                   .slots_apart = halfFloats() ? 1u : 2u};
    for (std::uint32_t step = 0; step < 3; ++step) {
        dispatchByCounter(ComponentsKernel{.step = step}, pass,
                          offsetof(gpu::WarpCounters, component_groups));
    }
    dispatch(ComponentsKernel{.step = 3}, pass, kMarkGroups);
}

void WarpRecorder::price() {
    begin<PriceKernel>();
    const gpu::PricePass pass{
        .targets = target(), .chosen = chosen(), .price_bins = in_.warp.bins(), .most_cost = 0};
    dispatch(PriceKernel{.foveated = in_.target_gaze}, pass, tileGroups());
}

void WarpRecorder::select() {
    begin<SelectKernel>();
    const gpu::SelectPass pass{.targets = target(), .chosen = chosen(), .visible = visible(), .at_once = 1};
    dispatch(SelectKernel{.predicted = predicts()}, pass, tileGroups());
}

}  // namespace

void recordWarp(PassKernels& kernels, Commands& commands, const WarpInputs& in) {
    WarpRecorder passes(kernels, commands, in);
    if (passes.predicts()) {
        passes.weigh();
        if (!in.may_move) { return; }
    } else {
        passes.clearTiles();
    }
    if (passes.followsPaper()) {
        passes.findDepthBounds();
        passes.findEdgeRois();
    }
    passes.reproject();
    passes.resample();
    if (passes.predicts()) { passes.findNewcomers(); }
    if (passes.groupsHoles()) { passes.groupHoles(); }
    if (passes.predicts()) { passes.price(); }
    if (passes.followsPaper() || passes.predicts()) { passes.select(); }
    if (passes.predicts()) { passes.resampleOdd(); }
}

}  // namespace binosplat
