// Recording the passes that make one eye from the other.
#include "engine/passes/stereo_passes.h"

#include <algorithm>
#include <cstddef>

namespace binosplat {
namespace {

// Boxes of holes are strided over by so many workgroups.
constexpr gpu::uint kMarkGroups = 64;

}  // namespace

gpu::StereoView stereoViewOf(const EyeRelation& relation, glm::uvec2 size_px, gpu::uint row_words, const StereoSettings& settings) {
    return {.affiliated_from_dominant = relation.affiliated_from_dominant,
            .dominant_from_affiliated = relation.dominant_from_affiliated,
            .size_px = size_px,
            .size_tiles = tilesOf(size_px),
            .row_words = row_words,
            .rows_apart = settings.patching == Patching::kPredicted ? 2u : 1u,
            .gap_px = settings.gap_px,
            .margin_px = settings.margin_px,
            .edge_samples = settings.edge_samples,
            .tight_edges = settings.tight_edges ? 1u : 0u,
            .move_cost = settings.move_cost,
            .budget = static_cast<float>(settings.budget),
            .hole_error = static_cast<float>(settings.hole_error),
            .newcomer_error = static_cast<float>(settings.newcomer_error)};
}

gpu::StereoCounters firstCountersOf(const StereoSettings& settings, glm::uvec2 size_px) {
    gpu::StereoCounters counters{};
    if (settings.patching == Patching::kPredicted) { return counters; }
    const glm::uvec2 tiles = tilesOf(size_px);
    counters.moves = 1;
    counters.per_pixel_block = {tiles.x, 2 * tiles.y, 1};
    counters.per_row = {size_px.y, 1, 1};
    return counters;
}

gpu::EyeGaze eyeGazeOf(const Gaze& gaze, const Intrinsics& lens) {
    return {.direction = glm::vec3(glm::normalize(gaze.direction)),
            .clear_rad = static_cast<float>(gaze.clear_rad),
            .pixel_cycle = static_cast<float>(2.0 / std::min(lens.fx, lens.fy)),
            .focal_px = {lens.fx, lens.fy},
            .principal_px = {lens.cx, lens.cy}};
}

KernelTable stereoKernels(const Context& context) {
    KernelTable table =
        everyVariant("8a_weigh", sizeof(gpu::WeighPass), {{"kRectified", 2}, {"kHiddenTiles", 2}, {"kKindsGiven", 2}, {"kMayMove", 2}});
    append(table, everyVariant("8b_depth_bounds", sizeof(gpu::DepthBoundsPass), {{"kHalfColours", 2}}));
    append(table, everyVariant("8c_edge_rois", sizeof(gpu::EdgeRoisPass), {{"kRectified", 2}, {"kHiddenTiles", 2}}));
    append(table, everyVariant("8d_reproject", sizeof(gpu::ReprojectPass), {{"kRectified", 2}, {"kHiddenTiles", 2}, {"kForward", 2}}));
    for (const KernelVariant& variant : everyVariant("8e_resample", sizeof(gpu::ResamplePass),
                                                     {{"kRectified", 2},
                                                      {"kPredictErrors", 2},
                                                      {"kDepth", 2},
                                                      {"kClasses", 2},
                                                      {"kComponents", 2},
                                                      {"kRowSteps", mostRowSteps(context) + 1},
                                                      {"kHalfColours", 2},
                                                      {"kForward", 2},
                                                      {"kRowSource", 4}})) {
        // Only the paper's holes are grouped, and by their classes. Errors are those of sampling. Whole rows are moved where they can be,
        // and odd ones of predicted are moved like even ones.
        const std::vector<std::uint32_t> values = variant.values();
        const bool groups = values[4] == 0 || (values[1] == 0 && values[3] == 1);
        const bool can_move = values[0] == 1 && values[5] > 0;
        bool fits = (values[8] != gpu::kArrivalsGiven) == can_move;
        if (values[8] == gpu::kWholeRowMoved) { fits = fits && values[1] == 1 && values[3] == 0; }
        if (values[8] == gpu::kPlacesGiven) {
            fits = values[0] == 1 && values[1] == 0 && values[4] == 0 && values[5] == 0 && values[7] == 0;
        }
        if (groups && (values[1] == 0 || values[7] == 0) && fits) { table.push_back(variant); }
    }
    append(table, everyVariant("8f_newcomers", sizeof(gpu::NewcomersPass), {{"kSplatKind", 3}}));
    append(table, everyVariant("8g_components", sizeof(gpu::ComponentsPass), {{"kStep", 4}, {"kHalfColours", 2}}));
    append(table, everyVariant("8h_price", sizeof(gpu::PricePass), {{"kFoveated", 2}}));
    append(table, everyVariant("8i_select", sizeof(gpu::SelectPass), {{"kPredicted", 2}}));
    return table;
}

namespace {

// A frame's passes 8, one function each, and what several of them want to know.
class StereoRecorder {
public:
    StereoRecorder(KernelCache& kernels, Commands& commands, const StereoPassInputs& in)
        : kernels_(kernels), commands_(commands), in_(in) {}

    [[nodiscard]] bool predicts() const { return in_.settings.patching == Patching::kPredicted; }
    [[nodiscard]] bool followsPaper() const { return in_.settings.patching == Patching::kPaper; }
    [[nodiscard]] bool groupsHoles() const { return followsPaper() && in_.settings.center_rois; }
    [[nodiscard]] bool keepsClasses() const { return in_.stereo.needs().classes || groupsHoles(); }

    void weigh();
    void clearTiles();
    void findDepthBounds();
    void findEdgeRois();
    void reproject();
    // Of every row or, where errors are predicted, of the even ones; resampleOdd: of the others.
    void resample();
    void resampleOdd();
    void findNewcomers();
    void groupHoles();
    void price();
    void select();

private:
    void resampleFrom(gpu::uint first_row, gpu::uint row_source, bool predict_errors);
    template <typename Pass>
    const Kernel& kernel(const char* name, const Pass&, std::initializer_list<std::uint32_t> constants) {
        return kernels_.get(name, sizeof(Pass), constants);
    }
    template <typename Pass>
    void dispatchByCounter(const Kernel& of, const Pass& pass, std::uint64_t field) {
        commands_.dispatchIndirect(of, pass, in_.buffers.state, offsetof(FrameState, stereo_counters) + field);
    }
    [[nodiscard]] auto view() const { return in_.buffers.state.address<gpu::StereoView>(offsetof(FrameState, stereo)); }
    [[nodiscard]] auto counters() const { return in_.buffers.state.address<gpu::StereoCounters>(offsetof(FrameState, stereo_counters)); }
    [[nodiscard]] auto listAt(std::uint64_t offset) const { return in_.buffers.state.address<gpu::ListState>(offset); }
    [[nodiscard]] auto visible() const { return listAt(FrameBuffers::visibleList(in_.list)); }
    [[nodiscard]] auto moving() const { return in_.stereo.moving(in_.affiliated); }
    [[nodiscard]] auto arrivals() const { return in_.stereo.arrivals(in_.affiliated); }
    [[nodiscard]] std::uint32_t alongRows() const { return in_.rectified ? 1 : 0; }
    [[nodiscard]] std::uint32_t hidesDominant() const { return in_.dominant_shown.hideAny() ? 1 : 0; }
    [[nodiscard]] std::uint32_t halfFloats() const { return in_.dominant.half_floats ? 1 : 0; }
    // Whether 8e moves the dominant eye's pixels itself.
    [[nodiscard]] std::uint32_t movesRows() const { return binosplat::movesRows(in_.rectified, in_.stereo) ? 1 : 0; }
    [[nodiscard]] std::uint32_t copiesColours() const { return in_.settings.forward && !predicts() ? 1 : 0; }
    [[nodiscard]] gpu::uint tileGroups() const { return (in_.stereo.tileCount() + gpu::kStereoGroup - 1) / gpu::kStereoGroup; }

    KernelCache& kernels_;
    Commands& commands_;
    const StereoPassInputs& in_;
};

void StereoRecorder::weigh() {
    commands_.beginPass("affiliated 8a_weigh");
    in_.affiliated_shown.recordKinds(commands_, in_.stereo.tiles(), StereoBuffers::tileKindsOffset());
    const gpu::WeighPass pass{.stereo = view(),
                              .ranges = in_.buffers.tile_ranges.address<gpu::uvec2>(),
                              .moving = moving(),
                              .tile_kinds = in_.stereo.tileKinds(),
                              .tile_costs = in_.stereo.tileCosts(),
                              .tile_errors = in_.stereo.tileErrors(),
                              .tile_depths = in_.stereo.tileDepths(),
                              .tile_mask = in_.stereo.tileMask(),
                              .price_bins = in_.stereo.bins(),
                              .shown_mask = in_.dominant_shown.mask(),
                              .visible = visible(),
                              .masked_tiles = listAt(offsetof(FrameState, masked_tiles)),
                              .counters = counters()};
    commands_.dispatch(kernel("8a_weigh", pass, {alongRows(), hidesDominant(), in_.affiliated_shown.hideAny(), in_.may_move}), pass,
                       tileGroups());
}

// Timed with the pass that comes next.
void StereoRecorder::clearTiles() {
    commands_.beginPass(followsPaper()     ? "affiliated 8b_depth_bounds"
                        : movesRows() != 0 ? "affiliated 8e_resample"
                                           : "affiliated 8d_reproject");
    commands_.fillZero(in_.stereo.tiles());
    in_.affiliated_shown.recordKinds(commands_, in_.stereo.tiles(), StereoBuffers::tileKindsOffset());
}

void StereoRecorder::findDepthBounds() {
    const gpu::DepthBoundsPass bounds{.stereo = view(),
                                      .colours = in_.dominant.colours.address<gpu::vec4>(),
                                      .half_colours = in_.dominant.colours.address<gpu::uvec2>(),
                                      .moving = moving(),
                                      .bins = in_.stereo.bins()};
    const glm::uvec2 tiles = in_.stereo.sizeTiles();
    commands_.dispatch(kernel("8b_depth_bounds", bounds, {halfFloats()}), bounds, (tiles.x + gpu::kBoundsTiles - 1) / gpu::kBoundsTiles,
                       tiles.y);
}

void StereoRecorder::findEdgeRois() {
    commands_.beginPass("affiliated 8c_edge_rois");
    const gpu::EdgeRoisPass edges{.stereo = view(),
                                  .bins = in_.stereo.bins(),
                                  .tile_kinds = in_.stereo.tileKinds(),
                                  .shown_mask = in_.dominant_shown.mask(),
                                  .counters = counters()};
    commands_.dispatch(kernel("8c_edge_rois", edges, {alongRows(), hidesDominant()}), edges, tileGroups());
}

void StereoRecorder::reproject() {
    if (movesRows() != 0) { return; }
    commands_.beginPass("affiliated 8d_reproject");
    const gpu::ReprojectPass pass{.stereo = view(), .moving = moving(), .arrivals = arrivals(), .shown_mask = in_.dominant_shown.mask()};
    dispatchByCounter(kernel("8d_reproject", pass, {alongRows(), hidesDominant(), copiesColours()}), pass,
                      offsetof(gpu::StereoCounters, per_pixel_block));
}

void StereoRecorder::resample() {
    const bool whole = predicts() && !in_.dominant_shown.hideAny() && !keepsClasses();
    resampleFrom(0, movesRows() == 0 ? gpu::kArrivalsGiven : whole ? gpu::kWholeRowMoved : gpu::kRowMoved, predicts());
}

void StereoRecorder::resampleOdd() { resampleFrom(1, in_.rectified ? gpu::kPlacesGiven : gpu::kArrivalsGiven, false); }

void StereoRecorder::resampleFrom(gpu::uint first_row, gpu::uint row_source, bool predict_errors) {
    commands_.beginPass("affiliated 8e_resample");
    const bool knows_errors = predict_errors || in_.affiliated_gaze;
    const gpu::ResamplePass pass{.stereo = view(),
                                 .dominant = in_.dominant.colours.address<gpu::vec4>(),
                                 .half_dominant = in_.dominant.colours.address<gpu::uvec2>(),
                                 .moving = movesRows() != 0 ? moving() : arrivals(),
                                 .affiliated = in_.affiliated.colours.address<gpu::vec4>(),
                                 .half_affiliated = in_.affiliated.colours.address<gpu::uvec2>(),
                                 .depths = in_.affiliated.depths.address<float>(),
                                 .tile_kinds = in_.stereo.tileKinds(),
                                 .tile_errors = knows_errors ? in_.stereo.tileErrors() : gpu::DeviceAddress<gpu::uint>{},
                                 .pixel_classes = in_.stereo.pixelClasses(),
                                 .component_pixels = in_.affiliated.colours.address<gpu::ComponentPixel>(),
                                 .counters = counters(),
                                 .shown_mask = in_.dominant_shown.mask(),
                                 .background = in_.background,
                                 .first_row = first_row};
    const std::uint32_t with_depth = in_.affiliated.depths.bytes() > 0 ? 1 : 0;
    const std::uint32_t row_steps = row_source == gpu::kPlacesGiven ? 0 : in_.stereo.rowSteps();
    const Kernel& resample_kernel = kernel(
        "8e_resample", pass,
        {alongRows(), predict_errors, with_depth, keepsClasses(), groupsHoles(), row_steps, halfFloats(), copiesColours(), row_source});
    dispatchByCounter(resample_kernel, pass, offsetof(gpu::StereoCounters, per_row));
}

void StereoRecorder::findNewcomers() {
    commands_.beginPass("affiliated 8f_newcomers");
    const gpu::NewcomersPass pass{.chunks = in_.scene.chunks(),
                                  .eyes = in_.buffers.eyes(),
                                  .stereo = view(),
                                  .tile_depths = in_.stereo.tileDepths(),
                                  .order = in_.buffers.visible.order().values,
                                  .visible = visible(),
                                  .dominant_counts = in_.buffers.visible.tileCounts(),
                                  .tile_kinds = in_.stereo.tileKinds(),
                                  .tile_errors = in_.stereo.tileErrors(),
                                  .counters = counters(),
                                  .chunk_bits = in_.scene.chunkBits(),
                                  .eye = static_cast<gpu::uint>(1 - in_.dominant_eye)};
    dispatchByCounter(kernel("8f_newcomers", pass, {in_.scene.splatKind()}), pass, offsetof(gpu::StereoCounters, per_visible));
}

void StereoRecorder::groupHoles() {
    commands_.beginPass("affiliated 8g_components");
    const gpu::ComponentsPass pass{.stereo = view(),
                                   .pixels = in_.affiliated.colours.address<gpu::ComponentPixel>(),
                                   .pixel_classes = in_.stereo.pixelClasses(),
                                   .boxes = in_.stereo.boxes(),
                                   .tile_kinds = in_.stereo.tileKinds(),
                                   .counters = counters(),
                                   .box_capacity = in_.stereo.needs().boxes};
    for (std::uint32_t step = 0; step < 3; ++step) {
        dispatchByCounter(kernel("8g_components", pass, {step, halfFloats()}), pass, offsetof(gpu::StereoCounters, component_groups));
    }
    commands_.dispatch(kernel("8g_components", pass, {3u, halfFloats()}), pass, kMarkGroups);
}

void StereoRecorder::price() {
    commands_.beginPass("affiliated 8h_price");
    const gpu::PricePass pass{.stereo = view(),
                              .tile_kinds = in_.stereo.tileKinds(),
                              .tile_costs = in_.stereo.tileCosts(),
                              .tile_errors = in_.stereo.tileErrors(),
                              .tile_prices = in_.stereo.tilePrices(),
                              .price_bins = in_.stereo.bins(),
                              .masked_tiles = listAt(offsetof(FrameState, masked_tiles)),
                              .counters = counters(),
                              .gaze = in_.affiliated_gaze ? eyeGazeOf(*in_.affiliated_gaze, in_.affiliated_lens) : gpu::EyeGaze{}};
    commands_.dispatch(kernel("8h_price", pass, {in_.affiliated_gaze.has_value()}), pass, tileGroups());
}

void StereoRecorder::select() {
    commands_.beginPass("affiliated 8i_select");
    const gpu::SelectPass pass{.stereo = view(),
                               .tile_kinds = in_.stereo.tileKinds(),
                               .tile_prices = in_.stereo.tilePrices(),
                               .tile_list = in_.stereo.tileList(),
                               .tile_mask = in_.stereo.tileMask(),
                               .tile_costs = in_.stereo.tileCosts(),
                               .visible = visible(),
                               .masked_tiles = listAt(offsetof(FrameState, masked_tiles)),
                               .masked_visible = listAt(offsetof(FrameState, masked_visible)),
                               .counters = counters()};
    commands_.dispatch(kernel("8i_select", pass, {predicts()}), pass, tileGroups());
}

}  // namespace

void StereoPasses::record(Commands& commands, const StereoPassInputs& in) {
    StereoRecorder passes(kernels_, commands, in);
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
