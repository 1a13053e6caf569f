// Facts about pages: what bounds them, which of them cull_pages finds, and that cull and compact go over these alone.
#include "engine/passes/passes.h"
#include "tests/engine/passes/pass_stages.h"
#include "tests/engine/passes/scene_pages.h"

#include <doctest/doctest.h>

#include <bit>
#include <random>

TEST_SUITE_BEGIN("pages");

namespace pages_test {

using namespace binosplat;
using test::Gpu;
using test::ViewedScene;

namespace {

const reference::Settings kSettings{};

std::vector<ViewedScene> allScenes() {
    std::vector<ViewedScene> scenes{test::viewBuiltin("builtin:atelier", {256, 192}, 20000), test::viewCloud({200, 150})};
    for (const bool antialiased : {false, true}) { scenes.push_back(test::viewGaussians({200, 150}, antialiased)); }
    for (ViewedScene& view : scenes) { view.scene = test::inMortonOrder(view.scene); }
    return scenes;
}

// Where the view looks from, and from anywhere else: within the scene and beside it, turned at random, near to what it sees, with a narrow
// and a wide view, off its axis; also as pictures of half the size have it.
std::vector<Eye> eyesOf(const ViewedScene& view, int count) {
    std::mt19937 random(7);
    const auto draw = [&](double low, double high) { return low + (high - low) * static_cast<double>(random() >> 8) / 16777216.0; };
    std::vector<Eye> eyes{view.eye};
    for (int i = 1; i < count; ++i) {
        Eye eye = view.eye;
        const glm::dvec3 splat(view.scene.positions[random() % view.scene.size()]);
        eye.world_from_camera.position = splat + std::pow(10.0, draw(-3.0, 0.5)) * glm::dvec3(draw(-1, 1), draw(-1, 1), draw(-1, 1));
        eye.world_from_camera.orientation = glm::normalize(glm::dquat(draw(-1, 1), draw(-1, 1), draw(-1, 1), draw(-1, 1)));
        const double focal = eye.size_px.x * std::pow(2.0, draw(-1.5, 2.0));
        eye.intrinsics = {focal, focal * draw(0.8, 1.2), eye.size_px.x * draw(0.2, 0.8), eye.size_px.y * draw(0.2, 0.8)};
        eye.own_pixel_px = i % 4 == 3 ? 0.5 : 1.0;
        eyes.push_back(eye);
    }
    return eyes;
}

std::vector<reference::Page> boundPages(const Scene& scene) {
    std::vector<reference::Page> pages;
    for (std::size_t first = 0; first < scene.size(); first += gpu::kPageSplats) {
        pages.push_back(reference::boundPage(scene, first, std::min<std::size_t>(gpu::kPageSplats, scene.size() - first)));
    }
    return pages;
}

struct PagesOnDevice {
    std::vector<std::uint32_t> list;
    gpu::ListState state;
};

PagesOnDevice cullPages(Gpu& gpu, const std::vector<gpu::ScenePage>& pages, std::uint32_t shape, const std::vector<Eye>& eyes) {
    std::vector<gpu::EyeView> views;
    for (const Eye& eye : eyes) { views.push_back(viewOf(eye, kSettings.near)); }
    const std::size_t words = (pages.size() + 31) / 32;
    const Buffer table = gpu.upload("pages", pages), eye_views = gpu.upload("eyes", views);
    const Buffer bits = gpu.allocate<gpu::uint>("bits", words), offsets = gpu.allocate<gpu::uint>("offsets", words),
                 list = gpu.allocate<gpu::uint>("list", pages.size()), state = gpu.upload("state", std::vector{gpu::ListState{}});
    const gpu::CullPagesPass pass{.pages = table.address<gpu::ScenePage>(),
                                  .eyes = eye_views.address<gpu::EyeView>(),
                                  .page_bits = bits.address<gpu::uint>(),
                                  .word_offsets = offsets.address<gpu::uint>(),
                                  .page_list = list.address<gpu::uint>(),
                                  .visible_pages = state.address<gpu::ListState>(),
                                  .page_count = static_cast<gpu::uint>(pages.size()),
                                  .first_eye = 0,
                                  .eye_count = static_cast<gpu::uint>(eyes.size())};
    const Kernel& kernel = gpu.kernel(CullPagesKernel{.splat_kind = shape});
    gpu.run([&](Commands& commands) { commands.dispatchOver(kernel, pass, pages.size()); });
    const auto made = gpu.readBack<gpu::ListState>(state, 1)[0];
    return {gpu.readBack<gpu::uint>(list, made.count), made};
}

}  // namespace

TEST_CASE("the bounds of a page hold what the twin says of its splats, and little more") {
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const PackedPages packed(view.scene, traitsOf(view.scene));
        const std::vector<reference::Page> pages = boundPages(view.scene);
        REQUIRE(packed.pageCount() == pages.size());
        for (std::size_t p = 0; p < pages.size(); ++p) {
            const gpu::ScenePage& page = packed.pages()[p];
            REQUIRE(page.count == pages[p].count);
            const double hair = 1e-4 * (1.0 + glm::length(pages[p].high - pages[p].low));
            for (int axis = 0; axis < 3; ++axis) {
                REQUIRE(static_cast<double>(page.low[axis]) <= pages[p].low[axis]);
                REQUIRE(static_cast<double>(page.low[axis]) >= pages[p].low[axis] - hair);
                REQUIRE(static_cast<double>(page.high[axis]) >= pages[p].high[axis]);
                REQUIRE(static_cast<double>(page.high[axis]) <= pages[p].high[axis] + hair);
            }
            REQUIRE(static_cast<double>(page.reach) >= pages[p].reach);
            REQUIRE(static_cast<double>(page.reach) <= 1.001 * pages[p].reach + 1e-5);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "cull_pages finds the twin's pages, up to a hair of what each sees, for one eye and for two") {
    std::size_t kept = 0, left_out = 0;
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const PackedPages packed(view.scene, traitsOf(view.scene));
        const std::vector<reference::Page> pages = boundPages(view.scene);
        for (const Eye& eye : eyesOf(view, 24)) {
            for (const double turn : {-1.0, 0.0, 0.1}) {  // no second eye, a parallel one, a canted one
                std::vector<Eye> eyes{eye};
                if (turn >= 0.0) {
                    eyes.push_back(stereoPair(eye, 0.063)[1]);
                    auto& orientation = eyes[1].world_from_camera.orientation;
                    orientation = orientation * glm::angleAxis(turn, glm::dvec3(0, 1, 0));
                }
                const PagesOnDevice found = cullPages(*this, packed.pages(), test::shapeOf(view.scene), eyes);
                REQUIRE(found.state.count == found.list.size());
                REQUIRE(found.state.per_item.x * found.state.per_item.y >= found.list.size());
                REQUIRE(std::ranges::is_sorted(found.list));
                const auto least = reference::cullPages(pages, view.scene.isGaussian3d(), eyes, kSettings);
                const auto most = reference::cullPages(pages, view.scene.isGaussian3d(), eyes, kSettings, 1e-4);
                for (std::uint32_t p = 0; p < pages.size(); ++p) {
                    const bool is_found = std::ranges::binary_search(found.list, p);
                    if (least[p] != 0) { REQUIRE(is_found); }
                    if (is_found) { REQUIRE(most[p] != 0); }
                    ++(is_found ? kept : left_out);
                }
            }
        }
    }
    CHECK(kept > 1000);
    CHECK(left_out > 1000);
}

TEST_CASE_FIXTURE(Gpu, "no page is left out that holds a splat that cull keeps, wherever the eye is") {
    std::size_t splats_kept = 0, pages_left_out = 0;
    for (const ViewedScene& view : allScenes()) {
        CAPTURE(view.name);
        const PackedPages packed(view.scene, traitsOf(view.scene));
        const std::uint32_t count = static_cast<std::uint32_t>(view.scene.size());
        const std::vector<Eye> eyes = eyesOf(view, 60);
        const test::SceneOnDevice device(*this, view.scene, eyes, kSettings.near);
        const std::size_t words = test::pagesOf(count) * (gpu::kCullBlock / 32);
        const Buffer bits = allocate<gpu::uint>("bits", words), counts = allocate<gpu::uint>("counts", test::pagesOf(count)),
                     list = upload("visible", std::vector{gpu::ListState{}});
        for (std::size_t e = 0; e < eyes.size(); ++e) {
            gpu::CullPass pass{};
            pass.chunks = device.scene.chunks();
            pass.eyes = device.eyeViews();
            pass.visible_bits = bits.address<gpu::uint>();
            pass.group_counts = counts.address<gpu::uint>();
            pass.visible = list.address<gpu::ListState>();
            pass.splat_count = pass.capacity = count;
            pass.chunk_bits = device.scene.chunkBits();
            pass.first_eye = static_cast<gpu::uint>(e);
            pass.eye_count = 1;
            const Kernel& kernel = this->kernel(CullKernel{.splat_kind = device.scene.splatShape()});
            run([&](Commands& commands) { commands.dispatchOver(kernel, pass, count, gpu::kCullBlock); });
            const std::vector<gpu::uint> visible = readBack<gpu::uint>(bits, words);
            const PagesOnDevice found = cullPages(*this, packed.pages(), device.scene.splatShape(), {eyes[e]});
            for (std::uint32_t i = 0; i < count; ++i) {
                if ((visible[i / 32] >> (i % 32) & 1) == 0) { continue; }
                ++splats_kept;
                REQUIRE(std::ranges::binary_search(found.list, i / gpu::kPageSplats));
            }
            pages_left_out += packed.pageCount() - found.list.size();
        }
    }
    CHECK(splats_kept > 10000);
    CHECK(pages_left_out > 500);
}

TEST_CASE_FIXTURE(Gpu, "the list of pages is right at every size") {
    const Eye eye = test::makeEye({64, 64});
    std::mt19937 random(3);
    for (const std::uint32_t count : {1u, 2u, 31u, 32u, 33u, 127u, 128u, 129u, 1023u, 1024u, 1025u, 4097u, 40000u}) {
        CAPTURE(count);
        std::vector<gpu::ScenePage> pages;
        std::vector<std::uint32_t> expected;
        for (std::uint32_t p = 0; p < count; ++p) {
            const bool is_empty = random() % 4 == 0, is_seen = random() % 2 == 0;
            const float z = is_seen ? 2.0f : -2.0f;
            pages.push_back({.low = {-0.1f, -0.1f, z}, .reach = 0.1f, .high = {0.1f, 0.1f, z + 0.1f}, .count = is_empty ? 0u : 5u});
            if (!is_empty && is_seen) { expected.push_back(p); }
        }
        const PagesOnDevice found = cullPages(*this, pages, gpu::kDiscs, {eye});
        CHECK(found.list == expected);
        CHECK(found.state.needed == expected.size());
        const std::uint32_t groups = found.state.per_item.x * found.state.per_item.y * found.state.per_item.z;
        CHECK(groups >= expected.size());
        CHECK(groups < expected.size() + gpu::kMaxGroupsX);
        CHECK(found.state.per_item.x <= gpu::kMaxGroupsX);
    }
}

TEST_CASE_FIXTURE(Gpu, "a page whose bounds are not numbers, or too large for them, is left to cull") {
    constexpr float kHuge = 3e38f, kNone = std::numeric_limits<float>::quiet_NaN();
    const std::vector<gpu::ScenePage> pages{
        {.low = glm::vec3(-kHuge), .reach = 1.0f, .high = glm::vec3(kHuge), .count = 1},
        {.low = glm::vec3(kNone), .reach = 1.0f, .high = glm::vec3(kNone), .count = 1},
        {.low = {-1.0f, -1.0f, -3.0f}, .reach = std::numeric_limits<float>::infinity(), .high = {1.0f, 1.0f, 3.0f}, .count = 1}};
    for (const std::uint32_t shape : {gpu::kDiscs, gpu::kGaussians}) {
        CHECK(cullPages(*this, pages, shape, {test::makeEye({64, 64})}).list == std::vector<std::uint32_t>{0, 1, 2});
    }
}

}  // namespace pages_test
