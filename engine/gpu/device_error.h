// A failure of Vulkan as an Error.
#pragma once

#include "engine/error.h"

#include <string>
#include <vulkan/vulkan.hpp>

namespace binosplat {

// Lack of memory is the input's fault (exit code 1), anything else the device's (3).
class DeviceError : public Error {
public:
    enum class Kind { kMemory, kLost, kOther };
    DeviceError(Kind kind, const std::string& message)
        : Error(kind == Kind::kMemory ? ExitCode::kBadInput : ExitCode::kNoDevice, message), kind_(kind) {}
    [[nodiscard]] Kind kind() const { return kind_; }

private:
    Kind kind_;
};

// `device` is its name.
DeviceError deviceError(const std::string& device, const vk::SystemError& error);

}  // namespace binosplat
