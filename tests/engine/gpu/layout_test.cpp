// The structs that C++ and GLSL share have the same fields at the same offsets in both: what the compiled shaders say of them is
// held against offsetof and sizeof. Also what shaders do with their constants, and with structs of addresses.
#include "engine/error.h"
#include "engine/passes/passes.h"
#include "engine/passes/past_passes.h"
#include "engine/passes/periphery.h"
#include "engine/passes/present.h"
#include "engine/passes/warp_passes.h"
#include "shaders/embedded_shaders.h"
#include "shaders/shared/passes.h"
#include "tests/engine/gpu/gpu_fixture.h"
#include "tests/engine/gpu/shader_words.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

TEST_SUITE_BEGIN("layout");

namespace layout_test {

using namespace binosplat;

namespace {

struct Field {
    std::string name;
    std::size_t offset, bytes;
    bool operator==(const Field&) const = default;
};

struct Layout {
    std::string name;
    std::size_t bytes;
    std::vector<Field> fields;
};

// A struct of shaders/shared by its fields; one that is left out here is missed by the comparison.
#define FIELD(name) \
    { #name, offsetof(S, name), sizeof(S::name) }
#define LAYOUT(Struct, ...)                               \
    [] {                                                  \
        using S = gpu::Struct;                            \
        return Layout{#Struct, sizeof(S), {__VA_ARGS__}}; \
    }()

std::vector<Layout> hostLayouts() {
    return {
        LAYOUT(SceneChunk, FIELD(positions), FIELD(rotations), FIELD(scales), FIELD(thicknesses), FIELD(opacities), FIELD(base_colours),
               FIELD(sh), FIELD(fade), FIELD(unused)),
        LAYOUT(ScenePage, FIELD(low), FIELD(reach), FIELD(high), FIELD(count)),
        LAYOUT(EyeView, FIELD(camera_from_world_x), FIELD(camera_from_world_y), FIELD(camera_from_world_z), FIELD(position),
               FIELD(focal_px), FIELD(principal_px), FIELD(size_px), FIELD(size_tiles), FIELD(near), FIELD(max_inverse_depth),
               FIELD(camera_from_world_x_low), FIELD(camera_from_world_y_low), FIELD(camera_from_world_z_low), FIELD(position_low),
               FIELD(focal_px_low), FIELD(principal_px_low), FIELD(low_pass), FIELD(screen_variance)),
        LAYOUT(Place, FIELD(position), FIELD(position_low)),
        LAYOUT(ProjectedSplat, FIELD(reference_px), FIELD(plane_from_pixel), FIELD(perspective), FIELD(inverse_depth), FIELD(opacity),
               FIELD(colour)),
        LAYOUT(DispatchSize, FIELD(x), FIELD(y), FIELD(z)),
        LAYOUT(ListState, FIELD(needed), FIELD(count), FIELD(groups_done), FIELD(run_groups_done), FIELD(per_item), FIELD(per_block),
               FIELD(per_sort_block)),
        LAYOUT(PixelMap, FIELD(excess_x), FIELD(excess_y), FIELD(excess_z), FIELD(shift)),
        LAYOUT(WarpView, FIELD(target_from_source), FIELD(source_from_target), FIELD(size_px), FIELD(size_tiles), FIELD(row_words),
               FIELD(rows_apart), FIELD(gap_px), FIELD(margin_px), FIELD(edge_samples), FIELD(tight_edges), FIELD(move_cost), FIELD(budget),
               FIELD(hole_error), FIELD(newcomer_error)),
        LAYOUT(PastView, FIELD(past_from_now), FIELD(now_from_past), FIELD(size_px), FIELD(size_tiles), FIELD(past_size_px),
               FIELD(past_size_tiles), FIELD(nearest), FIELD(background)),
        LAYOUT(PastTile, FIELD(cost), FIELD(age), FIELD(growth), FIELD(errors), FIELD(grown)),
        LAYOUT(ChangedRect, FIELD(begin_px), FIELD(end_px), FIELD(error)),
        LAYOUT(PastBlock, FIELD(place), FIELD(inverse_depths)),
        LAYOUT(PastBlockList, FIELD(per_group), FIELD(count)),
        LAYOUT(ComponentPixel, FIELD(parent), FIELD(component)),
        LAYOUT(WarpCounters, FIELD(covered_pixels), FIELD(gap_pixels), FIELD(hole_pixels), FIELD(components), FIELD(edge_tiles),
               FIELD(center_tiles), FIELD(predicted_tiles), FIELD(cheap_tiles), FIELD(newcomers), FIELD(moved_tiles), FIELD(picture_cost),
               FIELD(shown_tiles), FIELD(saved_cost), FIELD(chosen_cost), FIELD(moves), FIELD(pays), FIELD(last_bin), FIELD(left_for_last),
               FIELD(borders_px), FIELD(per_pixel_block), FIELD(per_row), FIELD(per_visible), FIELD(component_groups)),
        LAYOUT(EyeGaze, FIELD(direction), FIELD(clear_rad), FIELD(pixel_cycle), FIELD(focal_px), FIELD(principal_px)),
        LAYOUT(PixelBox, FIELD(x0), FIELD(y0), FIELD(x1), FIELD(y1)),
        LAYOUT(EyeCounters, FIELD(square_box_pairs_low), FIELD(square_box_pairs_high), FIELD(large_splats), FIELD(full_tiles),
               FIELD(per_full_tile)),
        LAYOUT(CullPagesPass, FIELD(pages), FIELD(eyes), FIELD(page_bits), FIELD(word_offsets), FIELD(page_list), FIELD(visible_pages),
               FIELD(page_count), FIELD(first_eye), FIELD(eye_count)),
        LAYOUT(CullPass, FIELD(chunks), FIELD(eyes), FIELD(page_list), FIELD(visible_pages), FIELD(visible_bits), FIELD(group_counts),
               FIELD(visible), FIELD(splat_count), FIELD(chunk_bits), FIELD(first_eye), FIELD(eye_count), FIELD(capacity),
               FIELD(first_tile_mask), FIELD(last_tile_mask)),
        LAYOUT(CompactPass, FIELD(chunks), FIELD(eyes), FIELD(page_list), FIELD(visible_pages), FIELD(visible_bits), FIELD(group_offsets),
               FIELD(visible), FIELD(keys), FIELD(splats), FIELD(splat_count), FIELD(chunk_bits), FIELD(order_eye), FIELD(middle)),
        LAYOUT(ProjectPass, FIELD(chunks), FIELD(eyes), FIELD(order), FIELD(visible), FIELD(splats), FIELD(tile_sets), FIELD(tile_counts),
               FIELD(group_sums), FIELD(pairs), FIELD(counters), FIELD(tile_mask), FIELD(chunk_bits), FIELD(eye), FIELD(capacity)),
        LAYOUT(BinPass, FIELD(splats), FIELD(tile_sets), FIELD(tile_counts), FIELD(group_sums), FIELD(visible), FIELD(pairs), FIELD(tiles),
               FIELD(ranks), FIELD(large_splats), FIELD(large_begins), FIELD(counters), FIELD(tile_mask), FIELD(size_tiles),
               FIELD(low_pass)),
        LAYOUT(TileRangesPass, FIELD(tiles), FIELD(pairs), FIELD(ranges), FIELD(tile_list), FIELD(masked_tiles), FIELD(full_tiles),
               FIELD(counters), FIELD(colours), FIELD(half_colours), FIELD(depths), FIELD(moving), FIELD(past_tiles), FIELD(visible),
               FIELD(background), FIELD(size_px), FIELD(is_made)),
        LAYOUT(RasterizePass, FIELD(eyes), FIELD(splats), FIELD(ranks), FIELD(ranges), FIELD(colours), FIELD(half_colours), FIELD(depths),
               FIELD(moments), FIELD(moving), FIELD(arrivals), FIELD(full_tiles), FIELD(counters), FIELD(background), FIELD(eye),
               FIELD(row_words), FIELD(is_light), FIELD(past_tiles)),
        LAYOUT(WeighPass, FIELD(warp), FIELD(ranges), FIELD(moving), FIELD(tile_kinds), FIELD(tile_costs), FIELD(tile_errors),
               FIELD(tile_depths), FIELD(tile_mask), FIELD(price_bins), FIELD(shown_mask), FIELD(visible), FIELD(masked_tiles),
               FIELD(counters)),
        LAYOUT(DepthBoundsPass, FIELD(warp), FIELD(colours), FIELD(half_colours), FIELD(moving), FIELD(bins)),
        LAYOUT(EdgeRoisPass, FIELD(warp), FIELD(bins), FIELD(tile_kinds), FIELD(shown_mask), FIELD(counters)),
        LAYOUT(ReprojectPass, FIELD(warp), FIELD(moving), FIELD(arrivals), FIELD(shown_mask)),
        LAYOUT(WarpPastPass, FIELD(view), FIELD(source), FIELD(source_words), FIELD(source_tiles), FIELD(target), FIELD(target_words),
               FIELD(tiles), FIELD(tile_kinds), FIELD(tile_mask), FIELD(price_bins), FIELD(shown_mask), FIELD(tile_list),
               FIELD(listed_tiles), FIELD(blocks), FIELD(block_list)),
        LAYOUT(NewcomersPass, FIELD(chunks), FIELD(eyes), FIELD(warp), FIELD(tile_depths), FIELD(order), FIELD(visible),
               FIELD(source_counts), FIELD(tile_kinds), FIELD(tile_errors), FIELD(counters), FIELD(chunk_bits), FIELD(eye)),
        LAYOUT(ResamplePass, FIELD(warp), FIELD(source), FIELD(half_source), FIELD(moving), FIELD(target), FIELD(half_target),
               FIELD(depths), FIELD(tile_kinds), FIELD(tile_errors), FIELD(pixel_classes), FIELD(component_pixels), FIELD(counters),
               FIELD(shown_mask), FIELD(words), FIELD(background), FIELD(first_row)),
        LAYOUT(ComponentsPass, FIELD(warp), FIELD(pixels), FIELD(pixel_classes), FIELD(boxes), FIELD(tile_kinds), FIELD(counters),
               FIELD(box_capacity)),
        LAYOUT(MarkChangedPass, FIELD(tiles), FIELD(rects), FIELD(size_tiles), FIELD(count)),
        LAYOUT(PricePass, FIELD(warp), FIELD(tile_kinds), FIELD(tile_costs), FIELD(tile_errors), FIELD(tile_prices), FIELD(price_bins),
               FIELD(masked_tiles), FIELD(counters), FIELD(budget), FIELD(past_tiles), FIELD(is_last), FIELD(area), FIELD(gaze)),
        LAYOUT(SelectPass, FIELD(warp), FIELD(tile_kinds), FIELD(tile_prices), FIELD(tile_list), FIELD(tile_mask), FIELD(tile_costs),
               FIELD(visible), FIELD(masked_tiles), FIELD(masked_visible), FIELD(counters), FIELD(budget)),
        LAYOUT(PeripheryPass, FIELD(colours), FIELD(half_colours), FIELD(shown_mask), FIELD(tile_list), FIELD(tile_mask), FIELD(tile_kinds),
               FIELD(tile_losses), FIELD(chosen_tiles), FIELD(size_px), FIELD(gaze)),
        LAYOUT(FillPeripheryPass, FIELD(source), FIELD(half_source), FIELD(source_depths), FIELD(target), FIELD(half_target), FIELD(depths),
               FIELD(tile_mask), FIELD(shown_mask), FIELD(source_words), FIELD(words), FIELD(source_tiles), FIELD(tiles),
               FIELD(tile_losses), FIELD(background), FIELD(size_px)),
        LAYOUT(SortCountPass, FIELD(keys), FIELD(histograms), FIELD(run_sums), FIELD(digit_begins), FIELD(list), FIELD(shift),
               FIELD(digits)),
        LAYOUT(SortScatterPass, FIELD(keys_in), FIELD(values_in), FIELD(keys_out), FIELD(values_out), FIELD(histograms), FIELD(run_sums),
               FIELD(digit_begins), FIELD(list), FIELD(shift), FIELD(digits)),
        LAYOUT(PresentPass, FIELD(colours), FIELD(half_colours), FIELD(depths), FIELD(words), FIELD(tile_kinds), FIELD(pixel_classes),
               FIELD(pixels), FIELD(device_depths), FIELD(size_px), FIELD(near)),
    };
}

// What a compiled shader says of its structs: those laid out in memory, by name.
class ShaderLayouts {
public:
    explicit ShaderLayouts(std::span<const std::uint32_t> words) {
        // SPIR-V: five words of header, then instructions of (length << 16 | opcode) and operands.
        for (std::size_t at = 5; at < words.size(); at += words[at] >> 16) {
            readInstruction(words[at] & 0xffff, words.subspan(at + 1, (words[at] >> 16) - 1));
        }
        for (const auto& [id, members] : structs_) {
            if (!offsets_.contains(id)) { continue; }  // a local variable's, which has no layout
            Layout layout{names_[id], strides_.contains(id) ? strides_[id] : 0, {}};
            for (std::uint32_t m = 0; m < members.size(); ++m) {
                layout.fields.push_back({member_names_[id][m], offsets_[id][m], bytesOf(members[m])});
            }
            layouts.push_back(layout);
            if (layout.name == "Push") { push_struct = names_[members[0]]; }
        }
    }

    std::vector<Layout> layouts;  // `bytes` is the distance of an array's elements, or 0 if there is no array of it
    std::string push_struct;      // the struct of the push constants

private:
    using Words = std::span<const std::uint32_t>;

    static std::string textOf(Words words) {
        std::string text;
        for (std::size_t i = 0; i < 4 * words.size(); ++i) {
            const char c = static_cast<char>(words[i / 4] >> (8 * (i % 4)));
            if (c == '\0') { break; }
            text += c;
        }
        return text;
    }

    void readInstruction(std::uint32_t opcode, Words operands) {
        constexpr std::uint32_t kName = 5, kMemberName = 6, kTypeInt = 21, kTypeFloat = 22, kTypeVector = 23, kTypeArray = 28,
                                kTypeRuntimeArray = 29, kTypeStruct = 30, kTypePointer = 32, kConstant = 43, kDecorate = 71,
                                kMemberDecorate = 72, kArrayStride = 6, kOffset = 35;
        switch (opcode) {
            case kName:
                names_[operands[0]] = textOf(operands.subspan(1));
                break;
            case kMemberName:
                member_names_[operands[0]][operands[1]] = textOf(operands.subspan(2));
                break;
            case kTypeInt:
            case kTypeFloat:
                bytes_[operands[0]] = operands[1] / 8;
                break;
            case kTypeVector:
                bytes_[operands[0]] = bytes_[operands[1]] * operands[2];
                break;
            case kConstant:
                constants_[operands[1]] = operands[2];
                break;
            case kTypeArray:  // of a struct's field; its stride says that it is laid out
                if (array_strides_.contains(operands[0])) { bytes_[operands[0]] = array_strides_[operands[0]] * constants_[operands[2]]; }
                break;
            case kTypePointer:
                bytes_[operands[0]] = 8;
                break;
            case kTypeStruct:
                structs_[operands[0]].assign(operands.begin() + 1, operands.end());
                break;
            case kTypeRuntimeArray:
                strides_[operands[1]] = array_strides_[operands[0]];
                break;
            case kDecorate:
                if (operands[1] == kArrayStride) { array_strides_[operands[0]] = operands[2]; }
                break;
            case kMemberDecorate:
                if (operands[2] == kOffset) { offsets_[operands[0]][operands[1]] = operands[3]; }
                break;
            default:
                break;
        }
    }

    std::size_t bytesOf(std::uint32_t type) {
        if (!structs_.contains(type)) { return bytes_.contains(type) ? bytes_[type] : 8; }  // 8: a pointer that is only announced
        const auto last = static_cast<std::uint32_t>(structs_[type].size() - 1);
        return offsets_[type][last] + bytesOf(structs_[type][last]);
    }

    std::map<std::uint32_t, std::string> names_;
    std::map<std::uint32_t, std::map<std::uint32_t, std::string>> member_names_;
    std::map<std::uint32_t, std::map<std::uint32_t, std::uint32_t>> offsets_;
    std::map<std::uint32_t, std::vector<std::uint32_t>> structs_;
    std::map<std::uint32_t, std::uint32_t> constants_;
    std::map<std::uint32_t, std::size_t> bytes_, strides_, array_strides_;
};

// What is wrong with a shader's struct; empty if nothing is. Blocks of the language itself have no twin in C++: the push
// constants, the arrays behind an address, and sixteen bytes of anything (lib/past.glsl).
std::string findMismatch(const Layout& shader, const std::vector<Layout>& host) {
    if (shader.name == "Push" || shader.name == "Sixteen" || (shader.fields.size() == 1 && shader.fields[0].name == "at")) { return {}; }
    const auto twin = std::find_if(host.begin(), host.end(), [&](const Layout& layout) { return layout.name == shader.name; });
    if (twin == host.end()) { return shader.name + " is missing in the table of this test"; }
    if (shader.bytes != 0 && shader.bytes != twin->bytes) { return shader.name + " has another size"; }
    if (shader.fields.size() != twin->fields.size()) { return shader.name + " has another number of fields"; }
    for (std::size_t i = 0; i < shader.fields.size(); ++i) {
        if (shader.fields[i] != twin->fields[i]) { return shader.name + "." + shader.fields[i].name + " differs"; }
    }
    return {};
}

// The names of shaders/FOLDER/NAME.comp.
std::vector<std::string> shaderNames() {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "shaders")) {
        if (entry.path().extension() == ".comp") { names.push_back(entry.path().stem().string()); }
    }
    return names;
}

// What shaders/passes.def says of each.
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

}  // namespace

TEST_CASE("every shader's structs have the fields, offsets and sizes that C++ gives them") {
    const std::vector<Layout> host = hostLayouts();
    const std::map<std::string, ListedPass> listed = listedPasses();
    std::set<std::string> seen;
    REQUIRE(shaderNames().size() == listed.size());
    for (const std::string& name : shaderNames()) {
        CAPTURE(name);
        const auto words = embeddedShader(name);
        REQUIRE_FALSE(words.empty());
        const ShaderLayouts shader(words);
        CHECK(shader.push_struct == listed.at(name).push_struct);
        for (const Layout& layout : shader.layouts) {
            CHECK(findMismatch(layout, host) == "");
            seen.insert(layout.name);
        }
    }
    for (const Layout& layout : host) {
        INFO("no shader has " << layout.name);
        CHECK(seen.contains(layout.name));
    }
}

TEST_CASE_FIXTURE(test::Gpu, "every kernel reads each constant that it is compiled for, calls it what C++ does, and has no other") {
    KernelTable table = passKernels(context());
    append(table, warpKernels(context()));
    append(table, pastKernels());
    append(table, peripheryKernels());
    append(table, presentKernels());
    std::set<std::string> made;
    for (const KernelVariant& variant : table) { made.insert(variant.shader); }
    const std::map<std::string, ListedPass> listed = listedPasses();
    CHECK(made.size() == listed.size());
    for (const auto& [name, pass] : listed) {
        CAPTURE(name);
        const test::ShaderWords shader(embeddedShader(name));
        CHECK(shader.declaredConstants() == pass.constants);
        std::set<std::uint32_t> ids;
        for (const auto& [id, constant] : pass.constants) { ids.insert(id); }
        CHECK(shader.readConstants() == ids);
    }
}

TEST_CASE("no shader copies a struct of addresses, which some compilers do not survive, nor loads an address as if it lay anywhere") {
    for (const std::string& name : shaderNames()) {
        CAPTURE(name);
        const test::ShaderWords shader(embeddedShader(name));
        CHECK(shader.copiedAddresses() == "");
        CHECK(shader.looseAddresses() == 0);
    }
}

TEST_CASE_FIXTURE(test::Gpu, "a shader that breaks off is refused, whatever the driver would make of it") {
    const auto words = embeddedShader("bin");
    const std::vector<std::uint32_t> whole(words.begin(), words.end());
    for (const std::size_t length : {std::size_t{3}, std::size_t{6}}) {
        context().replacedShaders()["bin"] = {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)};
        CHECK_THROWS_AS(Kernel(context(), variantOf(BinKernel{})), Error);
    }
    context().replacedShaders()["bin"] = whole;
    context().replacedShaders()["bin"][5] = 0;  // an instruction of no words
    CHECK_THROWS_AS(Kernel(context(), variantOf(BinKernel{})), Error);
    context().replacedShaders().erase("bin");
}

TEST_CASE("push constants fit into the 128 bytes that every device has") {
    for (const Layout& layout : hostLayouts()) {
        if (layout.name.ends_with("Pass")) { CHECK(layout.bytes <= 128); }
    }
}

TEST_CASE("a wrong field is found") {
    const Layout right{"Thing", 12, {{"a", 0, 4}, {"b", 4, 8}}};
    const std::vector<Layout> host{right};
    CHECK(findMismatch(right, host).empty());
    const auto alter = [&](auto change) {
        Layout wrong = right;
        change(wrong);
        return findMismatch(wrong, host);
    };
    CHECK(alter([](Layout& l) { l.fields[1].offset = 8; }) == "Thing.b differs");
    CHECK(alter([](Layout& l) { l.fields[1].bytes = 4; }) == "Thing.b differs");
    CHECK(alter([](Layout& l) { std::swap(l.fields[0].name, l.fields[1].name); }) == "Thing.b differs");
    CHECK(alter([](Layout& l) { l.fields.pop_back(); }) == "Thing has another number of fields");
    CHECK(alter([](Layout& l) { l.fields.push_back({"c", 12, 4}); }) == "Thing has another number of fields");
    CHECK(alter([](Layout& l) { l.bytes = 16; }) == "Thing has another size");
    CHECK(alter([](Layout& l) { l.name = "Other"; }) == "Other is missing in the table of this test");
}

}  // namespace layout_test
