// Section 10.1 of OpenXR on the simulated runtime: swapchains, and the layouts in which XR_KHR_vulkan_enable2 hands their images over.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <set>
#include <string_view>

TEST_SUITE_BEGIN("simulated_swapchain");

namespace simulated_swapchain_test {

using namespace binosplat::test;

namespace {

struct SlowFixture : SessionFixture {
    SlowFixture() : SessionFixture("size 64 64\nframes none\nat 0 slow-images 2\n") {}
};

struct SlowAndLosingFixture : SessionFixture {
    SlowAndLosingFixture() : SessionFixture("size 64 64\nframes none\nat 0 slow-images 2\nat 0 lose-session\n") {}
};

// Vulkan's loader, which notes what images are made with.
struct ImageRecorder {
    static inline PFN_vkGetDeviceProcAddr find_in_device = nullptr;
    static inline PFN_vkCreateImage create_image = nullptr;
    static inline std::vector<VkImageCreateInfo> made;

    static VkResult createImage(VkDevice device, const VkImageCreateInfo* info, const VkAllocationCallbacks* allocator, VkImage* image) {
        made.push_back(*info);
        return create_image(device, info, allocator, image);
    }
    static PFN_vkVoidFunction findInDevice(VkDevice device, const char* name) {
        if (std::string_view(name) == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(findInDevice);
        const PFN_vkVoidFunction found = find_in_device(device, name);
        if (std::string_view(name) != "vkCreateImage") return found;
        create_image = reinterpret_cast<PFN_vkCreateImage>(found);
        return reinterpret_cast<PFN_vkVoidFunction>(createImage);
    }
    static PFN_vkVoidFunction find(VkInstance instance, const char* name) {
        const PFN_vkVoidFunction found = vkGetInstanceProcAddr(instance, name);
        if (std::string_view(name) != "vkGetDeviceProcAddr") return found;
        find_in_device = reinterpret_cast<PFN_vkGetDeviceProcAddr>(found);
        return reinterpret_cast<PFN_vkVoidFunction>(findInDevice);
    }
};

struct RecordedFixture : SessionFixture {
    RecordedFixture() : SessionFixture(kQuietScript, {}, ImageRecorder::find) {}

    VkImageCreateFlags flagsFor(XrSwapchainUsageFlags usage) const {
        XrSwapchainCreateInfo info = swapchainInfo();
        info.usageFlags |= usage;
        XrSwapchain swapchain = XR_NULL_HANDLE;
        ImageRecorder::made.clear();
        REQUIRE(xrCreateSwapchain(session, &info, &swapchain) == XR_SUCCESS);
        REQUIRE(!ImageRecorder::made.empty());
        return ImageRecorder::made.front().flags;
    }
};

// A clear of the image and back, as an application that draws would touch it; validation watches the layout it is found in.
void touch(const SessionFixture& fixture, VkImage image, VkImageLayout found) {
    VkCommandPool pool = VK_NULL_HANDLE;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    const VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    REQUIRE(vkCreateCommandPool(fixture.device, &pool_info, nullptr, &pool) == VK_SUCCESS);
    const VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool,
                                               VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    REQUIRE(vkAllocateCommandBuffers(fixture.device, &allocate, &commands) == VK_SUCCESS);
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    vkBeginCommandBuffer(commands, &begin);
    VkImageMemoryBarrier barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
    barrier.srcAccessMask = barrier.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
    barrier.oldLayout = barrier.newLayout = found;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    const bool is_colour = found == VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    barrier.subresourceRange = {static_cast<VkImageAspectFlags>(is_colour ? VK_IMAGE_ASPECT_COLOR_BIT : VK_IMAGE_ASPECT_DEPTH_BIT), 0, 1, 0,
                                1};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                         &barrier);
    vkEndCommandBuffer(commands);
    VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    REQUIRE(vkQueueSubmit(fixture.queue(), 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS);
    vkQueueWaitIdle(fixture.queue());
    vkDestroyCommandPool(fixture.device, pool, nullptr);
}

std::vector<VkImage> imagesOf(XrSwapchain swapchain) {
    std::uint32_t count = 0;
    REQUIRE(xrEnumerateSwapchainImages(swapchain, 0, &count, nullptr) == XR_SUCCESS);
    std::vector<XrSwapchainImageVulkan2KHR> found(count, {XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR, nullptr, VK_NULL_HANDLE});
    REQUIRE(xrEnumerateSwapchainImages(swapchain, count, &count, reinterpret_cast<XrSwapchainImageBaseHeader*>(found.data())) ==
            XR_SUCCESS);
    std::vector<VkImage> images;
    for (const auto& one : found) images.push_back(one.image);
    return images;
}

}  // namespace

TEST_CASE_FIXTURE(SessionFixture, "formats are enumerated, sRGB first") {
    std::uint32_t count = 0;
    CHECK(xrEnumerateSwapchainFormats(session, 0, &count, nullptr) == XR_SUCCESS);
    std::vector<int64_t> formats(count);
    CHECK(xrEnumerateSwapchainFormats(session, count, &count, formats.data()) == XR_SUCCESS);
    CHECK(formats.front() == VK_FORMAT_R8G8B8A8_SRGB);
    const std::set<int64_t> all(formats.begin(), formats.end());
    for (const VkFormat format : {VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM, VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_D32_SFLOAT}) {
        CHECK(all.contains(format));
    }
    CHECK(xrEnumerateSwapchainFormats(session, 1, &count, formats.data()) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(xrEnumerateSwapchainFormats(XR_NULL_HANDLE, 0, &count, nullptr) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "a swapchain is refused for what it cannot be") {
    XrSwapchain swapchain = XR_NULL_HANDLE;
    const auto made = [&](auto&& change) {
        XrSwapchainCreateInfo info = swapchainInfo();
        change(info);
        return xrCreateSwapchain(session, &info, &swapchain);
    };
    CHECK(made([](auto& info) { info.format = VK_FORMAT_R8_UNORM; }) == XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED);
    CHECK(made([](auto& info) { info.width = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.height = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.width = 1 << 20; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.arraySize = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.mipCount = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.mipCount = 8; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.sampleCount = 0; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.sampleCount = 4; }) == XR_ERROR_FEATURE_UNSUPPORTED);
    CHECK(made([](auto& info) { info.faceCount = 2; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.faceCount = 6; }) == XR_ERROR_FEATURE_UNSUPPORTED);
    CHECK(made([](auto& info) { info.createFlags = XR_SWAPCHAIN_CREATE_PROTECTED_CONTENT_BIT; }) == XR_ERROR_FEATURE_UNSUPPORTED);
    CHECK(made([](auto& info) { info.createFlags = 1 << 20; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.usageFlags = 1 << 20; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.usageFlags = XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT; }) == XR_ERROR_FEATURE_UNSUPPORTED);
    CHECK(made([](auto& info) { info.type = XR_TYPE_SESSION_CREATE_INFO; }) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(made([](auto& info) { info.mipCount = 7; }) == XR_SUCCESS);
    CHECK(made([](auto& info) { info.arraySize = 2; }) == XR_SUCCESS);
    CHECK(xrCreateSwapchain(session, nullptr, &swapchain) == XR_ERROR_VALIDATION_FAILURE);
    const XrSwapchainCreateInfo info = swapchainInfo();
    CHECK(xrCreateSwapchain(session, &info, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrCreateSwapchain(XR_NULL_HANDLE, &info, &swapchain) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "every format and use makes images that Vulkan has nothing against") {
    std::uint32_t count = 0;
    std::int64_t formats[32];
    REQUIRE(xrEnumerateSwapchainFormats(session, 32, &count, formats) == XR_SUCCESS);
    constexpr XrSwapchainUsageFlags kUses =
        XR_SWAPCHAIN_USAGE_SAMPLED_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
    for (std::uint32_t i = 0; i < count; ++i) {
        XrSwapchainCreateInfo info = swapchainInfo(static_cast<VkFormat>(formats[i]));
        info.usageFlags = kUses;
        XrSwapchain swapchain = XR_NULL_HANDLE;
        CHECK_MESSAGE(xrCreateSwapchain(session, &info, &swapchain) == XR_SUCCESS, formats[i]);
    }
    XrSwapchainCreateInfo info = swapchainInfo();
    info.usageFlags = XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT | XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT;
    XrSwapchain swapchain = XR_NULL_HANDLE;
    CHECK(xrCreateSwapchain(session, &info, &swapchain) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(SessionFixture, "every format, use and shape can be held whole, twice, and freed in between") {
    constexpr XrSwapchainUsageFlags kUses[] = {0,
                                               XR_SWAPCHAIN_USAGE_SAMPLED_BIT,
                                               XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT,
                                               XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT,
                                               XR_SWAPCHAIN_USAGE_SAMPLED_BIT | XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT,
                                               XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT | XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT,
                                               XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT};
    std::uint32_t count = 0;
    std::int64_t formats[32];
    REQUIRE(xrEnumerateSwapchainFormats(session, 32, &count, formats) == XR_SUCCESS);
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, XR_INFINITE_DURATION};
    for (std::uint32_t i = 0; i < count; ++i) {
        const bool is_depth = formats[i] == VK_FORMAT_D32_SFLOAT || formats[i] == VK_FORMAT_D16_UNORM ||
                              formats[i] == VK_FORMAT_D24_UNORM_S8_UINT || formats[i] == VK_FORMAT_D32_SFLOAT_S8_UINT;
        for (const XrSwapchainUsageFlags use : kUses) {
            for (const std::uint32_t shape : {0, 1, 2, 3}) {
                XrSwapchainCreateInfo info = swapchainInfo();
                info.format = formats[i];
                info.usageFlags = use;
                info.usageFlags |= is_depth ? XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
                info.arraySize = shape == 1 ? 2 : 1;
                info.mipCount = shape == 2 ? 2 : 1;
                info.createFlags = shape == 3 ? XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT : 0;
                INFO("format ", formats[i], " use ", use, " shape ", shape);
                XrSwapchain swapchain = XR_NULL_HANDLE;
                const XrResult made = xrCreateSwapchain(session, &info, &swapchain);
                // Not every device writes every format from shaders.
                if ((use & XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT) != 0 && made == XR_ERROR_FEATURE_UNSUPPORTED) continue;
                REQUIRE(made == XR_SUCCESS);
                const std::size_t images = imagesOf(swapchain).size();
                REQUIRE(images == (shape == 3 ? 1 : 3));
                for (int round = 0; round < (shape == 3 ? 1 : 2); ++round) {
                    std::uint32_t index = 0;
                    for (std::size_t held = 0; held < images; ++held)
                        CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SUCCESS);
                    for (std::size_t held = 0; held < images; ++held) {
                        CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_SUCCESS);
                        CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
                    }
                }
                CHECK(xrDestroySwapchain(swapchain) == XR_SUCCESS);
            }
        }
    }
}

TEST_CASE_FIXTURE(RecordedFixture, "images are made by the functions of the application's own loader") { CHECK(flagsFor(0) == 0); }

TEST_CASE_FIXTURE(RecordedFixture, "mutable images ask for extended usage, which came with Vulkan 1.1, for shaders that write alone") {
    CHECK(flagsFor(XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT) == VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT);
    CHECK(flagsFor(XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT | XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT) ==
          (VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT));
}

TEST_CASE_FIXTURE(SessionFixture, "a swapchain of the largest view that is offered can be made") {
    XrViewConfigurationView views[2] = {{XR_TYPE_VIEW_CONFIGURATION_VIEW}, {XR_TYPE_VIEW_CONFIGURATION_VIEW}};
    std::uint32_t count = 0;
    const auto stereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
    REQUIRE(xrEnumerateViewConfigurationViews(instance, system, stereo, 2, &count, views) == XR_SUCCESS);
    XrSwapchainCreateInfo info = swapchainInfo();
    info.width = views[0].maxImageRectWidth;
    info.height = views[0].maxImageRectHeight;
    XrSwapchain swapchain = XR_NULL_HANDLE;
    CHECK(xrCreateSwapchain(session, &info, &swapchain) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(SessionFixture, "images are enumerated in structures of their type, always the same") {
    const XrSwapchain swapchain = makeSwapchain();
    const std::vector<VkImage> images = imagesOf(swapchain);
    CHECK(images.size() == 3);
    CHECK(std::set<VkImage>(images.begin(), images.end()).size() == 3);
    CHECK(imagesOf(swapchain) == images);
    XrSwapchainImageVulkan2KHR one[3] = {{XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR}, {XR_TYPE_UNKNOWN}, {XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR}};
    auto* const headers = reinterpret_cast<XrSwapchainImageBaseHeader*>(one);
    std::uint32_t count = 0;
    CHECK(xrEnumerateSwapchainImages(swapchain, 3, &count, headers) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrEnumerateSwapchainImages(swapchain, 2, &count, headers) == XR_ERROR_SIZE_INSUFFICIENT);
    CHECK(xrEnumerateSwapchainImages(XR_NULL_HANDLE, 0, &count, nullptr) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture, "images are acquired, waited for and released in this order") {
    const XrSwapchain swapchain = makeSwapchain();
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, XR_INFINITE_DURATION};
    std::uint32_t index = 99;
    CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrAcquireSwapchainImage(swapchain, nullptr, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SUCCESS);
    CHECK(index < 3);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrWaitSwapchainImage(swapchain, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_SUCCESS);
    CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    const XrSwapchainImageAcquireInfo wrong{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO};
    CHECK(xrAcquireSwapchainImage(swapchain, &wrong, &index) == XR_ERROR_VALIDATION_FAILURE);
}

TEST_CASE_FIXTURE(SessionFixture, "several images can be held at once, but not more than there are, and are released oldest first") {
    const XrSwapchain swapchain = makeSwapchain();
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, 0};
    std::uint32_t indices[3], fourth = 0;
    for (std::uint32_t& index : indices) CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SUCCESS);
    CHECK(std::set<std::uint32_t>(indices, indices + 3).size() == 3);
    CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &fourth) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_SUCCESS);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
    CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &fourth) == XR_SUCCESS);
    CHECK(fourth == indices[0]);
}

TEST_CASE_FIXTURE(SessionFixture, "a static swapchain has one image, for one time") {
    const XrSwapchain swapchain = makeSwapchain(VK_FORMAT_R8G8B8A8_SRGB, XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT);
    CHECK(imagesOf(swapchain).size() == 1);
    turn(swapchain);
    std::uint32_t index = 0;
    CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_ERROR_CALL_ORDER_INVALID);
}

TEST_CASE_FIXTURE(SlowFixture, "a slow image times out, and is there later") {
    begin();
    waitFrame();
    const XrSwapchain swapchain = makeSwapchain();
    XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, 1000};
    std::uint32_t index = 0;
    CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SUCCESS);
    CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_TIMEOUT_EXPIRED);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_TIMEOUT_EXPIRED);
    CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_SUCCESS);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
}

TEST_CASE_FIXTURE(SlowAndLosingFixture, "while a session is being lost slow images are waited for, and can be released") {
    const XrSwapchain swapchain = makeSwapchain();
    begin();
    waitFrame();
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, 1000};
    std::uint32_t index = 0;
    CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SESSION_LOSS_PENDING);
    CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_SESSION_LOSS_PENDING);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SESSION_LOSS_PENDING);
}

TEST_CASE_FIXTURE(SessionFixture, "images are found in attachment layouts, on every turn") {
    const XrSwapchain colour = makeSwapchain(), depth = makeSwapchain(VK_FORMAT_D32_SFLOAT);
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, XR_INFINITE_DURATION};
    for (const auto& [swapchain, layout] : {std::pair(colour, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL),
                                            std::pair(depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL)}) {
        const std::vector<VkImage> images = imagesOf(swapchain);
        for (int round = 0; round < 5; ++round) {
            std::uint32_t index = 0;
            REQUIRE(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_SUCCESS);
            REQUIRE(xrWaitSwapchainImage(swapchain, &wait) == XR_SUCCESS);
            touch(*this, images[index], layout);
            REQUIRE(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
        }
    }
}

}  // namespace simulated_swapchain_test
