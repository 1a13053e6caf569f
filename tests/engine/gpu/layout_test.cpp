// The structs that C++ and GLSL read from the same headers have their fields at the same offsets in both.
// Also checks how shaders use their constants and structs of addresses.
#include "engine/levels/contribute.h"
#include "engine/passes/history_passes.h"
#include "engine/passes/passes.h"
#include "engine/passes/present.h"
#include "tests/engine/gpu/compiled_shader.h"
#include "tests/engine/gpu/gpu_fixture.h"

SUITE(layout) {

// Becomes a struct's next field, whatever its type, which lies behind the one before as its alignment asks.
struct NextField {
    Layout& layout;
    template <typename T>
    operator T() const {
        const std::size_t offset = (layout.bytes + alignof(T) - 1) / alignof(T) * alignof(T);
        layout.add(offset, sizeof(T));
        layout.bytes = offset + sizeof(T);
        return {};
    }
};
// C++'s layout: of a struct of as many fields as its braces take.
template <typename S, typename... Fields>
Layout layoutOf(const std::string& name) {
    if constexpr (requires { S{std::declval<Fields>()..., std::declval<NextField>()}; }) {
        return layoutOf<S, Fields..., NextField>(name);
    } else {
        Layout layout{name};
        [[maybe_unused]] const S filled{Fields{layout}...};
        REQUIRE(sizeof(S) == (layout.bytes + alignof(S) - 1) / alignof(S) * alignof(S));
        layout.bytes = sizeof(S);
        return layout;
    }
}

std::map<std::string, Layout> hostLayouts() {
    std::map<std::string, Layout> layouts;
#define LAYOUT(Struct) layoutOf<gpu::Struct>(#Struct)
    for (const Layout& layout :
         {LAYOUT(SceneChunk),   LAYOUT(Placement),      LAYOUT(ScenePage),        LAYOUT(EyeView),
          LAYOUT(Place),        LAYOUT(ProjectedSplat), LAYOUT(DispatchSize),     LAYOUT(ListState),
          LAYOUT(PixelMap),     LAYOUT(WarpView),       LAYOUT(HistoryView),      LAYOUT(HistoryTile),
          LAYOUT(ChangedRect),  LAYOUT(HistoryBlock),   LAYOUT(HistoryBlockList), LAYOUT(ComponentPixel),
          LAYOUT(WarpCounters), LAYOUT(EyeGaze),        LAYOUT(PixelBox),         LAYOUT(EyeCounters),
          LAYOUT(TargetState)}) {
        layouts[layout.name] = layout;
    }
#define PASS(folder, shader, Name, Struct, ...) layouts[#Struct] = LAYOUT(Struct);
#include "shaders/passes.def"
#undef PASS
    return layouts;
}

// The language's own blocks have no counterpart in C++: the push constants, the arrays behind an address, and
// sixteen bytes of anything (lib/history.glsl).
bool isShared(const Layout& layout) {
    return layout.name != "Push" && layout.name != "Sixteen" && layout.names != "at ";
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

TEST_CASE("every shader's structs are laid out as in C++, and none that holds addresses is copied") {
    const std::map<std::string, Layout> host = hostLayouts();
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
        // Nor is an address loaded as if it lay anywhere.
        CHECK(these(shader.copiedAddresses(), shader.looseAddresses()) == these("", 0));
        for (const Layout& layout : shader.layouts()) {
            if (!isShared(layout)) { continue; }
            INFO(layout.name, ": ", layout.names);
            REQUIRE(host.contains(layout.name));  // it is missing in this test
            CHECK(layout.fields == host.at(layout.name).fields);
            if (layout.bytes != 0) { CHECK(layout.bytes == host.at(layout.name).bytes); }
            seen.insert(layout.name);
        }
    }
    for (const auto& [name, layout] : host) {
        CAPTURE(name);
        CHECK(seen.contains(name));
        // Every device has this many bytes of push constants.
        if (name.ends_with("Pass")) { CHECK(layout.bytes <= 128); }
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

TEST_CASE_FIXTURE(Gpu, "a shader that breaks off is refused, whatever the driver would make of it") {
    const auto whole = embeddedShader("bin");
    std::vector<std::uint32_t> stuck(whole.begin(), whole.end());
    stuck[5] = 0;  // an instruction with zero words
    for (const auto words : {whole.first(3), whole.first(6), std::span<const std::uint32_t>(stuck)}) {
        context().replacedShaders()["bin"].assign(words.begin(), words.end());
        CHECK_THROWS_AS(Kernel(context(), variantOf(BinKernel{})), Error);
    }
    context().replacedShaders().erase("bin");
}

}  // SUITE(layout)
