// Swapchain images with given texels, for programs on the simulated runtime.
#pragma once

#include "tests/xr/simulated/api/simulated_fixture.h"

namespace binosplat::test {

class Painter {
public:
    explicit Painter(const SessionFixture& owner) : fixture(owner) {
        const VkCommandPoolCreateInfo info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0, 0};
        REQUIRE(vkCreateCommandPool(fixture.device, &info, nullptr, &pool) == VK_SUCCESS);
    }
    ~Painter() { vkDestroyCommandPool(fixture.device, pool, nullptr); }
    Painter(const Painter&) = delete;
    Painter& operator=(const Painter&) = delete;

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
        const auto layers = static_cast<std::uint32_t>(texels.size() / (std::size_t{width} * height));
        copy(fixture.imagesOf(swapchain).at(index), {width, height, 1}, layers, texels.data(),
             texels.size() * sizeof(Texel));
    }
    template <class Texel>
    void paint(XrSwapchain swapchain, std::uint32_t width, std::uint32_t height,
               const std::vector<Texel>& texels) const {
        begin(swapchain, width, height, texels);
        REQUIRE(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
    }

    // Records commands, and waits until they are done.
    template <class Record>
    void run(const Record& record) const {
        VkCommandBuffer commands = VK_NULL_HANDLE;
        const VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
        REQUIRE(vkAllocateCommandBuffers(fixture.device, &info, &commands) == VK_SUCCESS);
        const VkCommandBufferBeginInfo begin_info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                                  VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
        REQUIRE(vkBeginCommandBuffer(commands, &begin_info) == VK_SUCCESS);
        record(commands);
        REQUIRE(vkEndCommandBuffer(commands) == VK_SUCCESS);
        const VkSubmitInfo submit{
            VK_STRUCTURE_TYPE_SUBMIT_INFO, nullptr, 0, nullptr, nullptr, 1, &commands, 0, nullptr};
        REQUIRE(vkQueueSubmit(fixture.queue(), 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS);
        REQUIRE(vkQueueWaitIdle(fixture.queue()) == VK_SUCCESS);
    }
    static void move(VkCommandBuffer commands, VkImage image, std::uint32_t layers, VkImageLayout from,
                     VkImageLayout to, VkImageAspectFlags aspects = VK_IMAGE_ASPECT_COLOR_BIT) {
        VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
        barrier.srcAccessMask = barrier.dstAccessMask =
            VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
        barrier.oldLayout = from;
        barrier.newLayout = to;
        barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
        barrier.image = image;
        barrier.subresourceRange = {aspects, 0, 1, 0, layers};
        vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                             0, 0, nullptr, 0, nullptr, 1, &barrier);
    }

private:
    void copy(VkImage image, VkExtent3D size, std::uint32_t layers, const void* texels,
              std::size_t bytes) const {
        VkBuffer buffer = VK_NULL_HANDLE;
        VkBufferCreateInfo buffer_info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
        buffer_info.size = bytes;
        buffer_info.usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        REQUIRE(vkCreateBuffer(fixture.device, &buffer_info, nullptr, &buffer) == VK_SUCCESS);
        VkMemoryRequirements needs{};
        vkGetBufferMemoryRequirements(fixture.device, buffer, &needs);
        const VkMemoryAllocateInfo memory_info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
                                               hostMemory(needs.memoryTypeBits)};
        VkDeviceMemory memory = VK_NULL_HANDLE;
        REQUIRE(vkAllocateMemory(fixture.device, &memory_info, nullptr, &memory) == VK_SUCCESS);
        REQUIRE(vkBindBufferMemory(fixture.device, buffer, memory, 0) == VK_SUCCESS);
        void* mapped = nullptr;
        REQUIRE(vkMapMemory(fixture.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped) == VK_SUCCESS);
        std::memcpy(mapped, texels, bytes);
        vkUnmapMemory(fixture.device, memory);
        run([&](VkCommandBuffer commands) {
            // An application gets images in the layout for drawing, and returns them in it.
            move(commands, image, layers, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
            const VkBufferImageCopy region{0,         0,   0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, layers},
                                           {0, 0, 0}, size};
            vkCmdCopyBufferToImage(commands, buffer, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
            move(commands, image, layers, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                 VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        });
        vkDestroyBuffer(fixture.device, buffer, nullptr);
        vkFreeMemory(fixture.device, memory, nullptr);
    }

    [[nodiscard]] std::uint32_t hostMemory(std::uint32_t allowed) const {
        VkPhysicalDeviceMemoryProperties memory{};
        vkGetPhysicalDeviceMemoryProperties(fixture.physical_device, &memory);
        constexpr VkMemoryPropertyFlags kHost =
            VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
        std::uint32_t type = 0;
        while (type < memory.memoryTypeCount &&
               ((allowed >> type & 1) == 0 || (memory.memoryTypes[type].propertyFlags & kHost) != kHost)) {
            ++type;
        }
        REQUIRE(type < memory.memoryTypeCount);
        return type;
    }

    const SessionFixture& fixture;
    VkCommandPool pool = VK_NULL_HANDLE;
};

}  // namespace binosplat::test
