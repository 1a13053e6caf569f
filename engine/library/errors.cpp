// Codes and texts of failures.
#include "engine/library/errors.h"

#include "engine/gpu/device_error.h"

#include <new>

namespace binosplat {
namespace {

thread_local std::string last_text;

bsp_result codeOf(const vk::SystemError& error) {
    switch (static_cast<vk::Result>(error.code().value())) {
        case vk::Result::eErrorOutOfDeviceMemory:
        case vk::Result::eErrorOutOfHostMemory:
            return BSP_ERROR_OUT_OF_MEMORY;
        case vk::Result::eErrorDeviceLost:
            return BSP_ERROR_DEVICE_LOST;
        default:
            return BSP_ERROR_NO_DEVICE;
    }
}

}  // namespace

Failure failureNow() noexcept {
    try {
        throw;
    } catch (const Cancelled&) {
        return {BSP_ERROR_CANCELLED, "cancelled"};
    } catch (const DeviceError& error) {
        using Kind = DeviceError::Kind;
        return {error.kind() == Kind::kLost     ? BSP_ERROR_DEVICE_LOST
                : error.kind() == Kind::kMemory ? BSP_ERROR_OUT_OF_MEMORY
                                                : BSP_ERROR_NO_DEVICE,
                error.what()};
    } catch (const Error& error) {
        return {error.code() == ExitCode::kNoDevice ? BSP_ERROR_NO_DEVICE : BSP_ERROR_INPUT, error.what()};
    } catch (const vk::SystemError& error) {
        return {codeOf(error), std::string("Vulkan: ") + error.what()};
    } catch (const std::bad_alloc&) {
        return {BSP_ERROR_OUT_OF_MEMORY, "not enough memory on this machine"};
    } catch (const std::exception& error) { return {BSP_ERROR_INPUT, error.what()}; } catch (...) {
        return {BSP_ERROR_INPUT, "failed for an unknown reason"};
    }
}

bsp_result report(const Failure& failure) noexcept {
    try {
        last_text = failure.text;
    } catch (...) { last_text.clear(); }
    return failure.code;
}

}  // namespace binosplat

const char* bsp_error_text(void) { return binosplat::last_text.c_str(); }
