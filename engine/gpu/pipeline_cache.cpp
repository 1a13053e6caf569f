// Reads and writes the file. Drivers may not survive wrong bytes, so these are checked first.
#include "engine/gpu/pipeline_cache.h"

#include "engine/part_file.h"
#include "engine/platform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <optional>
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

// Empty if there is no such file, or one too long for any driver to have made.
std::vector<std::uint8_t> readWhole(const std::filesystem::path& path) {
    constexpr std::uint64_t kMostBytes = std::uint64_t{256} << 20;
    std::string reason;
    const File file = openRegularFile(path, reason);
    const std::optional<FileStamp> stamp = file ? stampOf(file.get()) : std::nullopt;
    if (!stamp || stamp->size_bytes > kMostBytes) { return {}; }
    std::vector<std::uint8_t> bytes(stamp->size_bytes);
    bytes.resize(std::fread(bytes.data(), 1, bytes.size(), file.get()));
    return bytes;
}

using Sum = std::array<std::uint8_t, sizeof(std::uint64_t)>;

}  // namespace

std::filesystem::path pipelineCacheFolder() {
    const std::string chosen = environment("BINOSPLAT_PIPELINE_CACHE");
    if (!chosen.empty()) { return chosen == "0" ? std::filesystem::path() : std::filesystem::path(chosen); }
    const std::filesystem::path cache = userCacheFolder();
    return cache.empty() ? cache : cache / "binosplat";
}

std::filesystem::path pipelineCacheFile(const vk::raii::PhysicalDevice& device) {
    const std::filesystem::path folder = pipelineCacheFolder();
    if (folder.empty()) { return {}; }
    const auto properties =
        device.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceIDProperties>();
    std::string name;
    for (const std::uint8_t byte : properties.get<vk::PhysicalDeviceIDProperties>().deviceUUID) {
        name += fmt::format("{:02x}", byte);
    }
    const std::uint32_t driver = properties.get<vk::PhysicalDeviceProperties2>().properties.driverVersion;
    return folder / fmt::format("{}-{:08x}.pipelines", name, driver);
}

std::vector<std::uint8_t> sealPipelineCache(const std::vector<std::uint8_t>& data) {
    std::vector<std::uint8_t> file = data;
    const auto sum = std::bit_cast<Sum>(checksumOf(data));
    file.insert(file.end(), sum.begin(), sum.end());
    return file;
}

std::vector<std::uint8_t> unsealPipelineCache(const std::vector<std::uint8_t>& file,
                                              const vk::PhysicalDeviceProperties& device) {
    VkPipelineCacheHeaderVersionOne header;
    if (file.size() < sizeof(header) + sizeof(Sum)) { return {}; }
    Sum sum;
    std::memcpy(sum.data(), &*(file.end() - sizeof(Sum)), sizeof(Sum));
    std::vector<std::uint8_t> data(file.begin(), file.end() - sizeof(Sum));
    std::memcpy(&header, data.data(), sizeof(header));
    const bool ours = header.headerVersion == VK_PIPELINE_CACHE_HEADER_VERSION_ONE &&
                      header.vendorID == device.vendorID && header.deviceID == device.deviceID &&
                      std::ranges::equal(header.pipelineCacheUUID, device.pipelineCacheUUID);
    if (!ours || sum != std::bit_cast<Sum>(checksumOf(data))) { return {}; }
    return data;
}

PipelineCache::PipelineCache(const vk::raii::PhysicalDevice& physical_device,
                             const vk::raii::Device& device) {
    file_ = pipelineCacheFile(physical_device);
    if (!file_.empty()) { loaded_ = unsealPipelineCache(readWhole(file_), physical_device.getProperties()); }
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
