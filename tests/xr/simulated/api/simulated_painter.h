// Swapchain images with given texels, for programs on the simulated runtime, and what its wearer sees.
#pragma once

#include "tests/xr/simulated/api/simulated_fixture.h"
#include "xr/simulated/compose/compose.h"
#include "xr/simulated/compose/picture_file.h"

#include <vulkan/vulkan.hpp>

namespace binosplat::test {

using Rgb = std::array<int, 3>;
using Rgba = std::array<std::uint8_t, 4>;

// One pixel of a picture, or of one eye's half of it.
inline Rgb at(const simulated::RgbPicture& picture, std::uint32_t x, std::uint32_t y) {
    const std::size_t i = 3 * (std::size_t{y} * picture.size_px.x + x);
    return {picture.bytes[i], picture.bytes[i + 1], picture.bytes[i + 2]};
}

inline Rgb at(const simulated::RgbPicture& both, simulated::Side side, std::uint32_t x, std::uint32_t y) {
    return at(both, x + (side == simulated::kRight ? both.size_px.x / 2 : 0), y);
}

class Painter {
public:
    explicit Painter(const SessionFixture& owner)
        : fixture(owner), device(owner.device), pool(device.createCommandPoolUnique({})) {}

    [[nodiscard]] XrSwapchain makeSwapchain(VkFormat format, std::uint32_t width, std::uint32_t height,
                                            std::uint32_t layers = 1, std::uint32_t faces = 1) const {
        XrSwapchainCreateInfo info = swapchainInfo(format);
        info.usageFlags |= XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
        info.width = width;
        info.height = height;
        info.arraySize = layers;
        info.faceCount = faces;
        return fixture.makeSwapchain(info);
    }

    // Acquires an image and writes the texels of all its layers, from the first row of the first layer on.
    // Does not release it.
    template <class Texel>
    void begin(XrSwapchain swapchain, std::uint32_t width, std::uint32_t height,
               const std::vector<Texel>& texels) const {
        const std::uint32_t index = fixture.acquire(swapchain);
        REQUIRE(xrWaitSwapchainImage(swapchain, &kWait) == XR_SUCCESS);
        const vk::Image image = fixture.imagesOf(swapchain).at(index);
        const auto layers = static_cast<std::uint32_t>(texels.size() / (std::size_t{width} * height));
        const auto bytes = std::as_bytes(std::span(texels));
        const vk::UniqueBuffer buffer =
            device.createBufferUnique({{}, bytes.size(), vk::BufferUsageFlagBits::eTransferSrc});
        const vk::MemoryRequirements needs = device.getBufferMemoryRequirements(*buffer);
        const vk::UniqueDeviceMemory memory =
            device.allocateMemoryUnique({needs.size, hostMemory(needs.memoryTypeBits)});
        device.bindBufferMemory(*buffer, *memory, 0);
        std::memcpy(device.mapMemory(*memory, 0, VK_WHOLE_SIZE), bytes.data(), bytes.size());
        run([&](vk::CommandBuffer commands) {
            // An application gets images in the layout for drawing, and returns them in it.
            constexpr auto kDrawn = vk::ImageLayout::eColorAttachmentOptimal;
            constexpr auto kCopied = vk::ImageLayout::eTransferDstOptimal;
            move(commands, image, layers, kDrawn, kCopied);
            const vk::BufferImageCopy region(0, 0, 0, {vk::ImageAspectFlagBits::eColor, 0, 0, layers}, {},
                                             {width, height, 1});
            commands.copyBufferToImage(*buffer, image, kCopied, region);
            move(commands, image, layers, kCopied, kDrawn);
        });
    }
    template <class Texel>
    void paint(XrSwapchain swapchain, std::uint32_t width, std::uint32_t height,
               const std::vector<Texel>& texels) const {
        begin(swapchain, width, height, texels);
        REQUIRE(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
    }

    // Records commands, and waits until they are done.
    void run(const std::function<void(vk::CommandBuffer)>& record) const {
        const auto commands = device.allocateCommandBuffers({*pool, vk::CommandBufferLevel::ePrimary, 1})[0];
        commands.begin({vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
        record(commands);
        commands.end();
        const vk::Queue queue = device.getQueue(0, 0);
        queue.submit(vk::SubmitInfo({}, {}, commands));
        queue.waitIdle();
    }
    static void move(vk::CommandBuffer commands, vk::Image image, std::uint32_t layers, vk::ImageLayout from,
                     vk::ImageLayout to, vk::ImageAspectFlags aspects = vk::ImageAspectFlagBits::eColor) {
        const vk::AccessFlags any = vk::AccessFlagBits::eMemoryRead | vk::AccessFlagBits::eMemoryWrite;
        const vk::ImageMemoryBarrier barrier(any, any, from, to, VK_QUEUE_FAMILY_IGNORED,
                                             VK_QUEUE_FAMILY_IGNORED, image, {aspects, 0, 1, 0, layers});
        constexpr auto kAll = vk::PipelineStageFlagBits::eAllCommands;
        commands.pipelineBarrier(kAll, kAll, {}, {}, {}, barrier);
    }

private:
    [[nodiscard]] std::uint32_t hostMemory(std::uint32_t allowed) const {
        const auto memory = vk::PhysicalDevice(fixture.physical_device).getMemoryProperties();
        constexpr auto kHost =
            vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
        std::uint32_t type = 0;
        while (type < memory.memoryTypeCount &&
               ((allowed >> type & 1) == 0 || (memory.memoryTypes[type].propertyFlags & kHost) != kHost)) {
            ++type;
        }
        REQUIRE(type < memory.memoryTypeCount);
        return type;
    }

    const SessionFixture& fixture;
    vk::Device device;
    vk::UniqueCommandPool pool;
};

// A session in focus, whose last picture is read back.
struct Wearer : SessionFixture {
    Painter painter{*this};

    explicit Wearer(const std::string& script, const Extensions& extensions = {})
        : SessionFixture(script, extensions) {}

    // A picture of one colour.
    [[nodiscard]] XrSwapchain plain(std::uint32_t size, const Rgba& colour) const {
        const XrSwapchain swapchain = painter.makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, size, size);
        painter.paint(swapchain, size, size, std::vector<Rgba>(std::size_t{size} * size, colour));
        return swapchain;
    }
    [[nodiscard]] simulated::RgbPicture seen() const {
        return simulated::readPng(written / logged().back()["picture"].get<std::string>());
    }
};

}  // namespace binosplat::test
