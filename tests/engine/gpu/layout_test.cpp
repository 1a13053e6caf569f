// The structs that C++ and GLSL share have the same fields at the same offsets in both: compares what the
// compiled shaders say with offsetof and sizeof. Also checks how shaders use their constants and structs of
// addresses.
#include "engine/levels/contribute.h"
#include "engine/passes/history_passes.h"
#include "engine/passes/passes.h"
#include "engine/passes/present.h"
#include "shaders/embedded_shaders.h"
#include "tests/engine/gpu/compiled_shader.h"
#include "tests/engine/gpu/gpu_fixture.h"

SUITE(layout) {

// A struct of shaders/shared with its fields; the comparison notices structs that are missing here.
#define AGAIN(...) AGAIN_27(AGAIN_27(AGAIN_27(__VA_ARGS__)))
#define AGAIN_27(...) AGAIN_9(AGAIN_9(AGAIN_9(__VA_ARGS__)))
#define AGAIN_9(...) AGAIN_3(AGAIN_3(AGAIN_3(__VA_ARGS__)))
#define AGAIN_3(...) __VA_ARGS__
#define PARENTHESES ()
#define FIELDS(name, ...) \
    Field{#name, offsetof(S, name), sizeof(S::name)} __VA_OPT__(, NEXT_FIELDS PARENTHESES(__VA_ARGS__))
#define NEXT_FIELDS() FIELDS
#define LAYOUT(Struct, ...)                                              \
    [] {                                                                 \
        using S = gpu::Struct;                                           \
        return Layout{#Struct, sizeof(S), {AGAIN(FIELDS(__VA_ARGS__))}}; \
    }()

std::vector<Layout> hostLayouts() {
    return {
        LAYOUT(SceneChunk, positions, rotations, scales, thicknesses, opacities, base_colours, sh, placement,
               fade, sh_degree),
        LAYOUT(Placement, x, y, z, position, scale),
        LAYOUT(ScenePage, low, reach, high, count),
        LAYOUT(EyeView, camera_from_world_x, camera_from_world_y, camera_from_world_z, position, focal_px,
               principal_px, size_px, size_tiles, near, max_inverse_depth, camera_from_world_x_low,
               camera_from_world_y_low, camera_from_world_z_low, position_low, focal_px_low, principal_px_low,
               low_pass, screen_variance),
        LAYOUT(Place, position, position_low),
        LAYOUT(ProjectedSplat, reference_px, plane_from_pixel, perspective, inverse_depth, opacity, colour),
        LAYOUT(DispatchSize, x, y, z),
        LAYOUT(ListState, needed, count, groups_done, run_groups_done, per_item, per_block, per_sort_block),
        LAYOUT(PixelMap, excess_x, excess_y, excess_z, shift),
        LAYOUT(WarpView, target_from_source, source_from_target, size_px, size_tiles, row_words, rows_apart,
               gap_px, margin_px, edge_samples, tight_edges, move_cost, budget, hole_error, newcomer_error,
               error_bound),
        LAYOUT(HistoryView, history_from_now, now_from_history, size_px, size_tiles, history_size_px,
               history_size_tiles, nearest, background),
        LAYOUT(HistoryTile, cost, age, growth, errors, grown, lost, unseen, squared_gradient),
        LAYOUT(ChangedRect, begin_px, end_px, error),
        LAYOUT(HistoryBlock, place, inverse_depths),
        LAYOUT(HistoryBlockList, per_group, count),
        LAYOUT(ComponentPixel, parent, component),
        LAYOUT(WarpCounters, covered_pixels, gap_pixels, hole_pixels, components, edge_tiles, center_tiles,
               predicted_tiles, cheap_tiles, newcomers, reprojected_tiles, picture_cost, shown_tiles,
               saved_cost, chosen_cost, moves, pays, last_bin, left_for_last, waiting_tiles, left_squares,
               expected_squares, found_squares, wider_squares, borders_px, per_pixel_block, per_row,
               per_visible, component_groups),
        LAYOUT(EyeGaze, direction, clear_rad, pixel_cycle, focal_px, principal_px),
        LAYOUT(PixelBox, x0, y0, x1, y1),
        LAYOUT(EyeCounters, pairs, full_tiles, coarse_tiles, per_full_tile, coarse_kept, coarse_pairs,
               sharp_pairs, may_be_coarse, gaze),
        LAYOUT(TargetState, colours, depths, mesh_depths, moments, moving, arrivals, history_tiles, tile_mask,
               tile_list, full_tiles, tile_kinds, tile_costs, tile_errors, tile_prices, pairs, counters, warp,
               warp_counters, history, history_blocks, chosen_tiles, chosen_visible, first_tile, row_words,
               measured, depth_scale, depth_offset, is_made, area),
        LAYOUT(CullPagesPass, pages, eyes, page_bits, word_offsets, page_list, visible_pages, page_count,
               first_eye, eye_count),
        LAYOUT(CullPass, chunks, eyes, page_list, visible_pages, visible_bits, group_counts, visible,
               splat_count, chunk_bits, first_eye, eye_count, capacity, at_once, first_tile_mask,
               last_tile_mask),
        LAYOUT(CompactPass, chunks, eyes, page_list, visible_pages, visible_bits, group_offsets, visible,
               keys, splats, splat_count, chunk_bits, order_eye, by_distance, middle),
        LAYOUT(ProjectPass, chunks, eyes, order, visible, splats, tile_sets, group_sums, pairs, targets,
               chunk_bits, splats_apart, capacity, is_dimmed),
        LAYOUT(BinPass, eyes, splats, tile_sets, group_sums, visible, pairs, tiles, ranks, targets,
               splats_apart, all_tiles, rank_bits),
        LAYOUT(TileRangesPass, eyes, tiles, pairs, ranges, visible, targets, background, rank_bits),
        LAYOUT(RasterizePass, eyes, splats, ranks, ranges, targets, background, depth_choice, is_light,
               splats_apart, rank_bits, is_dimmed),
        LAYOUT(ContributePass, eyes, splats, ranks, ranges, order, picture, wanted, sums, eye, rank_bits),
        LAYOUT(WeighPass, warp, ranges, moving, tile_kinds, tile_costs, tile_errors, tile_depths, tile_mask,
               price_bins, shown_mask, visible, masked_tiles, counters, kinds_given),
        LAYOUT(DepthBoundsPass, warp, colours, half_colours, moving, bins),
        LAYOUT(EdgeRoisPass, warp, bins, tile_kinds, shown_mask, counters),
        LAYOUT(ReprojectPass, warp, moving, arrivals, shown_mask),
        LAYOUT(WarpHistoryPass, view, source, source_words, source_tiles, target, target_words, tiles,
               tile_kinds, tile_mask, price_bins, shown_mask, history_shown, blocks, block_list),
        LAYOUT(NewcomersPass, chunks, eyes, warp, tile_depths, order, visible, source_sets, tile_kinds,
               tile_errors, counters, chunk_bits, eye, is_dimmed),
        LAYOUT(ResamplePass, warp, source, half_source, moving, target, half_target, depths, tile_kinds,
               tile_errors, pixel_classes, counters, shown_mask, background, first_row, copies_colours,
               groups_holes),
        LAYOUT(ComponentsPass, warp, pixels, pixel_classes, boxes, tile_kinds, counters, box_capacity,
               slots_apart),
        LAYOUT(MarkChangedPass, tiles, rects, size_tiles, count),
        LAYOUT(PricePass, targets, chosen, price_bins, most_cost),
        LAYOUT(SelectPass, targets, chosen, visible, at_once),
        LAYOUT(SortCountPass, keys, histograms, run_sums, digit_begins, list, shift, digits),
        LAYOUT(SortScatterPass, keys_in, values_in, keys_out, values_out, histograms, run_sums, digit_begins,
               list, shift, digits),
        LAYOUT(PresentPass, colours, half_colours, depths, words, tile_kinds, pixel_classes, pixels,
               device_depths, mesh_depths, size_px, depth_scale, depth_offset, blue_first, linear,
               see_through, over, is_cut, kept_bits),
        LAYOUT(TurnPass, pixels, shown, column_x, column_y, column_z, picture_px, view_px, linear),
    };
}

// What is wrong with a shader's struct, or "". The language's own blocks have no counterpart in C++: the push
// constants, the arrays behind an address, and sixteen bytes of anything (lib/history.glsl).
std::string findMismatch(const Layout& shader, const std::vector<Layout>& host) {
    if (shader.name == "Push" || shader.name == "Sixteen" ||
        (shader.fields.size() == 1 && shader.fields[0].name == "at")) {
        return {};
    }
    const auto twin = std::ranges::find(host, shader.name, &Layout::name);
    if (twin == host.end()) { return shader.name + " is missing in the table of this test"; }
    if (shader.bytes != 0 && shader.bytes != twin->bytes) { return shader.name + " has another size"; }
    if (shader.fields.size() != twin->fields.size()) { return shader.name + " has another number of fields"; }
    const auto other = std::ranges::mismatch(shader.fields, twin->fields).in1;
    return other != shader.fields.end() ? shader.name + "." + other->name + " differs" : "";
}

// What shaders/passes.def says about each pass.
struct ListedPass {
    std::string push_struct;
    std::map<std::uint32_t, std::string> constants;
};
std::map<std::string, ListedPass> listedPasses() {
    std::map<std::string, ListedPass> passes;
#define PASS(folder, shader, Name, Struct, ...)                                            \
    passes[#shader].push_struct = #Struct;                                                 \
    for (std::uint32_t id = 0; id < Name##Kernel::constants().size(); ++id) {              \
        passes[#shader].constants[id] = nameInShader(Name##Kernel::constants()[id].field); \
    }
#include "shaders/passes.def"
#undef PASS
    return passes;
}

TEST_CASE("every shader's structs have the fields, offsets and sizes that C++ gives them") {
    const std::vector<Layout> host = hostLayouts();
    const std::map<std::string, ListedPass> listed = listedPasses();
    std::set<std::string> seen;
    const fs::recursive_directory_iterator shaders(fs::path(BINOSPLAT_SOURCE_DIR) / "shaders");
    const auto isShader = [](const fs::directory_entry& entry) {
        return entry.path().extension() == ".comp";
    };
    CHECK(std::count_if(begin(shaders), end(shaders), isShader) ==
          static_cast<std::ptrdiff_t>(listed.size()));
    for (const auto& [name, pass] : listed) {
        CAPTURE(name);
        const auto words = embeddedShader(name);
        REQUIRE_FALSE(words.empty());
        const CompiledShader shader(words);
        CHECK(shader.pushStruct() == pass.push_struct);
        for (const Layout& layout : shader.layouts()) {
            CHECK(findMismatch(layout, host) == "");
            seen.insert(layout.name);
        }
    }
    for (const Layout& layout : host) {
        CAPTURE(layout.name);
        CHECK(seen.contains(layout.name));
        // Every device has this many bytes of push constants.
        if (layout.name.ends_with("Pass")) { CHECK(layout.bytes <= 128); }
    }
}

TEST_CASE_FIXTURE(Gpu, "every kernel reads each constant that it is compiled for, under C++'s name") {
    KernelTable table = PassKernels(context()).table();
    append(table, presentKernels());
    CHECK(table.size() <= 198);  // each takes seconds in a driver's compiler, so the number may only fall
    std::set<std::string> made;
    for (const KernelVariant& variant : table) { made.insert(variant.shader); }
    const std::map<std::string, ListedPass> listed = listedPasses();
    CHECK(made.size() == listed.size());
    for (const auto& [name, pass] : listed) {
        CAPTURE(name);
        const CompiledShader shader(embeddedShader(name));
        CHECK(shader.declaredConstants() == pass.constants);
        std::set<std::uint32_t> ids;
        for (const auto& [id, constant] : pass.constants) { ids.insert(id); }
        CHECK(shader.readConstants() == ids);
    }
}

TEST_CASE_FIXTURE(Gpu, "every kernel has full subgroups where its width and the device allow it") {
    const std::uint32_t lanes = context().maxSubgroupSize();
    const bool is_offered = context().fullSubgroups(lanes) != vk::PipelineShaderStageCreateFlags();
    CHECK(is_offered == context().hasDeviceExtension(VK_EXT_SUBGROUP_SIZE_CONTROL_EXTENSION_NAME));
    CHECK(context().fullSubgroups(lanes + 1) == vk::PipelineShaderStageCreateFlags());
    // The group's width is a literal, a constant, or a constant other than the first.
    CHECK(Kernel(context(), variantOf(BinKernel{})).subgroups() == context().fullSubgroups(gpu::kGroupSize));
    CHECK(Kernel(context(), variantOf(SortCountKernel{.threads = 4 * lanes})).subgroups() ==
          context().fullSubgroups(lanes));
    CHECK(Kernel(context(), variantOf(SortCountKernel{.threads = 3 * lanes / 2})).subgroups() ==
          context().fullSubgroups(lanes + 1));
}

TEST_CASE("no shader copies a struct of addresses, nor loads an address as if it lay anywhere") {
    for (const auto& [name, pass] : listedPasses()) {
        CAPTURE(name);
        const CompiledShader shader(embeddedShader(name));
        CHECK(these(shader.copiedAddresses(), shader.looseAddresses()) == these("", 0));
    }
}

TEST_CASE_FIXTURE(Gpu, "a shader that breaks off is refused, whatever the driver would make of it") {
    const auto words = embeddedShader("bin");
    const std::vector<std::uint32_t> whole(words.begin(), words.end());
    for (const std::size_t length : {std::size_t{3}, std::size_t{6}}) {
        context().replacedShaders()["bin"] = {whole.begin(),
                                              whole.begin() + static_cast<std::ptrdiff_t>(length)};
        CHECK_THROWS_AS(Kernel(context(), variantOf(BinKernel{})), Error);
    }
    context().replacedShaders()["bin"] = whole;
    context().replacedShaders()["bin"][5] = 0;  // an instruction with zero words
    CHECK_THROWS_AS(Kernel(context(), variantOf(BinKernel{})), Error);
    context().replacedShaders().erase("bin");
}

TEST_CASE("a wrong field is found") {
    const Layout right{"Thing", 12, {{"a", 0, 4}, {"b", 4, 8}}};
    CHECK(findMismatch(right, {right}).empty());
    CHECK(findMismatch({"Thing", 12, {{"a", 0, 4}, {"b", 8, 8}}}, {right}) == "Thing.b differs");
    CHECK(findMismatch({"Thing", 12, {{"a", 0, 4}, {"b", 4, 4}}}, {right}) == "Thing.b differs");
    CHECK(findMismatch({"Thing", 12, {{"b", 0, 4}, {"a", 4, 8}}}, {right}) == "Thing.b differs");
    CHECK(findMismatch({"Thing", 12, {{"a", 0, 4}}}, {right}) == "Thing has another number of fields");
    CHECK(findMismatch({"Thing", 16, right.fields}, {right}) == "Thing has another size");
    CHECK(findMismatch({"Other", 12, right.fields}, {right}) == "Other is missing in the table of this test");
}

}  // SUITE(layout)
