// POSIX.
#include <cstdlib>

#include <dlfcn.h>

#include "xr/simulated/system.h"

namespace simulated {

const char* const kVulkanLoader = "libvulkan.so.1";

std::optional<std::string> readEnvironmentVariable(const std::string& name) {
    const char* const value = std::getenv(name.c_str());
    return value != nullptr ? std::optional<std::string>(value) : std::nullopt;
}

std::FILE* createFile(const std::filesystem::path& path) { return std::fopen(path.c_str(), "wbx"); }

void* findVulkanFunction(const char* name) {
    static void* const library = dlopen(kVulkanLoader, RTLD_NOW | RTLD_LOCAL);
    return library != nullptr ? dlsym(library, name) : nullptr;
}

void keepThisLibrary() {}  // the linker flags do it

}  // namespace simulated
