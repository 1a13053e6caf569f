// The operating system's services for this runtime: system_posix.cpp or system_windows.cpp. Texts are UTF-8.
#pragma once

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

namespace simulated {

std::optional<std::string> readEnvironmentVariable(const std::string& name);

// Creates a file for writing. Null, with the reason in errno, if that fails or anything has that name.
std::FILE* createFile(const std::filesystem::path& path);

// A function of the system's Vulkan loader; null without it. The library is kept open for good: the
// application's Vulkan objects may outlive this runtime's use of them.
void* findVulkanFunction(const char* name);
// The name of that loader in messages.
extern const char* const kVulkanLoader;

// Keeps this library loaded: its state must outlive the instance, though the loader closes the library with
// it.
void keepThisLibrary();

}  // namespace simulated
