// Reading and writing the file. Drivers need not survive wrong bytes, so that they are checked first.
#include "engine/gpu/pipeline_cache.h"

#include "engine/scene/part_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

namespace binosplat {
namespace {

// FNV-1a, 64 bits (Fowler, Noll and Vo).
std::uint64_t checksumOf(std::span<const std::uint8_t> bytes) {
    std::uint64_t sum = 0xcbf29ce484222325u;
    for (const std::uint8_t byte : bytes) { sum = (sum ^ byte) * 0x100000001b3u; }
    return sum;
}

using Sum = std::array<std::uint8_t, sizeof(std::uint64_t)>;

}  // namespace

std::filesystem::path pipelineCacheFolder() {
    const auto textOf = [](const char* name) {
        const char* value = std::getenv(name);
        return std::string(value != nullptr ? value : "");
    };
    const std::string chosen = textOf("BINOSPLAT_PIPELINE_CACHE");
    if (!chosen.empty()) { return chosen == "0" ? std::filesystem::path() : std::filesystem::path(chosen); }
    const std::filesystem::path cache = textOf("XDG_CACHE_HOME"), home = textOf("HOME");
    if (cache.is_absolute()) { return cache / "binosplat"; }
    return home.is_absolute() ? home / ".cache" / "binosplat" : std::filesystem::path();
}

std::filesystem::path pipelineCacheFile(const vk::raii::PhysicalDevice& device) {
    const std::filesystem::path folder = pipelineCacheFolder();
    if (folder.empty()) { return {}; }
    const auto properties = device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties>();
    std::string name;
    for (const std::uint8_t byte : properties.get<vk::PhysicalDeviceIDProperties>().deviceUUID) { name += fmt::format("{:02x}", byte); }
    const std::uint32_t driver = properties.get<vk::PhysicalDeviceProperties2>().properties.driverVersion;
    return folder / fmt::format("{}-{:08x}.pipelines", name, driver);
}

std::vector<std::uint8_t> sealPipelineCache(const std::vector<std::uint8_t>& data) {
    std::vector<std::uint8_t> file = data;
    const auto sum = std::bit_cast<Sum>(checksumOf(data));
    file.insert(file.end(), sum.begin(), sum.end());
    return file;
}

std::vector<std::uint8_t> unsealPipelineCache(const std::vector<std::uint8_t>& file, const vk::PhysicalDeviceProperties& device) {
    VkPipelineCacheHeaderVersionOne header;
    if (file.size() < sizeof(header) + sizeof(Sum)) { return {}; }
    Sum sum;
    std::memcpy(sum.data(), &*(file.end() - sizeof(Sum)), sizeof(Sum));
    std::vector<std::uint8_t> data(file.begin(), file.end() - sizeof(Sum));
    std::memcpy(&header, data.data(), sizeof(header));
    const bool ours = header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE && header.vendorID == device.vendorID &&
                      header.deviceID == device.deviceID && std::ranges::equal(header.pipelineCacheUUID, device.pipelineCacheUUID);
    if (!ours || sum != std::bit_cast<Sum>(checksumOf(data))) { return {}; }
    return data;
}

PipelineCache::PipelineCache(const vk::raii::PhysicalDevice& physical_device, const vk::raii::Device& device) {
    file_ = pipelineCacheFile(physical_device);
    if (!file_.empty()) {
        std::ifstream stream(file_, std::ios::binary);
        loaded_ = unsealPipelineCache({std::istreambuf_iterator<char>(stream), {}}, physical_device.getProperties());
    }
    cache_ = vk::raii::PipelineCache(device, vk::PipelineCacheCreateInfo({}, loaded_.size(), loaded_.data()));
}

void PipelineCache::save() const noexcept {
    if (file_.empty() || !*cache_) { return; }
    try {
        const std::vector<std::uint8_t> data = cache_.getData();
        if (data == loaded_ || data.size() <= sizeof(VkPipelineCacheHeaderVersionOne)) { return; }
        std::filesystem::create_directories(file_.parent_path());
        const std::vector<std::uint8_t> sealed = sealPipelineCache(data);
        PartFile file(file_.string());
        file.write(sealed.data(), sealed.size());
        file.commit();
    } catch (const std::exception&) {}
}

}  // namespace binosplat
