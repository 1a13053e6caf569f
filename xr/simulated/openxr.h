// OpenXR's and Vulkan's types, without the prototypes: the functions of this runtime carry the same names in
// their own namespace.
#pragma once

#define XR_NO_PROTOTYPES
#define XR_USE_GRAPHICS_API_VULKAN
#define XR_USE_TIMESPEC
#define VK_NO_PROTOTYPES
#include <time.h>
#include <vulkan/vulkan.h>
//
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>
//
#include "xr/simulated/openxr_later.h"
