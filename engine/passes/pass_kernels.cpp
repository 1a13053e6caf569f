// Lists the variants of all kernels.
#include "engine/passes/pass_kernels.h"

#include "engine/passes/passes.h"
#include "engine/passes/warp_buffers.h"

#include <algorithm>
#include <bit>
#include <cassert>

namespace binosplat {

namespace {

// A cell gets one subgroup if subgroups have 8 to 64 invocations and four of them fit into a workgroup.
std::uint32_t cellThreads(const Context& context, std::uint32_t wanted) {
    const std::uint32_t most =
        std::min(64u, std::bit_floor(context.maxGroupInvocations() / gpu::kCellsPerTile));
    return std::clamp(wanted != 0 ? wanted : context.subgroupSize(), 8u, most);
}

bool areNarrow(const Context& context, std::uint32_t threads_per_cell) {
    return Sort::hasNarrowSubgroups(context) && threads_per_cell == context.subgroupSize();
}

// Kernels of cull to rasterize, without sorting.
KernelTable frameKernels(std::uint32_t threads) {
    KernelTable table = everyVariantOf<CullPagesKernel, BinKernel>();
    append(table, everyVariant<CullKernel>([](const CullKernel& k) { return k.placed <= k.in_pages; }));
    append(table, everyVariant<CompactKernel>([](const CompactKernel& k) { return k.placed <= k.in_pages; }));
    // Scenes that are placed among others each have their own degree.
    append(table, everyVariant<ProjectKernel>(
                      [](const ProjectKernel& k) { return k.placed == 0 || k.sh_degree == kMaxShDegree; }));
    append(table, everyVariant<TileRangesKernel>(
                      [](const TileRangesKernel& k) { return k.masked == 1 || k.half_colours == 0; }));
    for (std::uint32_t choices = 0; choices < 8; ++choices) {
        const Kept plain{.depth = (choices & 1) != 0, .half_floats = (choices & 2) != 0};
        Kept moving = plain, even_rows = plain, history = plain, cut = plain;
        cut.cut = true;
        moving.moving = even_rows.moving = even_rows.even_rows = history.history = true;
        const auto add = [&](const Kept& kept, bool masked, bool coarse = false) {
            table.push_back(variantOf(rasterizeKernel(threads, kept, choices >> 2, masked, coarse)));
        };
        for (const Kept& kept : {plain, moving, even_rows}) { add(kept, false); }
        add(plain, true);
        if (plain.depth) { continue; }  // a history's depths follow from its words
        add(cut, false);
        add(history, false);
        add(history, true);
        for (const Kept& kept : {plain, history}) { add(kept, true, true); }
    }
    return table;
}

// Kernels that make one eye from the other.
KernelTable warpKernels(const Context& context) {
    KernelTable table = everyVariantOf<WeighKernel, DepthBoundsKernel, EdgeRoisKernel, ReprojectKernel,
                                       NewcomersKernel, ComponentsKernel>();
    append(table, everyVariant<ResampleKernel>([most_steps = mostRowSteps(context)](const ResampleKernel& k) {
               // Rows are moved if they can be, and odd rows of predicted are warped like even ones.
               if (k.row_source == gpu::kPlacesGiven) {
                   return k.rectified && k.row_steps == 0 &&
                          (k.way == gpu::kSamples || k.way == gpu::kDoesAny);
               }
               return k.row_steps <= most_steps &&
                      (k.row_source != gpu::kArrivalsGiven) == (k.rectified && k.row_steps > 0) &&
                      (k.row_source != gpu::kWholeRowMoved || k.way == gpu::kPredicts);
           }));
    append(table, everyVariant<PriceKernel>([](const PriceKernel& k) { return k.history == 0; }));
    append(table, everyVariant<SelectKernel>([](const SelectKernel& k) { return k.history == 0; }));
    return table;
}

// Kernels that make an eye from its history.
KernelTable historyKernels(bool by_address) {
    KernelTable table = everyVariant<WarpHistoryKernel>(
        [=](const WarpHistoryKernel& k) { return k.by_address == by_address; });
    append(table, everyVariant<WarpPixelsKernel>(
                      [=](const WarpPixelsKernel& k) { return k.by_address == by_address; }));
    append(table, everyVariant<MarkChangedKernel>());
    append(table, everyVariant<PriceKernel>([](const PriceKernel& k) { return k.history == 1; }));
    append(table, everyVariant<SelectKernel>(
                      [](const SelectKernel& k) { return k.history == 1 && k.predicted == 1; }));
    return table;
}

KernelTable allKernels(const Context& context, const Sort& sort, std::uint32_t threads_per_cell) {
    KernelTable table = frameKernels(threads_per_cell);
    append(table, sort.kernels());
    append(table, warpKernels(context));
    append(table, historyKernels(context.isSoftware()));
    for (std::uint32_t choices = 0; choices < 4; ++choices) {
        const bool by_lanes = areNarrow(context, threads_per_cell);
        table.push_back(
            variantOf(contributeKernel(threads_per_cell, choices >> 1, (choices & 1) != 0, by_lanes)));
    }
    return table;
}

}  // namespace

PassKernels::PassKernels(const Context& context, const Sort& sort, std::uint32_t threads_per_cell)
    : KernelCache(context, allKernels(context, sort, threads_per_cell)),
      threads_per_cell_(threads_per_cell),
      cells_are_narrow_(areNarrow(context, threads_per_cell)),
      by_address_(context.isSoftware()),
      sort_(sort) {}

PassKernels::PassKernels(const Context& context, std::uint32_t threads_per_cell)
    : PassKernels(context, Sort(context), cellThreads(context, threads_per_cell)) {}

ContributeKernel contributeKernel(std::uint32_t threads_per_cell, std::uint32_t splat_kind, bool fits,
                                  bool by_lanes) {
    return {.threads_per_cell = threads_per_cell,
            .splat_kind = splat_kind,
            .fits = fits,
            .local_size_x = gpu::kCellsPerTile * threads_per_cell,
            .by_lanes = by_lanes};
}

// With coarse tiles there is one kernel for everything that a picture may keep; so there is if meshes cut
// splats.
RasterizeKernel rasterizeKernel(std::uint32_t threads_per_cell, const Kept& kept, std::uint32_t splat_shape,
                                bool masked, bool coarse) {
    const bool moves_by_depth = kept.moving && kept.depth_choice != gpu::kDepthInverse;
    return {.threads_per_cell = threads_per_cell,
            // A history has the depth from its words.
            .depth = (kept.depth || moves_by_depth || coarse || kept.cut) && !kept.history,
            .moments = kept.moments || kept.moving || kept.history,
            .half_colours = kept.half_floats,
            .splat_kind = splat_shape,
            .local_size_x = gpu::kCellsPerTile * threads_per_cell,
            .even_rows = kept.even_rows,
            .masked = masked,
            .history = kept.history,
            .coarse = coarse,
            .cut = kept.cut};
}

}  // namespace binosplat
