// XR_KHR_vulkan_enable2 and section 10.1 of OpenXR on the simulated runtime: devices, swapchains, and images'
// layouts.
#include "tests/xr/simulated/api/simulated_direct.h"
#include "tests/xr/simulated/api/simulated_painter.h"

SUITE(simulated_swapchain) {

constexpr XrSwapchainUsageFlags kWritten = XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT,
                                kMutable = XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT;

// Vulkan's loader, which records how images are created.
struct ImageRecorder {
    static inline PFN_vkGetDeviceProcAddr find_in_device = nullptr;
    static inline PFN_vkCreateImage create_image = nullptr;
    static inline std::vector<VkImageCreateInfo> made;

    static VkResult createImage(VkDevice device, const VkImageCreateInfo* info,
                                const VkAllocationCallbacks* allocator, VkImage* image) {
        made.push_back(*info);
        return create_image(device, info, allocator, image);
    }
    static PFN_vkVoidFunction findInDevice(VkDevice device, const char* name) {
        if (std::string_view(name) == "vkGetDeviceProcAddr") {
            return reinterpret_cast<PFN_vkVoidFunction>(findInDevice);
        }
        const PFN_vkVoidFunction found = find_in_device(device, name);
        if (std::string_view(name) != "vkCreateImage") { return found; }
        create_image = reinterpret_cast<PFN_vkCreateImage>(found);
        return reinterpret_cast<PFN_vkVoidFunction>(createImage);
    }
    static PFN_vkVoidFunction find(VkInstance instance, const char* name) {
        const PFN_vkVoidFunction found = vkGetInstanceProcAddr(instance, name);
        if (std::string_view(name) != "vkGetDeviceProcAddr") { return found; }
        find_in_device = reinterpret_cast<PFN_vkGetDeviceProcAddr>(found);
        return reinterpret_cast<PFN_vkVoidFunction>(findInDevice);
    }
};

// The order in which images are acquired.
std::vector<std::uint32_t> turnsOf(const std::string& images, int times) {
    const SessionFixture made(kQuietScript + images);
    const XrSwapchain swapchain = made.makeSwapchain();
    std::vector<std::uint32_t> found;
    for (int i = 0; i < times; ++i) {
        found.push_back(made.turn(swapchain));
        CHECK(found.back() < made.imagesOf(swapchain).size());
    }
    return found;
}

TEST_CASE_FIXTURE(InstanceFixture,
                  "Vulkan's versions are asked for before a session, its own refusal is told") {
    const auto getRequirements = XR(xrGetVulkanGraphicsRequirements2KHR);
    XrGraphicsRequirementsVulkan2KHR requirements{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
    CHECK(getRequirements(instance, system + 1, &requirements) == XR_ERROR_SYSTEM_INVALID);
    const auto getFor = [&](XrInstance of, auto* place) { return getRequirements(of, system, place); };
    checkArguments(getFor, instance, &requirements);
    const XrGraphicsBindingVulkan2KHR graphics{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR};
    const XrSessionCreateInfo session_info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
    CHECK(xrCreateSession(instance, &session_info, &session) == XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
    CHECK(getFor(instance, &requirements) == XR_SUCCESS);
    CHECK(requirements.minApiVersionSupported <= XR_MAKE_VERSION(1, 1, 0));
    CHECK(requirements.maxApiVersionSupported >= XR_MAKE_VERSION(1, 2, 0));
    CHECK(xrCreateSession(instance, &session_info, &session) == XR_ERROR_GRAPHICS_DEVICE_INVALID);

    const auto create = XR(xrCreateVulkanInstanceKHR);
    const char* const nothing = "VK_KHR_nothing";
    const VkInstanceCreateInfo vulkan_info{
        VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, nullptr, 0, nullptr, 1, &nothing};
    XrVulkanInstanceCreateInfoKHR info = vulkanInstanceInfo(vkGetInstanceProcAddr, vulkan_info);
    VkInstance vulkan = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    const auto make = [&] { return create(instance, &info, &vulkan, &result); };
    CHECK(make() == XR_SUCCESS);
    CHECK(result == VK_ERROR_EXTENSION_NOT_PRESENT);
    CHECK(with(info.systemId, 9, make) == XR_ERROR_SYSTEM_INVALID);
    checkChanges(make, XR_ERROR_VALIDATION_FAILURE, to(info.createFlags, 1),
                 to(info.pfnGetInstanceProcAddr, nullptr), to(info.vulkanCreateInfo, nullptr));
    checkArguments(create, instance, &info, &vulkan, &result);
}

// The fixture checks that the graphics device is the same each time.
TEST_CASE_FIXTURE(VulkanFixture,
                  "the graphics device is one of Vulkan's instance; devices are made on it alone") {
    const auto get = XR(xrGetVulkanGraphicsDevice2KHR);
    XrVulkanGraphicsDeviceGetInfoKHR get_info{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR, nullptr, system,
                                              vulkan};
    VkPhysicalDevice found = VK_NULL_HANDLE;
    const auto find = [&] { return get(instance, &get_info, &found); };
    CHECK(with(get_info.systemId, 0, find) == XR_ERROR_SYSTEM_INVALID);
    CHECK(with(get_info.vulkanInstance, VK_NULL_HANDLE, find) == XR_ERROR_VALIDATION_FAILURE);
    checkArguments(get, instance, &get_info, &found);
    for (const char* index : {"99", "first", "0x"}) {
        setenv("SIMULATED_OPENXR_GPU", index, 1);
        CHECK_MESSAGE(find() == XR_ERROR_RUNTIME_FAILURE, index);
    }
    unsetenv("SIMULATED_OPENXR_GPU");
    CHECK(find() == XR_SUCCESS);

    const VkDeviceCreateInfo vulkan_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    XrVulkanDeviceCreateInfoKHR info = vulkanDeviceInfo(vkGetInstanceProcAddr, physical_device, vulkan_info);
    VkDevice made = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    checkArguments(XR(xrCreateVulkanDeviceKHR), instance, &info, &made, &result);
    const auto make = [&] { return XR(xrCreateVulkanDeviceKHR)(instance, &info, &made, &result); };
    CHECK(with(info.vulkanPhysicalDevice, VK_NULL_HANDLE, make) == XR_ERROR_HANDLE_INVALID);
    CHECK(with(info.systemId, 4, make) == XR_ERROR_SYSTEM_INVALID);
}

TEST_CASE("the older extension has functions of its own, and needs no extensions of Vulkan") {
    const DirectInstance made(k1_0, {XR_KHR_VULKAN_ENABLE_EXTENSION_NAME});
    CHECK_FALSE(made.has("xrCreateVulkanInstanceKHR"));
    for (const auto getExtensions :
         {made.XR(xrGetVulkanInstanceExtensionsKHR), made.XR(xrGetVulkanDeviceExtensionsKHR)}) {
        std::uint32_t count = 0;
        char text[4] = "no";
        CHECK(getExtensions(made.instance, 1, 0, &count, nullptr) == XR_SUCCESS);
        CHECK(count == 1);
        CHECK(getExtensions(made.instance, 1, 4, &count, text) == XR_SUCCESS);
        CHECK(std::string(text) == "");
        CHECK(getExtensions(made.instance, 2, 4, &count, text) == XR_ERROR_SYSTEM_INVALID);
    }
    const auto getRequirements = made.XR(xrGetVulkanGraphicsRequirementsKHR);
    XrGraphicsRequirementsVulkanKHR requirements{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN_KHR};
    CHECK(getRequirements(made.instance, 1, &requirements) == XR_SUCCESS);
    CHECK(getRequirements(made.instance, 2, &requirements) == XR_ERROR_SYSTEM_INVALID);
}

TEST_CASE_FIXTURE(SessionFixture,
                  "formats are listed, sRGB first; a swapchain is refused what it cannot be") {
    const auto formats = checkListOf(std::int64_t{}, xrEnumerateSwapchainFormats, session);
    CHECK(formats.front() == VK_FORMAT_R8G8B8A8_SRGB);
    const std::set<int64_t> all(formats.begin(), formats.end());
    for (const VkFormat format : {VK_FORMAT_B8G8R8A8_SRGB, VK_FORMAT_R8G8B8A8_UNORM,
                                  VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_D32_SFLOAT}) {
        CHECK(all.contains(format));
    }

    XrSwapchain swapchain = XR_NULL_HANDLE;
    XrSwapchainCreateInfo info = swapchainInfo();
    const auto make = [&] { return xrCreateSwapchain(session, &info, &swapchain); };
    CHECK(with(info.format, VK_FORMAT_R8_UNORM, make) == XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED);
    checkChanges(make, XR_ERROR_VALIDATION_FAILURE, to(info.width, 0), to(info.height, 0),
                 to(info.arraySize, 0), to(info.mipCount, 0), to(info.sampleCount, 0),
                 to(info.width, 1 << 20), to(info.mipCount, 8), to(info.faceCount, 2),
                 to(info.createFlags, 1 << 20), to(info.usageFlags, 1 << 20));
    checkChanges(make, XR_ERROR_FEATURE_UNSUPPORTED, to(info.sampleCount, 4), to(info.faceCount, 6),
                 to(info.createFlags, XR_SWAPCHAIN_CREATE_PROTECTED_CONTENT_BIT),
                 to(info.usageFlags, XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT));
    checkChanges(make, XR_SUCCESS, to(info.mipCount, 7), to(info.arraySize, 2));
    checkArguments(xrCreateSwapchain, session, &info, &swapchain);

    // A swapchain as large as the largest view on offer can be created.
    const auto views = checkListOf(XrViewConfigurationView{XR_TYPE_VIEW_CONFIGURATION_VIEW},
                                   xrEnumerateViewConfigurationViews, instance, system, kStereo);
    info.width = views[0].maxImageRectWidth;
    info.height = views[0].maxImageRectHeight;
    CHECK(make() == XR_SUCCESS);
}

TEST_CASE_FIXTURE(SessionFixture, "every format, use and shape can be held whole, twice, and Vulkan agrees") {
    constexpr XrSwapchainUsageFlags kSampled = XR_SWAPCHAIN_USAGE_SAMPLED_BIT;
    constexpr XrSwapchainUsageFlags kCopied =
        XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
    for (const std::int64_t format : checkListOf(std::int64_t{}, xrEnumerateSwapchainFormats, session)) {
        for (const XrSwapchainUsageFlags use :
             {XrSwapchainUsageFlags{0}, kSampled, kCopied, kSampled | kCopied, kMutable, kSampled | kMutable,
              kWritten | kMutable, kWritten}) {
            for (const std::uint32_t shape : {0, 1, 2, 3}) {
                XrSwapchainCreateInfo info = swapchainInfo(static_cast<VkFormat>(format));
                // One of the uses is not as an attachment.
                info.usageFlags = use == (kSampled | kCopied) ? use : info.usageFlags | use;
                info.arraySize = shape == 1 ? 2 : 1;
                info.mipCount = shape == 2 ? 2 : 1;
                info.createFlags = shape == 3 ? XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT : 0;
                INFO("format ", format, " use ", use, " shape ", shape);
                XrSwapchain swapchain = XR_NULL_HANDLE;
                const XrResult made = xrCreateSwapchain(session, &info, &swapchain);
                // Not every device can write every format from shaders.
                if ((use & kWritten) != 0 && made == XR_ERROR_FEATURE_UNSUPPORTED) { continue; }
                REQUIRE(made == XR_SUCCESS);
                const std::size_t images = imagesOf(swapchain).size();
                REQUIRE(images == (shape == 3 ? 1 : 3));
                for (int round = 0; round < (shape == 3 ? 1 : 2); ++round) {
                    for (std::size_t held = 0; held < images; ++held) { acquire(swapchain); }
                    for (std::size_t held = 0; held < images; ++held) {
                        checkEach(XR_SUCCESS, {xrWaitSwapchainImage(swapchain, &kWait),
                                               xrReleaseSwapchainImage(swapchain, nullptr)});
                    }
                }
                CHECK(xrDestroySwapchain(swapchain) == XR_SUCCESS);
            }
        }
    }
}

TEST_CASE("images are made by the application's loader, with extended usage alone for shaders that write") {
    const SessionFixture recorded(kQuietScript, {}, ImageRecorder::find);
    const auto flagsFor = [&](XrSwapchainUsageFlags usage) {
        XrSwapchainCreateInfo info = swapchainInfo();
        info.usageFlags |= usage;
        ImageRecorder::made.clear();
        recorded.makeSwapchain(info);
        return ImageRecorder::made.at(0).flags;
    };
    CHECK(these(flagsFor(0), flagsFor(kMutable), flagsFor(kMutable | kWritten)) ==
          these(0, VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT,
                (VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT | VK_IMAGE_CREATE_EXTENDED_USAGE_BIT)));
}

TEST_CASE_FIXTURE(SessionFixture,
                  "images are acquired, waited for and released in this order, oldest first") {
    const XrSwapchain swapchain = makeSwapchain();
    const std::vector<VkImage> images = imagesOf(swapchain);
    CHECK(these(images.size(), std::set(images.begin(), images.end()).size()) == these(3, 3));
    CHECK(imagesOf(swapchain) == images);
    std::uint32_t count = 0;
    CHECK(xrEnumerateSwapchainImages(XR_NULL_HANDLE, 0, &count, nullptr) == XR_ERROR_HANDLE_INVALID);

    std::uint32_t index = 99;
    checkEach(XR_ERROR_CALL_ORDER_INVALID,
              {xrWaitSwapchainImage(swapchain, &kWait), xrReleaseSwapchainImage(swapchain, nullptr)});
    const XrSwapchainImageAcquireInfo wrong{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO};
    checkEach(XR_ERROR_VALIDATION_FAILURE, {xrAcquireSwapchainImage(swapchain, nullptr, nullptr),
                                            xrAcquireSwapchainImage(swapchain, &wrong, &index)});
    CHECK(acquire(swapchain) < 3);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrWaitSwapchainImage(swapchain, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrWaitSwapchainImage(swapchain, &kWait) == XR_SUCCESS);
    CHECK(xrWaitSwapchainImage(swapchain, &kWait) == XR_ERROR_CALL_ORDER_INVALID);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_SUCCESS);
    CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_ERROR_CALL_ORDER_INVALID);

    const XrSwapchainImageWaitInfo at_once{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, 0};
    const std::uint32_t first = acquire(swapchain);
    CHECK(std::set{first, acquire(swapchain), acquire(swapchain)}.size() == 3);
    CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &index) == XR_ERROR_CALL_ORDER_INVALID);
    checkEach(XR_SUCCESS,
              {xrWaitSwapchainImage(swapchain, &at_once), xrReleaseSwapchainImage(swapchain, nullptr)});
    CHECK(acquire(swapchain) == first);

    // A static swapchain has one image, which can be acquired once.
    XrSwapchainCreateInfo info = swapchainInfo();
    info.createFlags = XR_SWAPCHAIN_CREATE_STATIC_IMAGE_BIT;
    const XrSwapchain fixed = makeSwapchain(info);
    CHECK(imagesOf(fixed).size() == 1);
    turn(fixed);
    CHECK(xrAcquireSwapchainImage(fixed, nullptr, &index) == XR_ERROR_CALL_ORDER_INVALID);
}

TEST_CASE("a slow image times out, and is there later; not while a session is being lost") {
    const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, 1000};
    for (const bool is_lost : {false, true}) {
        const SessionFixture made(kQuietScript + "at 0 slow-images 2\n" +
                                  (is_lost ? "at 0 lose-session\n" : ""));
        const XrSwapchain swapchain = made.makeSwapchain();
        made.begin();
        made.waitFrame();
        const XrResult success = is_lost ? XR_SESSION_LOSS_PENDING : XR_SUCCESS;
        std::uint32_t index = 0;
        CHECK(xrAcquireSwapchainImage(swapchain, nullptr, &index) == success);
        if (!is_lost) {
            CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_TIMEOUT_EXPIRED);
            CHECK(xrReleaseSwapchainImage(swapchain, nullptr) == XR_ERROR_CALL_ORDER_INVALID);
            CHECK(xrWaitSwapchainImage(swapchain, &wait) == XR_TIMEOUT_EXPIRED);
        }
        checkEach(success,
                  {xrWaitSwapchainImage(swapchain, &wait), xrReleaseSwapchainImage(swapchain, nullptr)});
    }
}

// Colour is that of every painted picture.
TEST_CASE_FIXTURE(SessionFixture, "images of depth are found in an attachment's layout, on every turn") {
    const Painter painter(*this);
    const XrSwapchain swapchain = makeSwapchain(swapchainInfo(VK_FORMAT_D32_SFLOAT));
    // Uses the image as a drawing application would; validation checks the layout.
    const auto use = [&](VkImage image) {
        painter.run([&](vk::CommandBuffer commands) {
            constexpr auto kLayout = vk::ImageLayout::eDepthStencilAttachmentOptimal;
            Painter::move(commands, image, 1, kLayout, kLayout, vk::ImageAspectFlagBits::eDepth);
        });
    };
    for (int round = 0; round < 5; ++round) { turn(swapchain, use); }
}

TEST_CASE("images come in as many, and in the order, as the script says") {
    CHECK(these(turnsOf("images 2", 4), turnsOf("images 1", 2), turnsOf("images 4 reversed", 5)) ==
          these(std::vector<std::uint32_t>{0, 1, 0, 1}, std::vector<std::uint32_t>{0, 0},
                std::vector<std::uint32_t>{3, 2, 1, 0, 3}));
    const auto order = turnsOf("images 5 shuffled", 40);
    CHECK(std::set(order.begin(), order.end()).size() == 5);
    std::size_t in_turn = 0;
    for (std::size_t i = 1; i < order.size(); ++i) {
        CHECK(order[i] != order[i - 1]);  // the one being shown
        in_turn += order[i] == (order[i - 1] + 1) % 5 ? 1 : 0;
    }
    CHECK(in_turn < 30);
}

}  // SUITE(simulated_swapchain)
