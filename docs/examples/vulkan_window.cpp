// A window with a Vulkan device of its own, a cube, and the splats of SCENE before and behind it:
// vulkan_window [SCENE] [FRAMES]. Two frames are under way at a time, and nothing waits for the one that was
// just submitted.
#include <binosplat_vulkan.h>
#include <binosplat.hpp>
#include <vulkan/vulkan_raii.hpp>
//
#include <GLFW/glfw3.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "cube.hpp"

namespace {

constexpr std::uint32_t kWidth = 640, kHeight = 480;
constexpr vk::Format kColour = vk::Format::eB8G8R8A8Srgb, kDepth = vk::Format::eD32Sfloat;

// What a frame uses until the device is done with it.
struct Frame {
    Frame(const vk::raii::Device& device, vk::CommandBuffer its_commands)
        : commands(its_commands),
          acquired(device, vk::SemaphoreCreateInfo()),
          drawn(device, vk::SemaphoreCreateInfo()),
          fence(device, vk::FenceCreateInfo()) {}
    vk::CommandBuffer commands;
    vk::raii::Semaphore acquired, drawn;
    vk::raii::Fence fence;
    std::uint64_t number = 0;  // binosplat's; 0: none is under way
};

void run(GLFWwindow* window, const char* source, long frames_left) {
    // Vulkan, as every program with a window begins.
    const vk::raii::Context loader;
    std::uint32_t count = 0;
    const char** const extensions = glfwGetRequiredInstanceExtensions(&count);
    const vk::ApplicationInfo application("vulkan_window", 1, "", 0, VK_API_VERSION_1_2);
    const vk::raii::Instance instance(
        loader, vk::InstanceCreateInfo({}, &application, 0, nullptr, count, extensions));
    VkSurfaceKHR raw_surface = VK_NULL_HANDLE;
    if (glfwCreateWindowSurface(*instance, window, nullptr, &raw_surface) != VK_SUCCESS) {
        throw std::runtime_error("no surface");
    }
    const vk::raii::SurfaceKHR surface(instance, raw_surface);
    const vk::raii::PhysicalDevice physical = std::move(vk::raii::PhysicalDevices(instance).at(0));

    // The device: a queue that draws, computes and presents, and what binosplat needs.
    VkPhysicalDeviceVulkan12Features features = vk::PhysicalDeviceVulkan12Features();
    bsp_required_device_features(&features);
    const float priority = 1.0f;
    const vk::DeviceQueueCreateInfo queue_info({}, 0, 1, &priority);
    const char* const swapchains = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    const vk::raii::Device device(physical,
                                  vk::DeviceCreateInfo({}, queue_info, {}, swapchains, nullptr, &features));
    const vk::raii::Queue queue = device.getQueue(0, 0);

    // The images of the window, which binosplat reads and writes besides, and one depth for all of them.
    using Usage = vk::ImageUsageFlagBits;
    const auto capabilities = physical.getSurfaceCapabilitiesKHR(*surface);
    const vk::Extent2D size(kWidth, kHeight);
    const vk::raii::SwapchainKHR swapchain(
        device,
        vk::SwapchainCreateInfoKHR({}, *surface, std::max(3u, capabilities.minImageCount), kColour,
                                   vk::ColorSpaceKHR::eSrgbNonlinear, size, 1,
                                   Usage::eColorAttachment | Usage::eTransferSrc | Usage::eTransferDst,
                                   vk::SharingMode::eExclusive, {}, capabilities.currentTransform));
    const vk::raii::Image depth(
        device,
        vk::ImageCreateInfo({}, vk::ImageType::e2D, kDepth, {kWidth, kHeight, 1}, 1, 1,
                            vk::SampleCountFlagBits::e1, vk::ImageTiling::eOptimal,
                            Usage::eDepthStencilAttachment | Usage::eTransferSrc | Usage::eTransferDst));
    const vk::MemoryRequirements needs = depth.getMemoryRequirements();
    std::uint32_t type = 0;
    while ((needs.memoryTypeBits >> type & 1) == 0) { ++type; }
    const vk::raii::DeviceMemory depth_memory(device, vk::MemoryAllocateInfo(needs.size, type));
    depth.bindMemory(*depth_memory, 0);
    const auto see = [&](vk::Image image, vk::Format format, vk::ImageAspectFlagBits aspect) {
        return vk::raii::ImageView(device, vk::ImageViewCreateInfo({}, image, vk::ImageViewType::e2D, format,
                                                                   {}, {aspect, 0, 1, 0, 1}));
    };
    const vk::raii::ImageView depth_view = see(*depth, kDepth, vk::ImageAspectFlagBits::eDepth);
    const Cube cube(device, kColour, kDepth);
    std::vector<VkImage> images;
    for (const auto& image : swapchain.getImages()) { images.push_back(static_cast<VkImage>(image)); }
    std::vector<vk::raii::ImageView> views;
    std::vector<vk::raii::Framebuffer> framebuffers;
    for (const VkImage image : images) {
        const std::array both{*views.emplace_back(see(image, kColour, vk::ImageAspectFlagBits::eColor)),
                              *depth_view};
        framebuffers.emplace_back(device,
                                  vk::FramebufferCreateInfo({}, *cube.pass, both, kWidth, kHeight, 1));
    }

    // binosplat on this device. Nothing else uses the queue while the scene loads.
    auto own = bsp::make<bsp_vulkan_device>(BSP_TYPE_VULKAN_DEVICE);
    own.instance = *instance;
    own.physical_device = *physical;
    own.device = *device;
    own.queue = *queue;
    own.enabled_features = &features;
    auto info = bsp::make<bsp_device_info>(BSP_TYPE_DEVICE_INFO);
    info.next = &own;
    const bsp::Device splats(info);
    const bsp::Scene scene(splats, source);
    scene.wait();
    const bsp_scene_properties start = scene.properties();
    bsp::Renderer renderer(splats);

    const vk::raii::CommandPool pool(
        device, vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, 0));
    const vk::raii::CommandBuffers buffers(
        device, vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 2));
    std::array<Frame, 2> frames{Frame(device, *buffers[0]), Frame(device, *buffers[1])};
    const auto collect = [&](Frame& frame) {
        if (frame.number == 0) { return; }
        if (device.waitForFences(*frame.fence, VK_TRUE, UINT64_MAX) != vk::Result::eSuccess) {
            throw std::runtime_error("no frame in time");
        }
        device.resetFences(*frame.fence);
        bsp::check(bsp_collect(renderer.get(), frame.number, nullptr));
        frame.number = 0;
    };
    bool is_prepared = false;
    for (std::size_t turn = 0; !glfwWindowShouldClose(window) && frames_left-- > 0; turn = 1 - turn) {
        glfwPollEvents();
        Frame& frame = frames[turn];
        collect(frame);  // the one before the last
        const std::uint32_t index = swapchain.acquireNextImage(UINT64_MAX, *frame.acquired).second;

        // The camera goes to and fro about where the scene is best seen.
        const double aside = 0.2 * std::sin(0.02 * static_cast<double>(frames_left));
        const double eye[]{start.eye[0] + aside, start.eye[1], start.eye[2]};
        bsp_target target = overCube(images[index], static_cast<VkFormat>(kColour), *depth);
        target.colour_after = VK_IMAGE_LAYOUT_PRESENT_SRC_KHR;
        auto view = bsp::make<bsp_view>(BSP_TYPE_VIEW);
        bsp::check(bsp_look_at(eye, start.look, start.up, 0.0, 1.2, kWidth, kHeight, 1, &view));
        view.next = &target;
        bsp_frame_info asked = bsp::frame();
        asked.scene = scene.get();
        asked.views = &view;
        asked.view_count = 1;
        asked.flags = BSP_FRAME_HALF_FLOATS;
        if (!is_prepared) { bsp::check(bsp_prepare(renderer.get(), &asked)); }
        is_prepared = true;

        // The cube, the splats, and on to the window.
        const vk::raii::CommandBuffer& commands = buffers[turn];
        commands.reset();
        commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
        cube.draw(commands, *framebuffers[index], view, clipFromCube(view, start.look, 0.5));
        bsp::check(bsp_record(renderer.get(), &asked, *commands, &frame.number));
        commands.end();
        const vk::PipelineStageFlags writes = vk::PipelineStageFlagBits::eColorAttachmentOutput;
        queue.submit(vk::SubmitInfo(*frame.acquired, writes, frame.commands, *frame.drawn), *frame.fence);
        (void)queue.presentKHR(vk::PresentInfoKHR(*frame.drawn, *swapchain, index));
    }
    for (Frame& frame : frames) { collect(frame); }
    device.waitIdle();  // for what is still to be presented
}

}  // namespace

int main(int count, char** words) {
    if (glfwInit() != GLFW_TRUE) { return 3; }
    int result = 0;
    try {
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
        GLFWwindow* const window = glfwCreateWindow(kWidth, kHeight, "splats and a cube", nullptr, nullptr);
        if (window == nullptr) { throw std::runtime_error("no window"); }
        run(window, count > 1 ? words[1] : "builtin:atelier", count > 2 ? std::atol(words[2]) : 1000000);
        std::puts("shown");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "vulkan_window: %s\n", error.what());
        result = 1;
    }
    glfwTerminate();
    return result;
}
