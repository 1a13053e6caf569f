// Facts about what a driver has compiled and the file that keeps it.
#include "engine/gpu/pipeline_cache.h"
#include "engine/gpu/kernel.h"
#include "engine/passes/passes.h"

#include <doctest/doctest.h>
#include <sys/stat.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>

TEST_SUITE_BEGIN("pipeline_cache");

namespace pipeline_cache_test {

using namespace binosplat;
namespace fs = std::filesystem;

namespace {

using Bytes = std::vector<std::uint8_t>;

vk::PhysicalDeviceProperties someDevice() {
    vk::PhysicalDeviceProperties device;
    device.vendorID = 0x1234;
    device.deviceID = 7;
    for (std::size_t i = 0; i < VK_UUID_SIZE; ++i) { device.pipelineCacheUUID[i] = static_cast<std::uint8_t>(i + 1); }
    return device;
}

// As a driver of that device would give it.
Bytes someData(const vk::PhysicalDeviceProperties& device) {
    VkPipelineCacheHeaderVersionOne header{};
    header.headerSize = sizeof(header);
    header.headerVersion = VK_PIPELINE_CACHE_HEADER_VERSION_ONE;
    header.vendorID = device.vendorID;
    header.deviceID = device.deviceID;
    std::memcpy(header.pipelineCacheUUID, device.pipelineCacheUUID.data(), VK_UUID_SIZE);
    Bytes data(1000, 42);
    std::memcpy(data.data(), &header, sizeof(header));
    return data;
}

struct Environment {
    Environment(const char* variable, const std::string& value) : name(variable) {
        const char* now = std::getenv(variable);
        before = now != nullptr ? now : "";
        setenv(variable, value.c_str(), 1);
    }
    ~Environment() { setenv(name, before.c_str(), 1); }
    const char* name;
    std::string before;
};

}  // namespace

TEST_CASE("what is kept comes back") {
    const auto device = someDevice();
    CHECK(unsealPipelineCache(sealPipelineCache(someData(device)), device) == someData(device));
}

TEST_CASE("a file that is cut off, changed or another device's is as good as none") {
    const auto device = someDevice();
    const Bytes file = sealPipelineCache(someData(device));
    for (const std::size_t bytes : {std::size_t{0}, std::size_t{1}, std::size_t{31}, std::size_t{40}, file.size() - 1}) {
        CHECK(unsealPipelineCache(Bytes(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(bytes)), device).empty());
    }
    for (const std::size_t at : {std::size_t{0}, std::size_t{500}, file.size() - 1}) {
        Bytes changed = file;
        changed[at] ^= 1;
        CHECK(unsealPipelineCache(changed, device).empty());
    }
    auto other = device;
    other.deviceID = 8;
    CHECK(unsealPipelineCache(file, other).empty());
    other = device;
    other.pipelineCacheUUID[3] ^= 1;
    CHECK(unsealPipelineCache(file, other).empty());
}

TEST_CASE("the environment says where it is kept") {
    const Environment home("HOME", "/home/somebody");
    const Environment cache("XDG_CACHE_HOME", "");
    const Environment chosen("BINOSPLAT_PIPELINE_CACHE", "");
    CHECK(pipelineCacheFolder() == "/home/somebody/.cache/binosplat");
    setenv("XDG_CACHE_HOME", "/var/cache/x", 1);
    CHECK(pipelineCacheFolder() == "/var/cache/x/binosplat");
    setenv("BINOSPLAT_PIPELINE_CACHE", "/tmp/mine", 1);
    CHECK(pipelineCacheFolder() == "/tmp/mine");
    setenv("BINOSPLAT_PIPELINE_CACHE", "0", 1);
    CHECK(pipelineCacheFolder().empty());
    // Relative paths are nobody's, says the XDG base directory specification.
    setenv("BINOSPLAT_PIPELINE_CACHE", "", 1);
    setenv("XDG_CACHE_HOME", "here", 1);
    setenv("HOME", "", 1);
    CHECK(pipelineCacheFolder().empty());
}

TEST_CASE("a folder that cannot be written, a file of rubbish and a pipe trouble nobody") {
    std::string name = (fs::temp_directory_path() / "binosplat-cache-XXXXXX").string();
    const fs::path folder = mkdtemp(name.data());
    {
        const Environment chosen("BINOSPLAT_PIPELINE_CACHE", folder.string());
        const Context context({.device = {}, .validation = true});
        std::ofstream(pipelineCacheFile(context.physicalDevice())) << std::string(5000, 'x');
    }
    const fs::path pipe_folder = folder / "pipes";
    {
        const Environment chosen("BINOSPLAT_PIPELINE_CACHE", pipe_folder.string());
        fs::create_directory(pipe_folder);
        const Context context({.device = {}, .validation = true});
        REQUIRE(::mkfifo(pipelineCacheFile(context.physicalDevice()).c_str(), 0600) == 0);
    }
    for (const fs::path& place : {fs::path("/proc/nowhere"), folder, pipe_folder}) {
        const Environment chosen("BINOSPLAT_PIPELINE_CACHE", place.string());
        for (int run = 0; run < 2; ++run) {
            const Context context({.device = {}, .validation = true});
            const Kernel kernel(context, passKernels(context).front());
            CHECK(kernel.pipeline());
            CHECK(context.validationMessages().empty());
        }
    }
    for (const auto& entry : fs::directory_iterator(pipe_folder)) { CHECK(entry.is_fifo()); }
    fs::remove_all(pipe_folder);
    for (const auto& entry : fs::directory_iterator(folder)) { CHECK(entry.path().extension() == ".pipelines"); }
    fs::remove_all(folder);
}

}  // namespace pipeline_cache_test
