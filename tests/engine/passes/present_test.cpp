// Facts about pictures on their way to a headset: the pass against its float64 twin, on the device.
#include "engine/passes/present.h"
#include "engine/reference/present.h"
#include "tests/engine/gpu/gpu_fixture.h"
#include "tests/engine/passes/stereo_cases.h"

#include <doctest/doctest.h>

#include <cmath>
#include <glm/gtc/packing.hpp>
#include <limits>

TEST_SUITE_BEGIN("present");

namespace present_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

struct Presented {
    std::vector<std::uint32_t> pixels;
    std::vector<float> depths;
};

// What the pass makes of `colours` (and of `depth_sums`, if there are any, or of the words of a picture that later ones are made from).
Presented runPresent(Gpu& gpu, glm::uvec2 size_px, const std::vector<glm::vec4>& colours, const std::vector<float>& depth_sums,
                     const reference::Presentation& how, bool halves = false, const std::vector<gpu::uint>& words = {}) {
    std::vector<glm::uvec2> packed;
    for (const glm::vec4& c : colours) { packed.emplace_back(glm::packHalf2x16({c.x, c.y}), glm::packHalf2x16({c.z, c.w})); }
    const Buffer in = halves ? gpu.upload("colours", packed) : gpu.upload("colours", colours), sums = gpu.upload("depth sums", depth_sums);
    const Buffer pixels = gpu.allocate<std::uint32_t>("pixels", colours.size()), depths = gpu.allocate<float>("depths", colours.size());
    const Buffer packed_depths = gpu.upload("words", words);
    const std::uint32_t depth_from = !words.empty() ? 2 : !depth_sums.empty() ? 1 : 0;
    gpu::PresentPass pass{};
    pass.colours = in.address<gpu::vec4>();
    pass.half_colours = in.address<gpu::uvec2>();
    pass.depths = sums.address<float>();
    pass.words = packed_depths.address<gpu::uint>();
    pass.pixels = pixels.address<gpu::uint>();
    pass.device_depths = depths.address<float>();
    pass.size_px = size_px;
    pass.near = static_cast<float>(how.near);
    const Kernel& kernel = gpu.kernel(PresentKernel{
        .blue_first = how.blue_first, .linear = how.linear, .depth = depth_from, .half_colours = halves, .see_through = how.see_through});
    gpu.run([&](Commands& commands) { commands.dispatch(kernel, pass, (size_px.x + 15) / 16, (size_px.y + 7) / 8); });
    return {gpu.readBack<std::uint32_t>(pixels, colours.size()), gpu.readBack<float>(depths, depth_from != 0 ? colours.size() : 0)};
}

// Every pixel another colour, from well below 0 to well above 1.
std::vector<glm::vec4> makeColours(glm::uvec2 size_px) {
    std::vector<glm::vec4> colours;
    for (std::uint32_t i = 0; i < size_px.x * size_px.y; ++i) {
        const auto at = static_cast<float>(i);
        colours.emplace_back(0.6f + 0.8f * std::sin(at), 0.5f + 0.4f * std::sin(0.37f * at), 0.5f + 0.6f * std::cos(0.11f * at),
                             0.5f + 0.5f * std::sin(0.05f * at));
    }
    return colours;
}

// Bytes may differ by one where the value lies between two, within float32's rounding.
std::size_t countOff(const std::vector<std::uint32_t>& actual, const std::vector<std::uint32_t>& expected, int tolerance) {
    std::size_t off = 0;
    for (std::size_t i = 0; i < actual.size(); ++i) {
        for (int shift = 0; shift < 32; shift += 8) {
            const int a = static_cast<int>((actual[i] >> shift) & 255), b = static_cast<int>((expected[i] >> shift) & 255);
            off += std::abs(a - b) > tolerance ? 1 : 0;
        }
    }
    return off;
}

std::vector<glm::dvec4> asDoubles(const std::vector<glm::vec4>& colours) { return {colours.begin(), colours.end()}; }

}  // namespace

TEST_CASE_FIXTURE(Gpu, "present shows half floats as the floats that they stand for") {
    for (const glm::uvec2 size_px : {glm::uvec2(1, 1), glm::uvec2(17, 9), glm::uvec2(100, 70)}) {
        std::vector<glm::vec4> colours = makeColours(size_px);
        for (glm::vec4& c : colours) {
            c = glm::vec4(glm::unpackHalf2x16(glm::packHalf2x16({c.x, c.y})), glm::unpackHalf2x16(glm::packHalf2x16({c.z, c.w})));
        }
        for (const bool linear : {false, true}) {
            const reference::Presentation how{false, linear, 0.2};
            CHECK(runPresent(*this, size_px, colours, {}, how, /*halves=*/true).pixels ==
                  runPresent(*this, size_px, colours, {}, how).pixels);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "pictures become the bytes of their twin, at every order of channels and encoding") {
    for (const glm::uvec2 size_px : {glm::uvec2(1, 1), glm::uvec2(15, 17), glm::uvec2(16, 16), glm::uvec2(33, 48)}) {
        const std::vector<glm::vec4> colours = makeColours(size_px);
        for (const bool blue_first : {false, true}) {
            for (const bool linear : {false, true}) {
                CAPTURE(size_px.x);
                CAPTURE(blue_first);
                CAPTURE(linear);
                for (const bool see_through : {false, true}) {
                    CAPTURE(see_through);
                    const reference::Presentation how{blue_first, linear, 0.2, see_through};
                    const Presented actual = runPresent(*this, size_px, colours, {}, how);
                    const std::vector<std::uint32_t> expected = reference::present(asDoubles(colours), how);
                    CHECK(countOff(actual.pixels, expected, 1) == 0);
                    CHECK(countOff(actual.pixels, expected, 0) <= 1 + colours.size() / 500);
                }
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "tints say what made a pixel, and nothing of tiles that no lens shows") {
    const glm::uvec2 size_px(3 * gpu::kTileSize, gpu::kTileSize);
    const std::vector<glm::vec4> colours(size_px.x * size_px.y, glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
    const Buffer in = upload("colours", colours), pixels = allocate<std::uint32_t>("pixels", colours.size());
    const Buffer kinds = upload("kinds", std::vector<std::uint32_t>{gpu::kTileHidden, gpu::kTileEdge, 0});
    const Buffer classes = upload("classes", std::vector<std::uint32_t>(3 * gpu::kTileSize, 0xaaaaaaaa));  // holes, all of them
    static_assert(gpu::kHole == 2);
    gpu::PresentPass pass{};
    pass.colours = in.address<gpu::vec4>();
    pass.tile_kinds = kinds.address<gpu::uint>();
    pass.pixel_classes = classes.address<gpu::uint>();
    pass.pixels = pixels.address<gpu::uint>();
    pass.size_px = size_px;
    const Kernel& kernel = this->kernel(PresentKernel{.tint = 1});
    run([&](Commands& commands) { commands.dispatch(kernel, pass, (size_px.x + 15) / 16, (size_px.y + 7) / 8); });
    const std::vector<std::uint32_t> shown = readBack<std::uint32_t>(pixels, colours.size());
    CHECK(shown[0] == 0xff000000);
    CHECK(shown[gpu::kTileSize] == 0xff662400);      // 0.4 of 0, 0.35, 1
    CHECK(shown[2 * gpu::kTileSize] == 0xff000066);  // 0.4 of red
}

TEST_CASE_FIXTURE(Gpu, "red comes first, opaque; with blue first it comes third") {
    const std::vector<glm::vec4> colours{{1.0f, 0.5f, 0.0f, 0.25f}};
    CHECK(runPresent(*this, {1, 1}, colours, {}, {false, false, 0.2}).pixels[0] == 0xff0080ffu);
    CHECK(runPresent(*this, {1, 1}, colours, {}, {true, false, 0.2}).pixels[0] == 0xffff8000u);
    CHECK(runPresent(*this, {1, 1}, colours, {}, {false, true, 0.2}).pixels[0] == 0xff0037ffu);  // 0.5 is 21.4 % of the light
}

TEST_CASE_FIXTURE(Gpu, "what is seen through has the light of its colour times its alpha") {
    // Half of white, encoded: half of its light is the byte 188. A quarter of red; nothing; more than all.
    const std::vector<glm::vec4> colours{{0.5f, 0.5f, 0.5f, 0.5f}, {0.25f, 0, 0, 0.25f}, {0.3f, 0.3f, 0.3f, 0}, {1, 0.5f, 0, 2}};
    const reference::Presentation how{false, false, 0.2, true};
    const std::vector<std::uint32_t> expected{0x80bcbcbcu, 0x40000089u, 0};
    const std::vector<std::uint32_t> actual = runPresent(*this, {4, 1}, colours, {}, how).pixels;
    CHECK(countOff({actual.begin(), actual.begin() + 3}, {expected.begin(), expected.begin() + 3}, 0) == 0);
    CHECK((actual[3] >> 24) == 255u);
    CHECK(countOff(actual, reference::present(asDoubles(colours), how), 0) == 0);
    // Opaque colours are the same bytes as ever.
    const std::vector<glm::vec4> opaque{{1.0f, 0.5f, 0.1f, 1.0f}};
    CHECK(runPresent(*this, {1, 1}, opaque, {}, how).pixels == runPresent(*this, {1, 1}, opaque, {}, {}).pixels);
}

TEST_CASE_FIXTURE(Gpu, "what is no colour becomes one") {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    const std::vector<glm::vec4> colours{{nan, nan, nan, nan}, {infinity, -infinity, nan, 1}, {-1, 2, -0.0f, 1}, {1e38f, -1e38f, 1, 0}};
    const Presented presented = runPresent(*this, {4, 1}, colours, {}, {false, false, 0.2});
    CHECK(presented.pixels == std::vector<std::uint32_t>{0xff000000u, 0xff0000ffu, 0xff00ff00u, 0xffff00ffu});
    CHECK(presented.pixels == reference::present(asDoubles(colours), {false, false, 0.2}));
}

TEST_CASE_FIXTURE(Gpu, "depth is near over depth, and nothing is infinitely far") {
    // Alpha 0.5 at depth 4, alpha 1 at the near plane, before it, nothing, hardly anything, alpha without depth.
    const std::vector<glm::vec4> colours{{0, 0, 0, 0.5f}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0.001f}, {0, 0, 0, 0.5f}};
    const std::vector<float> sums{2.0f, 0.25f, 0.1f, 0.0f, 0.001f, std::numeric_limits<float>::quiet_NaN()};
    const reference::Presentation how{false, false, 0.25};
    const Presented presented = runPresent(*this, {6, 1}, colours, sums, how);
    const std::vector<double> expected = reference::presentDepths(asDoubles(colours), std::vector<double>(sums.begin(), sums.end()), how);
    CHECK(expected == std::vector<double>{0.0625, 1.0, 1.0, 0.0, 0.0, 0.0});
    for (std::size_t i = 0; i < sums.size(); ++i) { CHECK(presented.depths[i] == doctest::Approx(expected[i]).epsilon(1e-6)); }
}

TEST_CASE_FIXTURE(Gpu, "a picture that later ones are made from has its depth in its words") {
    // Depths 4 and, to 19 bits, 3; before the near plane; infinitely far; of a pixel that goes nowhere; of hardly anything.
    const std::vector<glm::vec4> colours{{0, 0, 0, 0.5f}, {0, 0, 0, 1}, {0, 0, 0, 1}, {0, 0, 0, 0.5f}, {0, 0, 0, 1}, {0, 0, 0, 0.001f}};
    const std::vector<gpu::uint> words{
        packMoving(0.25, true, 3), packMoving(1.0 / 3.0, true, 31), packMoving(9.0, true, 0), packMoving(0.0, true, 0), 0,
        packMoving(0.25, true, 0)};
    const reference::Presentation how{false, false, 0.25};
    const Presented presented = runPresent(*this, {6, 1}, colours, {}, how, false, words);
    std::vector<double> sums;
    for (std::size_t i = 0; i < words.size(); ++i) {
        sums.push_back(static_cast<double>(colours[i].a) / unpackArrival(words[i]).inverse_depth);
    }
    const std::vector<double> expected = reference::presentDepths(asDoubles(colours), sums, how);
    CHECK(expected[0] == 0.0625);
    CHECK(expected[2] == 1.0);
    for (std::size_t i = 0; i < sums.size(); ++i) { CHECK(presented.depths[i] == doctest::Approx(expected[i]).epsilon(1e-6)); }
}

TEST_CASE_FIXTURE(Gpu, "the bytes reach an image, rows top to bottom") {
    const glm::uvec2 size_px(5, 3);
    using Usage = vk::ImageUsageFlagBits;
    const vk::raii::Image image(
        context().device(),
        vk::ImageCreateInfo({}, vk::ImageType::e2D, vk::Format::eR8G8B8A8Srgb, {size_px.x, size_px.y, 1}, 1, 1, vk::SampleCountFlagBits::e1,
                            vk::ImageTiling::eOptimal, Usage::eTransferDst | Usage::eTransferSrc | Usage::eColorAttachment));
    const auto needs = image.getMemoryRequirements();
    const vk::raii::DeviceMemory memory(context().device(),
                                        vk::MemoryAllocateInfo(needs.size, context().memoryType(needs.memoryTypeBits, {}, {})));
    image.bindMemory(*memory, 0);

    const std::vector<glm::vec4> colours = makeColours(size_px);
    const Picture eye{.colours = upload("colours", colours), .depths = {}};
    Presenter presenter(context(), vk::Format::eR8G8B8A8Srgb);
    const Buffer readback(context(), "read-back", colours.size() * 4, MemoryKind::kReadback);
    run([&](Commands& commands) {
        presenter.record(commands, {&eye, size_px, nullptr, *image, {}}, 0.2);
        const vk::ImageMemoryBarrier barrier(vk::AccessFlagBits::eMemoryWrite, vk::AccessFlagBits::eTransferRead,
                                             vk::ImageLayout::eColorAttachmentOptimal, vk::ImageLayout::eTransferSrcOptimal,
                                             VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, *image,
                                             {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1});
        const vk::raii::CommandBuffer& raw = commands.buffer();
        raw.pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands, vk::PipelineStageFlagBits::eTransfer, {}, {}, {}, barrier);
        raw.copyImageToBuffer(*image, vk::ImageLayout::eTransferSrcOptimal, readback.handle(),
                              vk::BufferImageCopy(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, 1}, {}, {size_px.x, size_px.y, 1}));
    });
    const auto words = readback.mapped<std::uint32_t>();
    CHECK(countOff({words.begin(), words.end()}, reference::present(asDoubles(colours), {}), 1) == 0);
}

TEST_CASE_FIXTURE(Gpu, "images of other formats are refused") {
    CHECK_THROWS_WITH(Presenter(context(), vk::Format::eR16G16B16A16Sfloat), doctest::Contains("8-bit RGBA or BGRA"));
}

TEST_CASE_FIXTURE(Gpu, "smaller copies of a picture are the mean of its pixels, down to a single one, in the light that they stand for") {
    constexpr glm::uvec2 kSize(8, 4);
    constexpr std::uint32_t kLevels = 4;
    const vk::Format format = vk::Format::eR8G8B8A8Srgb;
    REQUIRE(Commands::canMakeMips(context(), format));
    using Usage = vk::ImageUsageFlagBits;
    const vk::raii::Image image(
        context().device(),
        vk::ImageCreateInfo({}, vk::ImageType::e2D, format, {kSize.x, kSize.y, 1}, kLevels, 1, vk::SampleCountFlagBits::e1,
                            vk::ImageTiling::eOptimal, Usage::eTransferSrc | Usage::eTransferDst | Usage::eColorAttachment));
    const auto needs = image.getMemoryRequirements();
    const vk::raii::DeviceMemory memory(
        context().device(),
        vk::MemoryAllocateInfo(needs.size, context().memoryType(needs.memoryTypeBits, {}, vk::MemoryPropertyFlagBits::eDeviceLocal)));
    image.bindMemory(*memory, 0);
    // Black and white in turn on the left, white on the right.
    std::vector<std::uint32_t> texels;
    for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i) {
        const std::uint32_t x = i % kSize.x, y = i / kSize.x;
        texels.push_back(x < 4 && (x + y) % 2 == 0 ? 0xff000000u : 0xffffffffu);
    }
    const Buffer in = upload("picture", texels), out = allocate<std::uint32_t>("smallest", 1 + 2);
    run([&](Commands& commands) {
        commands.copyToImage(in, *image, kSize, vk::ImageAspectFlagBits::eColor);
        commands.makeMips(*image, kSize, kLevels);
        for (const std::uint32_t level : {2u, 3u}) {
            const vk::ImageMemoryBarrier barrier(vk::AccessFlagBits::eMemoryWrite, vk::AccessFlagBits::eTransferRead,
                                                 vk::ImageLayout::eColorAttachmentOptimal, vk::ImageLayout::eTransferSrcOptimal,
                                                 VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, *image,
                                                 {vk::ImageAspectFlagBits::eColor, level, 1, 0, 1});
            commands.buffer().pipelineBarrier(vk::PipelineStageFlagBits::eAllCommands, vk::PipelineStageFlagBits::eTransfer, {}, {}, {},
                                              barrier);
            const vk::BufferImageCopy region(level == 2 ? 0 : 2 * sizeof(std::uint32_t), 0, 0,
                                             {vk::ImageAspectFlagBits::eColor, level, 0, 1}, {}, {level == 2 ? 2u : 1u, 1, 1});
            commands.buffer().copyImageToBuffer(*image, vk::ImageLayout::eTransferSrcOptimal, out.handle(), region);
        }
    });
    const std::vector<std::uint32_t> small = readBack<std::uint32_t>(out, 3);
    const auto isNear = [](std::uint32_t texel, int grey) { return std::abs(static_cast<int>(texel & 255) - grey) <= 2; };
    // Half and three quarters of white's light, as sRGB writes them.
    CHECK(isNear(small[0], 188));
    CHECK(small[1] == 0xffffffffu);
    CHECK(isNear(small[2], 225));
}

}  // namespace present_test
