// Facts about the passes over a scene, cull_pages, cull and compact, each started from the output of the
// twin's previous pass.
#include "engine/passes/passes.h"
#include "tests/engine/gpu/compiled_shader.h"
#include "tests/engine/passes/pass_stages.h"
#include "tests/engine/passes/scene_pages.h"

SUITE(passes) {

constexpr std::size_t kGroupWords = gpu::kCullBlock / 32;

const reference::Settings kSettings{};

// Eyes at the view's own place and at others: inside the scene and beside it, turned at random, close to what
// they see, with a narrow and a wide view, off axis, and with pictures of half the size. Each is preceded by
// a parallel eye and followed by a canted one.
std::vector<Eye> eyesAbout(const ViewedScene& view, int count) {
    std::mt19937 random(7);
    const auto draw = [&](double low, double high) { return drawBetween(random, low, high); };
    std::vector<Eye> eyes;
    for (int i = 0; i < count; ++i) {
        Eye eye = view.eye;
        if (i > 0) {
            const glm::dvec3 splat(view.scene.positions[random() % view.scene.size()]);
            eye.world_from_camera.position =
                splat + std::pow(10.0, draw(-3.0, 0.5)) * glm::dvec3(draw(-1, 1), draw(-1, 1), draw(-1, 1));
            eye.world_from_camera.orientation =
                glm::normalize(glm::dquat(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1)));
            const double focal = eye.size_px.x * std::pow(2.0, draw(-1.5, 2.0));
            eye.intrinsics = {focal, focal * draw(0.8, 1.2), eye.size_px.x * draw(0.2, 0.8),
                              eye.size_px.y * draw(0.2, 0.8)};
            eye.own_pixel_px = i % 4 == 3 ? 0.5 : 1.0;
        }
        const Eye parallel = stereoPair(eye, 0.063)[1];
        eyes.insert(eyes.end(), {parallel, eye, turned(parallel, 0.1)});
    }
    return eyes;
}

struct FoundPages {
    std::vector<std::uint32_t> list;
    gpu::ListState state;
};
// Runs cull_pages for `eye_count` eyes from `first_eye` on.
FoundPages cullPagesOnDevice(Gpu& gpu, const std::vector<gpu::ScenePage>& pages, std::uint32_t shape,
                             const std::vector<Eye>& eyes, std::size_t first_eye, std::size_t eye_count,
                             const Kernel* other_kernel = nullptr) {
    const auto count = static_cast<gpu::uint>(pages.size());
    const Buffer table = gpu.upload("pages", pages), views = uploadEyes(gpu, eyes, kSettings.near),
                 bits = gpu.allocate<gpu::uint>("bits", (count + 31) / 32),
                 offsets = gpu.allocate<gpu::uint>("offsets", (count + 31) / 32),
                 list_buffer = gpu.allocate<gpu::uint>("list", count + gpu::kSumRuns),
                 state_buffer = gpu.upload("state", std::vector{gpu::ListState{}});
    const gpu::CullPagesPass pass{.pages = at(table),
                                  .eyes = at(views),
                                  .page_bits = at(bits),
                                  .word_offsets = at(offsets),
                                  .page_list = at(list_buffer),
                                  .visible_pages = at(state_buffer),
                                  .page_count = count,
                                  .first_eye = static_cast<gpu::uint>(first_eye),
                                  .eye_count = static_cast<gpu::uint>(eye_count)};
    gpu.dispatchOver(
        other_kernel != nullptr ? *other_kernel : gpu.kernel(CullPagesKernel{.splat_kind = shape}), pass,
        count);
    FoundPages found{{}, gpu.readBack<gpu::ListState>(state_buffer, 1)[0]};
    // In the order in which lib/block.glsl finds them.
    const auto list = gpu.readBack<gpu::uint>(list_buffer, count + gpu::kSumRuns);
    const std::uint32_t groups = (count + gpu::kGroupSize - 1) / gpu::kGroupSize;
    const bool one_run = groups <= gpu::kMostPageGroupsInOneRun;
    const std::uint32_t length = one_run ? groups : (groups + gpu::kSumRuns - 1) / gpu::kSumRuns,
                        runs = (groups + length - 1) / length;
    for (std::uint32_t run = 0; run < runs; ++run) {
        const std::uint32_t begin = one_run ? 0 : list[count + run],
                            end = run + 1 < runs ? list[count + run + 1] : found.state.count;
        const auto first = list.begin() + run * length * gpu::kGroupSize;
        found.list.insert(found.list.end(), first, first + (end - begin));
    }
    return found;
}

// A kernel as a device may compile it that does not promise to preserve NaN: there a NaN compares less,
// greater and equal to anything. Such a device may turn any comparison of floats into the negation of its
// opposite.
template <typename K>
Kernel withoutNan(Gpu& gpu, const K& variant) {
    constexpr std::uint32_t kOrderedEqual = 180, kUnorderedGreaterThanEqual = 191;
    changeShader(gpu.context(), K::kShader, [](std::span<std::uint32_t> whole) {
        const std::uint32_t opcode = whole[0] & 0xffff;
        if (opcode >= kOrderedEqual && opcode <= kUnorderedGreaterThanEqual) { whole[0] |= 1; }
    });
    Kernel kernel(gpu.context(), variantOf(variant));
    gpu.context().replacedShaders().erase(K::kShader);
    return kernel;
}

struct Culled {
    std::vector<std::uint32_t> bits, group_offsets;
    gpu::ListState visible;
    [[nodiscard]] bool has(std::size_t splat) const { return ((bits[splat / 32] >> (splat % 32)) & 1) != 0; }
};

Culled cullOnDevice(Gpu& gpu, const SceneOnDevice& device, std::size_t first_eye, std::uint32_t eye_count,
                    const Kernel* other_kernel = nullptr) {
    const std::uint32_t count = device.scene.splatCount();
    const std::size_t groups = pagesOf(count);
    const Buffer bits = gpu.allocate<std::uint32_t>("bits", groups * kGroupWords),
                 counts = gpu.allocate<std::uint32_t>("counts", groups);
    const Buffer list = gpu.upload("visible", std::vector{gpu::ListState{}});
    gpu::CullPass pass{};
    pass.chunks = device.scene.chunks();
    pass.eyes = at(device.eyes);
    pass.visible_bits = at(bits);
    pass.group_counts = at(counts);
    pass.visible = at(list);
    pass.splat_count = pass.capacity = count;
    pass.chunk_bits = device.scene.chunkBits();
    pass.first_eye = static_cast<gpu::uint>(first_eye);
    pass.eye_count = eye_count;
    gpu.dispatchOver(other_kernel != nullptr ? *other_kernel
                                             : gpu.kernel(CullKernel{.splat_kind = device.scene.splatKind()}),
                     pass, count, gpu::kCullBlock);
    return {gpu.readBack<std::uint32_t>(bits, groups * kGroupWords),
            gpu.readBack<std::uint32_t>(counts, groups), gpu.readBack<gpu::ListState>(list, 1)[0]};
}

// The twin's bounds of a scene's pages, which those of the device contain with little to spare.
std::vector<reference::Page> boundPages(const Scene& scene, const PackedPages& packed) {
    std::vector<reference::Page> pages;
    for (std::size_t first = 0; first < scene.size(); first += gpu::kPageSplats) {
        pages.push_back(reference::boundPage(scene, first,
                                             std::min<std::size_t>(gpu::kPageSplats, scene.size() - first)));
        const gpu::ScenePage& page = packed.pages()[pages.size() - 1];
        const reference::Page& twin = pages.back();
        REQUIRE(page.count == twin.count);
        const double hair = 1e-4 * (1.0 + glm::length(twin.high - twin.low));
        for (int axis = 0; axis < 3; ++axis) {
            REQUIRE(page.low[axis] == within(twin.low[axis] - hair, twin.low[axis]));
            REQUIRE(page.high[axis] == within(twin.high[axis], twin.high[axis] + hair));
        }
        REQUIRE(page.reach == within(twin.reach, 1.001 * twin.reach + 1e-5));
    }
    REQUIRE(packed.pageCount() == pages.size());
    return pages;
}

// Runs cull_pages and cull from `count` places around each of the scenes.
void checkPages(Gpu& gpu, int count) {
    std::size_t left_out = 0, splats_kept = 0;
    std::vector<ViewedScene> scenes{viewBuiltin("builtin:atelier", {256, 192}, 20000), viewCloud({200, 150})};
    for (const bool antialiased : {false, true}) { scenes.push_back(viewGaussians({200, 150}, antialiased)); }
    for (ViewedScene& view : scenes) {
        CAPTURE(view.name);
        view.scene = inMortonOrder(view.scene);
        const PackedPages packed(view.scene, traitsOf(view.scene));
        const std::vector<reference::Page> pages = boundPages(view.scene, packed);
        const std::vector<Eye> eyes = eyesAbout(view, count);
        const SceneOnDevice device(gpu, view.scene, eyes, kSettings.near);
        for (std::size_t e = 1; e < eyes.size(); e += 3) {
            for (const auto& [first, many] : {std::pair(e - 1, 2u), std::pair(e, 1u), std::pair(e, 2u)}) {
                const FoundPages found =
                    cullPagesOnDevice(gpu, packed.pages(), device.scene.splatKind(), eyes, first, many);
                REQUIRE(found.state.count == found.list.size());
                REQUIRE(found.state.per_item.x * found.state.per_item.y >= found.list.size());
                REQUIRE(std::ranges::is_sorted(found.list));
                const auto some = std::span(eyes).subspan(first, many);
                const auto least = reference::cullPages(pages, view.scene.isGaussian3d(), some, kSettings);
                const auto most =
                    reference::cullPages(pages, view.scene.isGaussian3d(), some, kSettings, 1e-4);
                for (std::uint32_t p = 0; p < pages.size(); ++p) {
                    const bool is_found = std::ranges::binary_search(found.list, p);
                    if (least[p] != 0) { REQUIRE(is_found); }
                    if (is_found) { REQUIRE(most[p] != 0); }
                    left_out += !is_found;
                }
                if (many == 2) { continue; }
                const Culled culled = cullOnDevice(gpu, device, first, 1);
                for (std::uint32_t i = 0; i < view.scene.size(); ++i) {
                    if (!culled.has(i)) { continue; }
                    ++splats_kept;
                    REQUIRE(std::ranges::binary_search(found.list, i / gpu::kPageSplats));
                }
            }
        }
    }
    CHECK(left_out > 1000);
    CHECK(splats_kept > 10000);
}

struct Compacted {
    std::vector<std::uint32_t> keys, splats;
};

// Runs compact on these splats, which ascend, for the device's first eye; by distance from `middle` if there
// is one.
Compacted compactOnDevice(Gpu& gpu, const SceneOnDevice& device, const std::vector<std::uint32_t>& visible,
                          const std::optional<glm::dvec3>& middle) {
    const std::uint32_t count = device.scene.splatCount();
    const std::size_t groups = pagesOf(count);
    std::vector<std::uint32_t> bits(groups * kGroupWords), offsets(groups + 1);
    for (const std::uint32_t splat : visible) {
        bits[splat / 32] |= 1u << (splat % 32);
        ++offsets[splat / gpu::kCullBlock + 1];
    }
    std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
    const Buffer bit_buffer = gpu.upload("bits", bits), offset_buffer = gpu.upload("offsets", offsets),
                 list = gpu.upload("list", std::vector{makeList(visible.size())});
    const Buffer keys = gpu.allocate<std::uint32_t>("keys", visible.size()),
                 splats = gpu.allocate<std::uint32_t>("splats", visible.size());
    gpu::CompactPass pass{};
    pass.chunks = device.scene.chunks();
    pass.eyes = at(device.eyes);
    if (middle) {
        pass.by_distance = 1;
        pass.middle = placeOf(*middle);
    }
    pass.visible_bits = at(bit_buffer);
    pass.group_offsets = at(offset_buffer);
    pass.visible = at(list);
    pass.keys = at(keys);
    pass.splats = at(splats);
    pass.splat_count = count;
    pass.chunk_bits = device.scene.chunkBits();
    gpu.dispatchOver(gpu.kernel(CompactKernel{}), pass, count, gpu::kCullBlock);
    return {gpu.readBack<std::uint32_t>(keys, visible.size()),
            gpu.readBack<std::uint32_t>(splats, visible.size())};
}

TEST_CASE_FIXTURE(Gpu, "cull_pages finds the twin's pages, and leaves none out of which cull keeps a splat") {
    checkPages(*this, 24);
}
TEST_CASE_FIXTURE(Gpu, "cull_pages does so from many more places" * nightly()) { checkPages(*this, 100); }

TEST_CASE_FIXTURE(Gpu, "the list of pages is right at every size") {
    std::mt19937 random(3);
    for (const std::uint32_t count :
         {1u, 2u, 31u, 32u, 33u, 127u, 128u, 129u, 1023u, 1024u, 1025u, 4096u, 4097u, 40000u}) {
        CAPTURE(count);
        std::vector<gpu::ScenePage> pages;
        std::vector<std::uint32_t> expected;
        for (std::uint32_t p = 0; p < count; ++p) {
            const bool is_empty = random() % 4 == 0, is_seen = random() % 2 == 0;
            const float z = is_seen ? 2.0f : -2.0f;
            pages.push_back({.low = {-0.1f, -0.1f, z},
                             .reach = 0.1f,
                             .high = {0.1f, 0.1f, z + 0.1f},
                             .count = is_empty ? 0u : 5u});
            if (!is_empty && is_seen) { expected.push_back(p); }
        }
        const FoundPages found = cullPagesOnDevice(*this, pages, gpu::kDiscs, {makeEye({64, 64})}, 0, 1);
        CHECK(these(found.list, found.state.needed) == these(expected, expected.size()));
        const std::uint32_t groups = found.state.per_item.x * found.state.per_item.y * found.state.per_item.z;
        CHECK(groups == within(expected.size(), expected.size() + gpu::kMaxGroupsX - 1));
        CHECK(found.state.per_item.x <= gpu::kMaxGroupsX);
    }
}

TEST_CASE_FIXTURE(Gpu, "a page whose bounds are not numbers, or too large for them, is left to cull") {
    constexpr float kHuge = 3e38f, kNone = std::numeric_limits<float>::quiet_NaN();
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const std::vector<gpu::ScenePage> pages{
        {.low = glm::vec3(-kHuge), .reach = 1.0f, .high = glm::vec3(kHuge), .count = 1},
        {.low = glm::vec3(kNone), .reach = 1.0f, .high = glm::vec3(kNone), .count = 1},
        {.low = {-1, -1, -3}, .reach = kInfinity, .high = {1, 1, 3}, .count = 1}};
    for (const std::uint32_t shape : {gpu::kDiscs, gpu::kGaussians}) {
        const Kernel without_nan = withoutNan(*this, CullPagesKernel{.splat_kind = shape});
        for (const Kernel* kernel : {static_cast<const Kernel*>(nullptr), &without_nan}) {
            CHECK(cullPagesOnDevice(*this, pages, shape, {makeEye({64, 64})}, 0, 1, kernel).list ==
                  numbersUpTo(3));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "a splat that is not all numbers is not visible") {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    const Eye eye = makeEye({64, 64});
    for (const bool is_gaussian : {false, true}) {
        CAPTURE(is_gaussian);
        Scene scene =
            makeScene(std::vector<Splat>(6, {{0, 0, 2}, {1, 0, 0, 0}, {0.1f, 0.1f}, 0.9f, glm::vec3(0.5f)}));
        if (is_gaussian) { scene.thicknesses.assign(6, 0.1f); }
        scene.positions[1].x = scene.positions[2].z = scene.scales[3].y = scene.opacities[4] =
            scene.rotations[5].x = kNone;
        const SceneOnDevice device(*this, scene, {eye}, kSettings.near);
        const Kernel without_nan = withoutNan(*this, CullKernel{.splat_kind = device.scene.splatKind()});
        for (const Kernel* kernel : {static_cast<const Kernel*>(nullptr), &without_nan}) {
            CHECK(cullOnDevice(*this, device, 0, 1, kernel).bits[0] == 1);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "cull misses no splat that either eye sees, and keeps hardly one more") {
    for (const auto& [view, twin] : stagedScenes()) {
        CAPTURE(view.name);
        const SceneOnDevice device(*this, view.scene, {view.eye, turned(view.eye, 0.5)}, kSettings.near);
        const Culled culled = cullOnDevice(*this, device, 0, 1), turned = cullOnDevice(*this, device, 1, 1),
                     both = cullOnDevice(*this, device, 0, 2);
        for (const reference::TilePair& pair : twin.pairs) { REQUIRE(culled.has(twin.order[pair.splat])); }
        std::size_t kept = 0;
        for (std::size_t w = 0; w < culled.bits.size(); ++w) {
            if (w % kGroupWords == 0) { REQUIRE(culled.group_offsets[w / kGroupWords] == kept); }
            kept += static_cast<std::size_t>(std::popcount(culled.bits[w]));
            REQUIRE(both.bits[w] == (culled.bits[w] | turned.bits[w]));
        }
        CHECK(culled.visible.count == kept);
        CHECK(static_cast<double>(kept) <= 1.02 * static_cast<double>(twin.order.size()));
        CHECK(culled.bits != turned.bits);
    }
}

TEST_CASE_FIXTURE(Gpu,
                  "compact lists what is visible in order, with keys that order as depths or distances") {
    const auto check = [&](const ViewedScene& view, const reference::Settings& settings) {
        const auto visible = reference::cull(view.scene, {&view.eye, 1}, settings);
        const reference::Visible twin = reference::compact(view.scene, visible, view.eye, settings);
        const SceneOnDevice device(*this, view.scene, {view.eye}, settings.near);
        const Compacted compacted = compactOnDevice(*this, device, twin.splats, settings.order_from);
        CHECK(compacted.splats == twin.splats);
        // Keys sort like the floats that they stand for: the depths or distances, up to a few roundings of
        // the distance.
        double worst = 0.0;
        for (std::size_t i = 0; i < compacted.keys.size(); ++i) {
            const double depth = settings.order_from ? std::sqrt(twin.depths[i]) : twin.depths[i];
            const double unit =
                settings.order_from
                    ? depth
                    : distanceToRound(glm::dvec3(view.scene.positions[twin.splats[i]]), view.eye);
            const auto [least, most] = depthsOfKey(compacted.keys[i], static_cast<float>(settings.near));
            worst = std::max(worst, std::max(least - depth, depth - most) / (kEpsilon * unit));
        }
        CHECK(worst <= 8.0);  // measured: 2.4
    };
    for (const auto& staged : stagedScenes()) {
        ViewedScene view = staged.view;
        CAPTURE(view.name);
        check(view, kSettings);
        for (const double offset : {0.0, 1e6}) {
            CAPTURE(offset);
            for (glm::vec3& position : view.scene.positions) { position += static_cast<float>(offset); }
            view.eye.world_from_camera.position += offset;
            reference::Settings settings;
            // Not representable in float32, so the stored remainder matters.
            settings.order_from = view.eye.world_from_camera.position + glm::dvec3(0.0317, 1e-7, -1e-5);
            check(view, settings);
        }
    }
}

}  // SUITE(passes)
