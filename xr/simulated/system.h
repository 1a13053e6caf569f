// What only the operating system can say or do for this runtime: system_posix.cpp or system_windows.cpp. Texts are UTF-8.
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

namespace simulated {

std::optional<std::string> environmentVariable(const std::string& name);

// A file that was not there, for writing. Null, with the reason in errno, if anything has that name.
std::FILE* createFile(const std::filesystem::path& path);

// A function of the system's Vulkan loader; null without it. The library is held open for good: the application's Vulkan objects may
// outlive this runtime's interest in them.
void* vulkanLoadersFunction(const char* name);
// What messages call that loader.
extern const char* const kVulkanLoader;

// What happened must outlive the instance that it happened to, though the loader closes this library with it.
void keepThisLibrary();

}  // namespace simulated
