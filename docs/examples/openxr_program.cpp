// A plain OpenXR program with a cube of its own, and the splats of SCENE before and behind it: openxr_program
// [SCENE]. It creates its Vulkan device as OpenXR wants it, draws its cube for both eyes, lets binosplat
// record into the same command buffer, and submits colour and depth.
#define XR_USE_GRAPHICS_API_VULKAN
#include <binosplat_vulkan.h>
#include <binosplat.hpp>
//
#include <vulkan/vulkan_raii.hpp>
//
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <thread>

#include "cube.hpp"
#include "openxr_parts.hpp"

namespace {

constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_SRGB, kDepth = VK_FORMAT_D32_SFLOAT;

void run(const char* source) {
    // OpenXR, as every Vulkan program begins.
    XrInstance xr = XR_NULL_HANDLE;
    const char* const extensions[]{XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME,
                                   XR_KHR_COMPOSITION_LAYER_DEPTH_EXTENSION_NAME};
    XrInstanceCreateInfo instance_info{
        XR_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, {"openxr_program", 1, "", 0, XR_MAKE_VERSION(1, 0, 0)}};
    instance_info.enabledExtensionCount = 2;
    instance_info.enabledExtensionNames = extensions;
    check(xrCreateInstance(&instance_info, &xr));
    XrSystemId system = XR_NULL_SYSTEM_ID;
    const XrSystemGetInfo system_info{XR_TYPE_SYSTEM_GET_INFO, nullptr, XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
    check(xrGetSystem(xr, &system_info, &system));

    // Vulkan, with what binosplat needs.
    XrGraphicsRequirementsVulkan2KHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
    check(find<PFN_xrGetVulkanGraphicsRequirements2KHR>(xr, "xrGetVulkanGraphicsRequirements2KHR")(xr, system,
                                                                                                   &needs));
    vk::raii::Context loader;
    const auto load = loader.getDispatcher()->vkGetInstanceProcAddr;
    const vk::ApplicationInfo application("openxr_program", 1, "", 0, VK_API_VERSION_1_2);
    const VkInstanceCreateInfo vulkan_info = vk::InstanceCreateInfo({}, &application);
    const XrVulkanInstanceCreateInfoKHR of_instance{
        XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR, nullptr, system, 0, load, &vulkan_info, nullptr};
    VkInstance vulkan = VK_NULL_HANDLE;
    VkResult vulkan_result{};
    check(find<PFN_xrCreateVulkanInstanceKHR>(xr, "xrCreateVulkanInstanceKHR")(xr, &of_instance, &vulkan,
                                                                               &vulkan_result));
    const vk::raii::Instance instance(loader, vulkan);
    const XrVulkanGraphicsDeviceGetInfoKHR of_gpu{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR, nullptr,
                                                  system, vulkan};
    VkPhysicalDevice gpu = VK_NULL_HANDLE;
    check(find<PFN_xrGetVulkanGraphicsDevice2KHR>(xr, "xrGetVulkanGraphicsDevice2KHR")(xr, &of_gpu, &gpu));
    const vk::raii::PhysicalDevice physical(instance, gpu);
    VkPhysicalDeviceVulkan12Features features = vk::PhysicalDeviceVulkan12Features();
    bsp_required_device_features(&features);
    const float priority = 1.0f;
    // The first family draws and computes, on all GPUs there are.
    const vk::DeviceQueueCreateInfo queue_info({}, 0, 1, &priority);
    const VkDeviceCreateInfo device_info = vk::DeviceCreateInfo({}, queue_info, {}, {}, nullptr, &features);
    const XrVulkanDeviceCreateInfoKHR of_device{
        XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR, nullptr, system, 0, load, gpu, &device_info, nullptr};
    VkDevice made = VK_NULL_HANDLE;
    check(find<PFN_xrCreateVulkanDeviceKHR>(xr, "xrCreateVulkanDeviceKHR")(xr, &of_device, &made,
                                                                           &vulkan_result));
    const vk::raii::Device device(physical, made);
    const vk::raii::Queue queue = device.getQueue(0, 0);

    // binosplat on this device. Its scene is there before the session begins, so that no other thread uses
    // the queue.
    auto own = bsp::make<bsp_vulkan_device>(BSP_TYPE_VULKAN_DEVICE);
    own.instance = vulkan;
    own.physical_device = gpu;
    own.device = made;
    own.queue = *queue;
    own.enabled_features = &features;
    auto of_splats = bsp::make<bsp_device_info>(BSP_TYPE_DEVICE_INFO);
    of_splats.next = &own;
    const bsp::Device splats(of_splats);
    const bsp::Scene scene(splats, source);
    scene.wait();
    const bsp_scene_properties start = scene.properties();
    bsp::Renderer renderer(splats);

    XrGraphicsBindingVulkan2KHR binding{
        XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR, nullptr, vulkan, gpu, made, 0, 0};
    const XrSessionCreateInfo session_info{XR_TYPE_SESSION_CREATE_INFO, &binding, 0, system};
    XrSession session = XR_NULL_HANDLE;
    check(xrCreateSession(xr, &session_info, &session));
    const XrReferenceSpaceCreateInfo space_info{XR_TYPE_REFERENCE_SPACE_CREATE_INFO,
                                                nullptr,
                                                XR_REFERENCE_SPACE_TYPE_LOCAL,
                                                {{0, 0, 0, 1}, {0, 0, 0}}};
    XrSpace space = XR_NULL_HANDLE;
    check(xrCreateReferenceSpace(session, &space_info, &space));
    std::array<XrViewConfigurationView, 2> sizes{
        {{XR_TYPE_VIEW_CONFIGURATION_VIEW}, {XR_TYPE_VIEW_CONFIGURATION_VIEW}}};
    std::uint32_t count = 2;
    check(xrEnumerateViewConfigurationViews(xr, system, XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, 2, &count,
                                            sizes.data()));
    std::vector<Swapchain> colours, depths;
    for (const XrViewConfigurationView& size : sizes) {
        colours.emplace_back(session, kColour, XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT, size);
        depths.emplace_back(session, kDepth, XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, size);
    }

    const Cube cube(device, vk::Format(kColour), vk::Format(kDepth));
    const vk::raii::CommandPool pool(
        device, vk::CommandPoolCreateInfo(vk::CommandPoolCreateFlagBits::eResetCommandBuffer, 0));
    const vk::raii::CommandBuffers buffers(
        device, vk::CommandBufferAllocateInfo(*pool, vk::CommandBufferLevel::ePrimary, 1));
    const vk::raii::CommandBuffer& commands = buffers[0];
    const vk::raii::Fence fence(device, vk::FenceCreateInfo());
    bool runs = false, is_prepared = false;
    for (std::uint64_t frames = 0;;) {
        if (!followStates(xr, session, runs)) {
            std::printf("%llu frames\n", static_cast<unsigned long long>(frames));
            check(xrDestroyInstance(xr));
            return;
        }
        if (!runs) { std::this_thread::sleep_for(std::chrono::milliseconds(5)); }
        if (!runs) { continue; }
        XrFrameState state{XR_TYPE_FRAME_STATE};
        check(xrWaitFrame(session, nullptr, &state));
        check(xrBeginFrame(session, nullptr));
        std::array<XrView, 2> eyes{{{XR_TYPE_VIEW}, {XR_TYPE_VIEW}}};
        XrViewState view_state{XR_TYPE_VIEW_STATE};
        const XrViewLocateInfo locate{XR_TYPE_VIEW_LOCATE_INFO, nullptr,
                                      XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO, state.predictedDisplayTime,
                                      space};
        check(xrLocateViews(session, &locate, &view_state, 2, &count, eyes.data()));
        std::array<XrCompositionLayerProjectionView, 2> shown{};
        std::array<XrCompositionLayerDepthInfoKHR, 2> shown_depths{};
        XrCompositionLayerProjection layer{
            XR_TYPE_COMPOSITION_LAYER_PROJECTION, nullptr, 0, space, 2, shown.data()};
        const auto* header = reinterpret_cast<const XrCompositionLayerBaseHeader*>(&layer);
        if (state.shouldRender) {
            std::array<bsp_target, 2> targets{};
            bsp::Views views{};
            std::vector<vk::raii::ImageView> image_views;
            std::vector<vk::raii::Framebuffer> framebuffers;
            commands.reset();
            commands.begin(vk::CommandBufferBeginInfo(vk::CommandBufferUsageFlagBits::eOneTimeSubmit));
            for (std::size_t e = 0; e < 2; ++e) {
                targets[e] = overCube(colours[e].acquire(), kColour, depths[e].acquire());
                // OpenXR's y points up and its -z forward: half a turn about x between the two. The wearer
                // begins where the scene is best seen.
                const auto& [q, p] = eyes[e].pose;
                views[e] = {BSP_TYPE_VIEW,
                            sizeof(bsp_view),
                            &targets[e],
                            {q.w, q.x, -q.y, -q.z},
                            {start.eye[0] + p.x, start.eye[1] - p.y, start.eye[2] - p.z},
                            eyes[e].fov.angleLeft,
                            eyes[e].fov.angleRight,
                            eyes[e].fov.angleUp,
                            eyes[e].fov.angleDown,
                            sizes[e].recommendedImageRectWidth,
                            sizes[e].recommendedImageRectHeight};
                const auto see = [&](VkImage image, VkFormat format, vk::ImageAspectFlagBits aspect) {
                    return *image_views.emplace_back(
                        device, vk::ImageViewCreateInfo({}, image, vk::ImageViewType::e2D, vk::Format(format),
                                                        {}, {aspect, 0, 1, 0, 1}));
                };
                const std::array seen{see(targets[e].colour, kColour, vk::ImageAspectFlagBits::eColor),
                                      see(targets[e].depth, kDepth, vk::ImageAspectFlagBits::eDepth)};
                framebuffers.emplace_back(
                    device,
                    vk::FramebufferCreateInfo({}, *cube.pass, seen, views[e].width, views[e].height, 1));
                cube.draw(commands, *framebuffers.back(), views[e], clipFromCube(views[e], start.look, 0.5));
                shown_depths[e] = {XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR, nullptr, depths[e].sub, 0, 1,
                                   std::numeric_limits<float>::infinity(),   kNear};
                shown[e] = {XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW, &shown_depths[e], eyes[e].pose,
                            eyes[e].fov, colours[e].sub};
            }
            bsp_frame_info frame = bsp::frame();
            frame.scene = scene.get();
            frame.views = views.data();
            frame.view_count = 2;
            frame.mode = BSP_MODE_TEMPORAL;
            frame.flags = BSP_FRAME_HALF_FLOATS;
            if (!is_prepared) { bsp::check(bsp_prepare(renderer.get(), &frame)); }
            is_prepared = true;
            std::uint64_t number = 0;
            bsp::check(bsp_record(renderer.get(), &frame, *commands, &number));
            commands.end();
            const vk::CommandBuffer buffer = *commands;
            queue.submit(vk::SubmitInfo({}, {}, buffer), *fence);
            // A program with two command buffers would do this a frame later, and would not wait.
            if (device.waitForFences(*fence, VK_TRUE, UINT64_MAX) != vk::Result::eSuccess) {
                throw std::runtime_error("no frame in time");
            }
            device.resetFences(*fence);
            bsp::check(bsp_collect(renderer.get(), number, nullptr));
            for (const std::vector<Swapchain>* chains : {&colours, &depths}) {
                for (const Swapchain& chain : *chains) {
                    check(xrReleaseSwapchainImage(chain.handle, nullptr));
                }
            }
            ++frames;
        }
        const XrFrameEndInfo end{XR_TYPE_FRAME_END_INFO,       nullptr,
                                 state.predictedDisplayTime,   XR_ENVIRONMENT_BLEND_MODE_OPAQUE,
                                 state.shouldRender ? 1u : 0u, &header};
        check(xrEndFrame(session, &end));
    }
}

}  // namespace

int main(int count, char** words) {
    try {
        run(count > 1 ? words[1] : "builtin:atelier");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "openxr_program: %s\n", error.what());
        return 1;
    }
    return 0;
}
