// Recording the passes that make one eye from the other.
#include "engine/passes/stereo_passes.h"

#include <cstddef>

namespace binosplat {
namespace {

// Boxes of holes are strided over by so many workgroups.
constexpr gpu::uint kMarkGroups = 64;

constexpr std::uint64_t counterOffset(std::uint64_t field) { return offsetof(FrameState, stereo_counters) + field; }

}  // namespace

gpu::StereoView stereoViewOf(const EyeRelation& relation, glm::uvec2 size_px, gpu::uint row_words, const StereoSettings& settings) {
    return {.affiliated_from_dominant = relation.affiliated_from_dominant,
            .dominant_from_affiliated = relation.dominant_from_affiliated,
            .size_px = size_px,
            .size_tiles = tilesOf(size_px),
            .row_words = row_words,
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

KernelTable stereoKernels() {
    KernelTable table =
        everyVariant("8a_weigh", sizeof(gpu::WeighPass), {{"kRectified", 2}, {"kHiddenTiles", 2}, {"kKindsGiven", 2}, {"kMayMove", 2}});
    append(table, everyVariant("8b_depth_bounds", sizeof(gpu::DepthBoundsPass), {{"kRectified", 2}, {"kHalfColours", 2}}));
    append(table, everyVariant("8c_edge_rois", sizeof(gpu::EdgeRoisPass), {{"kRectified", 2}, {"kHiddenTiles", 2}}));
    append(table, everyVariant("8d_reproject", sizeof(gpu::ReprojectPass), {{"kRectified", 2}, {"kHiddenTiles", 2}, {"kForward", 2}}));
    append(table, everyVariant("8e_newcomers", sizeof(gpu::NewcomersPass), {{"kRectified", 2}, {"kSplatKind", 3}}));
    for (const KernelVariant& variant : everyVariant("8f_resample", sizeof(gpu::ResamplePass),
                                                     {{"kRectified", 2},
                                                      {"kPredictErrors", 2},
                                                      {"kDepth", 2},
                                                      {"kClasses", 2},
                                                      {"kComponents", 2},
                                                      {"kRowSteps", gpu::kMostRowSteps + 1},
                                                      {"kHalfColours", 2},
                                                      {"kForward", 2}})) {
        // Only the paper's holes are grouped, and by their classes. Errors are those of sampling.
        const std::vector<std::uint32_t> values = variant.values();
        const bool groups = values[4] == 0 || (values[1] == 0 && values[3] == 1);
        if (groups && (values[1] == 0 || values[7] == 0)) { table.push_back(variant); }
    }
    append(table, everyVariant("8g_components", sizeof(gpu::ComponentsPass), {{"kRectified", 2}, {"kStep", 4}, {"kHalfColours", 2}}));
    append(table, everyVariant("8h_price", sizeof(gpu::PricePass)));
    append(table, everyVariant("8i_select", sizeof(gpu::SelectPass), {{"kPredicted", 2}}));
    return table;
}

void StereoPasses::record(Commands& commands, const StereoPassInputs& in) {
    const StereoBuffers& stereo = in.stereo;
    const Buffer& state = in.buffers.state;
    const auto view = state.address<gpu::StereoView>(offsetof(FrameState, stereo));
    const auto counters = state.address<gpu::StereoCounters>(offsetof(FrameState, stereo_counters));
    const auto visible = state.address<gpu::ListState>(FrameBuffers::visibleList(in.list));
    const auto dominant = in.dominant.colours.address<gpu::vec4>();
    const auto half_dominant = in.dominant.colours.address<gpu::uvec2>();
    const std::uint32_t half_floats = in.dominant.half_floats ? 1 : 0;
    const auto moving = stereo.moving(in.affiliated), arrivals = stereo.arrivals(in.affiliated);
    const auto shown_mask = in.dominant_shown.mask();
    const std::uint32_t along_rows = in.rectified ? 1 : 0, hides = in.dominant_shown.hideAny() ? 1 : 0;
    const bool predict = in.settings.patching == Patching::kPredicted;
    const bool paper = in.settings.patching == Patching::kPaper;
    const bool components = paper && in.settings.center_rois;
    const bool forward = in.settings.forward && !predict;
    const bool classes = stereo.needs().classes || components;
    const gpu::uint tile_groups = (stereo.tileCount() + gpu::kStereoGroup - 1) / gpu::kStereoGroup;
    const auto kernel = [&]<typename Pass>(const char* name, const Pass&, std::initializer_list<std::uint32_t> constants) -> const Kernel& {
        return kernels_.get(name, sizeof(Pass), constants);
    };

    if (predict) {
        commands.beginPass("affiliated 8a_weigh");
        in.affiliated_shown.recordKinds(commands, stereo.tiles(), StereoBuffers::tileKindsOffset());
        const gpu::WeighPass pass{.stereo = view,
                                  .ranges = in.buffers.tile_ranges.address<gpu::uvec2>(),
                                  .moving = moving,
                                  .tile_kinds = stereo.tileKinds(),
                                  .tile_costs = stereo.tileCosts(),
                                  .tile_errors = stereo.tileErrors(),
                                  .tile_mask = stereo.tileMask(),
                                  .price_bins = stereo.bins(),
                                  .shown_mask = shown_mask,
                                  .visible = visible,
                                  .masked_tiles = state.address<gpu::ListState>(offsetof(FrameState, masked_tiles)),
                                  .counters = counters};
        commands.dispatch(kernel("8a_weigh", pass, {along_rows, hides, in.affiliated_shown.hideAny(), in.may_move}), pass, tile_groups);
        if (!in.may_move) { return; }
    } else {
        commands.beginPass(paper ? "affiliated 8b_depth_bounds" : "affiliated 8d_reproject");
        commands.fillZero(stereo.tiles());
        in.affiliated_shown.recordKinds(commands, stereo.tiles(), StereoBuffers::tileKindsOffset());
    }
    if (paper) {
        const gpu::DepthBoundsPass bounds{
            .stereo = view, .colours = dominant, .half_colours = half_dominant, .moving = moving, .bins = stereo.bins()};
        commands.dispatch(kernel("8b_depth_bounds", bounds, {along_rows, half_floats}), bounds, stereo.sizeTiles().x,
                          2 * stereo.sizeTiles().y);
        commands.beginPass("affiliated 8c_edge_rois");
        const gpu::EdgeRoisPass edges{
            .stereo = view, .bins = stereo.bins(), .tile_kinds = stereo.tileKinds(), .shown_mask = shown_mask, .counters = counters};
        commands.dispatch(kernel("8c_edge_rois", edges, {along_rows, hides}), edges, tile_groups);
    }
    {
        commands.beginPass("affiliated 8d_reproject");
        const gpu::ReprojectPass pass{.stereo = view, .moving = moving, .arrivals = arrivals, .shown_mask = shown_mask};
        commands.dispatchIndirect(kernel("8d_reproject", pass, {along_rows, hides, forward}), pass, state,
                                  counterOffset(offsetof(gpu::StereoCounters, per_pixel_block)));
    }
    if (predict) {
        commands.beginPass("affiliated 8e_newcomers");
        const gpu::NewcomersPass pass{.chunks = in.scene.chunks(),
                                      .eyes = in.buffers.eyes(),
                                      .stereo = view,
                                      .arrivals = arrivals,
                                      .order = in.buffers.visible.order().values,
                                      .visible = visible,
                                      .dominant_counts = in.buffers.visible.tileCounts(),
                                      .tile_kinds = stereo.tileKinds(),
                                      .tile_errors = stereo.tileErrors(),
                                      .counters = counters,
                                      .chunk_bits = in.scene.chunkBits(),
                                      .eye = static_cast<gpu::uint>(1 - in.dominant_eye)};
        commands.dispatchIndirect(kernel("8e_newcomers", pass, {along_rows, in.scene.splatKind()}), pass, state,
                                  counterOffset(offsetof(gpu::StereoCounters, per_visible)));
    }
    {
        commands.beginPass("affiliated 8f_resample");
        const gpu::ResamplePass pass{.stereo = view,
                                     .dominant = dominant,
                                     .half_dominant = half_dominant,
                                     .arrivals = arrivals,
                                     .affiliated = in.affiliated.colours.address<gpu::vec4>(),
                                     .half_affiliated = in.affiliated.colours.address<gpu::uvec2>(),
                                     .depths = in.affiliated.depths.address<float>(),
                                     .tile_kinds = stereo.tileKinds(),
                                     .tile_errors = stereo.tileErrors(),
                                     .pixel_classes = stereo.pixelClasses(),
                                     .component_pixels = in.affiliated.colours.address<gpu::ComponentPixel>(),
                                     .counters = counters,
                                     .background = in.background};
        const std::uint32_t with_depth = in.affiliated.depths.bytes() > 0 ? 1 : 0;
        commands.dispatchIndirect(
            kernel("8f_resample", pass, {along_rows, predict, with_depth, classes, components, stereo.rowSteps(), half_floats, forward}),
            pass, state, counterOffset(offsetof(gpu::StereoCounters, per_row)));
    }
    if (components) {
        commands.beginPass("affiliated 8g_components");
        const gpu::ComponentsPass pass{.stereo = view,
                                       .pixels = in.affiliated.colours.address<gpu::ComponentPixel>(),
                                       .pixel_classes = stereo.pixelClasses(),
                                       .boxes = stereo.boxes(),
                                       .tile_kinds = stereo.tileKinds(),
                                       .counters = counters,
                                       .box_capacity = stereo.needs().boxes};
        for (std::uint32_t step = 0; step < 3; ++step) {
            commands.dispatchIndirect(kernel("8g_components", pass, {along_rows, step, half_floats}), pass, state,
                                      counterOffset(offsetof(gpu::StereoCounters, component_groups)));
        }
        commands.dispatch(kernel("8g_components", pass, {along_rows, 3u, half_floats}), pass, kMarkGroups);
    }
    if (predict) {
        commands.beginPass("affiliated 8h_price");
        const gpu::PricePass pass{.stereo = view,
                                  .tile_kinds = stereo.tileKinds(),
                                  .tile_costs = stereo.tileCosts(),
                                  .tile_errors = stereo.tileErrors(),
                                  .tile_prices = stereo.tilePrices(),
                                  .price_bins = stereo.bins()};
        commands.dispatch(kernel("8h_price", pass, {}), pass, tile_groups);
    }
    if (paper || predict) {
        commands.beginPass("affiliated 8i_select");
        const gpu::SelectPass pass{.stereo = view,
                                   .tile_kinds = stereo.tileKinds(),
                                   .tile_prices = stereo.tilePrices(),
                                   .price_bins = stereo.bins(),
                                   .tile_list = stereo.tileList(),
                                   .tile_mask = stereo.tileMask(),
                                   .tile_costs = stereo.tileCosts(),
                                   .visible = visible,
                                   .masked_tiles = state.address<gpu::ListState>(offsetof(FrameState, masked_tiles)),
                                   .masked_visible = state.address<gpu::ListState>(offsetof(FrameState, masked_visible)),
                                   .counters = counters};
        commands.dispatch(kernel("8i_select", pass, {predict}), pass, tile_groups);
    }
}

}  // namespace binosplat
