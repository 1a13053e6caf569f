// Vulkan's codes in words.
#include "engine/gpu/device_error.h"

namespace binosplat {

DeviceError deviceError(const std::string& device, const vk::SystemError& error) {
    using Kind = DeviceError::Kind;
    switch (static_cast<vk::Result>(error.code().value())) {
        case vk::Result::eErrorOutOfDeviceMemory:
        case vk::Result::eErrorOutOfHostMemory:
            return {Kind::kMemory,
                    fmt::format("{}: not enough memory for this scene and picture size, must be smaller ({})",
                                device, error.what())};
        case vk::Result::eErrorDeviceLost:
            return {
                Kind::kLost,
                fmt::format("{}: the device was lost in the middle of a frame, look at the system's log ({})",
                            device, error.what())};
        default:
            return {Kind::kOther, fmt::format("{}: the device gave up in the middle of a frame ({})", device,
                                              error.what())};
    }
}

}  // namespace binosplat
