// XR_KHR_vulkan_enable2 on the simulated runtime.
#include "tests/xr/simulated/api/simulated_fixture.h"

#include <cstdlib>

TEST_SUITE_BEGIN("simulated_vulkan");

namespace simulated_vulkan_test {

using namespace binosplat::test;

TEST_CASE_FIXTURE(InstanceFixture, "requirements are a range of Vulkan versions, and asked for before a session") {
    const auto getRequirements = function<PFN_xrGetVulkanGraphicsRequirements2KHR>("xrGetVulkanGraphicsRequirements2KHR");
    XrGraphicsRequirementsVulkan2KHR requirements{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
    CHECK(getRequirements(instance, system + 1, &requirements) == XR_ERROR_SYSTEM_INVALID);
    CHECK(getRequirements(instance, system, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    requirements.type = XR_TYPE_UNKNOWN;
    CHECK(getRequirements(instance, system, &requirements) == XR_ERROR_VALIDATION_FAILURE);

    const XrGraphicsBindingVulkan2KHR graphics{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR};
    const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &graphics, 0, system};
    XrSession session = XR_NULL_HANDLE;
    CHECK(xrCreateSession(instance, &info, &session) == XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
    requirements.type = XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR;
    CHECK(getRequirements(instance, system, &requirements) == XR_SUCCESS);
    CHECK(requirements.minApiVersionSupported <= XR_MAKE_VERSION(1, 1, 0));
    CHECK(requirements.maxApiVersionSupported >= XR_MAKE_VERSION(1, 2, 0));
    CHECK(xrCreateSession(instance, &info, &session) == XR_ERROR_GRAPHICS_DEVICE_INVALID);
}

TEST_CASE_FIXTURE(InstanceFixture, "Vulkan's own refusal stands in vulkanResult") {
    const auto create = function<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR");
    const char* const nothing = "VK_KHR_nothing";
    VkInstanceCreateInfo vulkan_info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    vulkan_info.enabledExtensionCount = 1;
    vulkan_info.ppEnabledExtensionNames = &nothing;
    XrVulkanInstanceCreateInfoKHR info{XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR};
    info.systemId = system;
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanCreateInfo = &vulkan_info;
    VkInstance vulkan = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    CHECK(create(instance, &info, &vulkan, &result) == XR_SUCCESS);
    CHECK(result == VK_ERROR_EXTENSION_NOT_PRESENT);

    info.createFlags = 1;
    CHECK(create(instance, &info, &vulkan, &result) == XR_ERROR_VALIDATION_FAILURE);
    info.createFlags = 0;
    info.systemId = 9;
    CHECK(create(instance, &info, &vulkan, &result) == XR_ERROR_SYSTEM_INVALID);
    info.systemId = system;
    info.pfnGetInstanceProcAddr = nullptr;
    CHECK(create(instance, &info, &vulkan, &result) == XR_ERROR_VALIDATION_FAILURE);
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanCreateInfo = nullptr;
    CHECK(create(instance, &info, &vulkan, &result) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(create(instance, nullptr, &vulkan, &result) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(create(XR_NULL_HANDLE, &info, &vulkan, &result) == XR_ERROR_HANDLE_INVALID);
}

TEST_CASE_FIXTURE(VulkanFixture, "the graphics device is one of the instance's, the same each time") {
    const auto get = function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR");
    XrVulkanGraphicsDeviceGetInfoKHR info{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR, nullptr, system, vulkan};
    VkPhysicalDevice found = VK_NULL_HANDLE;
    CHECK(get(instance, &info, &found) == XR_SUCCESS);
    CHECK(found == physical_device);
    info.systemId = 0;
    CHECK(get(instance, &info, &found) == XR_ERROR_SYSTEM_INVALID);
    info.systemId = system;
    info.vulkanInstance = VK_NULL_HANDLE;
    CHECK(get(instance, &info, &found) == XR_ERROR_VALIDATION_FAILURE);
    info.vulkanInstance = vulkan;
    CHECK(get(instance, &info, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    for (const char* index : {"99", "first", "0x"}) {
        setenv("SIMULATED_OPENXR_GPU", index, 1);
        CHECK_MESSAGE(get(instance, &info, &found) == XR_ERROR_RUNTIME_FAILURE, index);
    }
    unsetenv("SIMULATED_OPENXR_GPU");
}

TEST_CASE_FIXTURE(VulkanFixture, "a device is made on the graphics device alone") {
    const auto create = function<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR");
    VkDeviceCreateInfo vulkan_info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    XrVulkanDeviceCreateInfoKHR info{XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR};
    info.systemId = system;
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanCreateInfo = &vulkan_info;
    VkDevice made = VK_NULL_HANDLE;
    VkResult result = VK_SUCCESS;
    CHECK(create(instance, &info, &made, &result) == XR_ERROR_HANDLE_INVALID);
    info.vulkanPhysicalDevice = physical_device;
    info.type = XR_TYPE_UNKNOWN;
    CHECK(create(instance, &info, &made, &result) == XR_ERROR_VALIDATION_FAILURE);
    info.type = XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR;
    info.systemId = 4;
    CHECK(create(instance, &info, &made, &result) == XR_ERROR_SYSTEM_INVALID);
}

TEST_CASE("the older extension has functions of its own, and needs no extensions of Vulkan") {
    const Headset headset(kQuietScript);
    const std::vector<const char*> extensions{XR_KHR_VULKAN_ENABLE_EXTENSION_NAME};
    const XrInstanceCreateInfo info = instanceInfo(extensions);
    XrInstance instance = XR_NULL_HANDLE;
    REQUIRE(xrCreateInstance(&info, &instance) == XR_SUCCESS);
    const auto find = [&](const char* name) {
        PFN_xrVoidFunction found = nullptr;
        xrGetInstanceProcAddr(instance, name, &found);
        return found;
    };
    CHECK((find("xrCreateVulkanInstanceKHR") == nullptr));
    CHECK((find("xrGetVulkanGraphicsDeviceKHR") != nullptr));
    for (const char* name : {"xrGetVulkanInstanceExtensionsKHR", "xrGetVulkanDeviceExtensionsKHR"}) {
        const auto getExtensions = reinterpret_cast<PFN_xrGetVulkanInstanceExtensionsKHR>(find(name));
        REQUIRE((getExtensions != nullptr));
        std::uint32_t count = 0;
        char text[4] = "no";
        CHECK(getExtensions(instance, 1, 0, &count, nullptr) == XR_SUCCESS);
        CHECK(count == 1);
        CHECK(getExtensions(instance, 1, 4, &count, text) == XR_SUCCESS);
        CHECK(std::string(text).empty());
        CHECK(getExtensions(instance, 2, 4, &count, text) == XR_ERROR_SYSTEM_INVALID);
    }
    const auto getRequirements = reinterpret_cast<PFN_xrGetVulkanGraphicsRequirementsKHR>(find("xrGetVulkanGraphicsRequirementsKHR"));
    REQUIRE((getRequirements != nullptr));
    XrGraphicsRequirementsVulkanKHR requirements{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN_KHR};
    CHECK(getRequirements(instance, 1, &requirements) == XR_SUCCESS);
    CHECK(requirements.minApiVersionSupported <= XR_MAKE_VERSION(1, 1, 0));
    CHECK(requirements.maxApiVersionSupported >= XR_MAKE_VERSION(1, 2, 0));
    CHECK(getRequirements(instance, 2, &requirements) == XR_ERROR_SYSTEM_INVALID);
    CHECK(getRequirements(XR_NULL_HANDLE, 1, &requirements) == XR_ERROR_HANDLE_INVALID);
    CHECK(getRequirements(instance, 1, nullptr) == XR_ERROR_VALIDATION_FAILURE);
    requirements.type = XR_TYPE_UNKNOWN;
    CHECK(getRequirements(instance, 1, &requirements) == XR_ERROR_VALIDATION_FAILURE);
    CHECK(xrDestroyInstance(instance) == XR_SUCCESS);
}

}  // namespace simulated_vulkan_test
