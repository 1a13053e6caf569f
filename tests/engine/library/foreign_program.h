// A Vulkan program of its own: an instance under the validation layers, a device, a picture and its depth.
#pragma once

#include "tests/engine/library/library_runs.h"

#include <binosplat_vulkan.h>
#include <vulkan/vulkan_raii.hpp>

namespace binosplat::test {

class ForeignImage {
public:
    ForeignImage(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, vk::Format format,
                 glm::uvec2 size_px, vk::ImageUsageFlags usage, vk::ImageAspectFlagBits aspect);

    vk::Format format;
    vk::raii::Image image;
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::ImageView view{nullptr};
};

class ForeignProgram {
public:
    static constexpr glm::uvec2 kSize{64, 48};

    // Without `features` the device lacks what the library needs.
    explicit ForeignProgram(bool features = true);
    ~ForeignProgram();

    [[nodiscard]] bsp::Device open();
    // Clears colour and depth, and draws a wall over the left half: red, at the stored depth. Afterwards the
    // image is in the layout of an attachment.
    void drawWall(const vk::raii::CommandBuffer& commands, float wall_depth) const;
    // Draws a white square in the corner, over the existing picture.
    void drawSign(const vk::raii::CommandBuffer& commands) const;
    // The bytes of an image that is in this layout; waits for the device.
    [[nodiscard]] std::vector<float> readFloats(const ForeignImage& image, vk::ImageLayout layout,
                                                std::uint32_t floats_per_pixel) const;
    [[nodiscard]] std::vector<std::uint32_t> readWords(const ForeignImage& image,
                                                       vk::ImageLayout layout) const;
    [[nodiscard]] vk::raii::CommandBuffer begin() const;
    void submit(const vk::raii::CommandBuffer& commands, const vk::raii::Fence& fence) const;
    // Submits, and waits until it is done.
    void finish(const vk::raii::CommandBuffer& commands) const;

    mutable std::mutex queue_mutex, messages_mutex;
    std::vector<std::string> messages;  // from the layers

    vk::raii::Context loader;
    vk::raii::Instance instance{nullptr};
    vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
    vk::raii::PhysicalDevice physical{nullptr};
    vk::raii::Device device{nullptr};
    vk::raii::Queue queue{nullptr};
    vk::raii::CommandPool pool{nullptr};
    std::optional<ForeignImage> colour, depth, floats;

private:
    void makePasses();
    [[nodiscard]] std::vector<std::byte> read(const ForeignImage& image, vk::ImageLayout layout,
                                              std::uint64_t bytes) const;

    vk::PhysicalDeviceVulkan12Features features_;
    vk::raii::RenderPass wall_{nullptr}, sign_{nullptr};
    vk::raii::Framebuffer of_wall_{nullptr}, of_sign_{nullptr};
};

}  // namespace binosplat::test
