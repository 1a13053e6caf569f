// The driver's compiled kernels, kept from one run to the next in a file for each device and driver.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>
#include <vulkan/vulkan_raii.hpp>

namespace binosplat {

class PipelineCache {
public:
    // Without a file; it then serves only this run.
    PipelineCache() = default;
    // Starts with the file's contents, if they are intact and from this device and driver.
    PipelineCache(const vk::raii::PhysicalDevice& physical_device, const vk::raii::Device& device);

    [[nodiscard]] const vk::raii::PipelineCache& handle() const { return cache_; }
    // Writes the file if there is something new, either completely or not at all. Failures are silent: the
    // next run compiles again.
    void save() const noexcept;

private:
    std::filesystem::path file_;
    std::vector<std::uint8_t> loaded_;
    vk::raii::PipelineCache cache_{nullptr};
};

// The folder named by BINOSPLAT_PIPELINE_CACHE, or none if that is 0; if it is not set, binosplat/ in the
// user's cache folder.
std::filesystem::path pipelineCacheFolder();
// The file in that folder; empty if there is no folder.
std::filesystem::path pipelineCacheFile(const vk::raii::PhysicalDevice& device);

// A cache's bytes as stored in a file, and back: empty if they were cut off, changed, or made by another
// device or driver.
std::vector<std::uint8_t> sealPipelineCache(const std::vector<std::uint8_t>& data);
std::vector<std::uint8_t> unsealPipelineCache(const std::vector<std::uint8_t>& file,
                                              const vk::PhysicalDeviceProperties& device);

}  // namespace binosplat
