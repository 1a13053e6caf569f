// Facts about what a driver has compiled, and about the file in which it is kept.
#include "engine/passes/passes.h"
#include "tests/engine/gpu/gpu_fixture.h"
#include "tests/run_program.h"

#include <sys/stat.h>

SUITE(pipeline_cache) {

using Bytes = std::vector<std::uint8_t>;

vk::PhysicalDeviceProperties someDevice() {
    vk::PhysicalDeviceProperties device;
    device.vendorID = 0x1234;
    device.deviceID = 7;
    std::iota(device.pipelineCacheUUID.begin(), device.pipelineCacheUUID.end(), std::uint8_t{1});
    return device;
}

// As a driver of that device would return it.
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

// An environment variable for the lifetime of this object.
struct Environment {
    Environment(const char* variable, const std::string& value)
        : name(variable), before(environment(variable)) {
        setEnvironment(name, value);
    }
    Environment(const Environment&) = delete;
    Environment& operator=(const Environment&) = delete;
    ~Environment() { setEnvironment(name, before); }
    const char* name;
    std::string before;
};

TEST_CASE("what is kept comes back; a file that is cut off, changed or another device's is as good as none") {
    const auto device = someDevice();
    const Bytes file = sealPipelineCache(someData(device));
    CHECK(unsealPipelineCache(file, device) == someData(device));
    for (const std::size_t bytes :
         {std::size_t{0}, std::size_t{1}, std::size_t{31}, std::size_t{40}, file.size() - 1}) {
        Bytes cut = file;
        cut.resize(bytes);
        CHECK(unsealPipelineCache(cut, device).empty());
    }
    for (const std::size_t at : {std::size_t{0}, std::size_t{500}, file.size() - 1}) {
        Bytes changed = file;
        changed[at] ^= 1;
        CHECK(unsealPipelineCache(changed, device).empty());
    }
    auto newer = device, updated = device;
    newer.deviceID = 8;
    updated.pipelineCacheUUID[3] ^= 1;
    for (const auto& other : {newer, updated}) { CHECK(unsealPipelineCache(file, other).empty()); }
}

TEST_CASE("it is kept in the user's cache folder, or where the environment says") {
    const Environment home("HOME", "/home/somebody"), cache("XDG_CACHE_HOME", "");
    for (const auto& [chosen, folder] :
         {std::pair("", "/home/somebody/.cache/binosplat"), {"/tmp/mine", "/tmp/mine"}, {"0", ""}}) {
        const Environment choice("BINOSPLAT_PIPELINE_CACHE", chosen);
        CHECK(pipelineCacheFolder() == folder);
    }
    const Environment choice("BINOSPLAT_PIPELINE_CACHE", ""), nowhere("HOME", "");
    CHECK(pipelineCacheFolder().empty());
}

TEST_CASE_FIXTURE(AtWork, "a folder that cannot be written, a file of rubbish and a pipe trouble nobody") {
    const fs::path folder = work.path / "rubbish", pipe_folder = work.path / "pipes";
    const auto fileIn = [](const fs::path& place) {
        const Environment chosen("BINOSPLAT_PIPELINE_CACHE", place.string());
        fs::create_directory(place);
        return pipelineCacheFile(Gpu::shared().physicalDevice());
    };
    std::ofstream(fileIn(folder)) << std::string(5000, 'x');
    REQUIRE(::mkfifo(fileIn(pipe_folder).c_str(), 0600) == 0);
    // The garbage is replaced by a file that the second run finds.
    for (const fs::path& place : {fs::path("/proc/nowhere"), pipe_folder, folder, folder}) {
        const Environment chosen("BINOSPLAT_PIPELINE_CACHE", place.string());
        const Context context({.device = {}, .validation = true});
        const Kernel kernel(context, PassKernels(context).table().front());
        CHECK(kernel.pipeline());
        CHECK(context.validationMessages().empty());
    }
    for (const auto& entry : fs::directory_iterator(pipe_folder)) { CHECK(entry.is_fifo()); }
    for (const auto& entry : fs::directory_iterator(folder)) {
        CHECK(entry.path().extension() == ".pipelines");
    }
}

}  // SUITE(pipeline_cache)
