// The operating system's services: platform_posix.cpp uses POSIX, platform_windows.cpp uses Windows. Nothing
// else in engine/, app/ and xr/ includes a system's headers, except the simulated runtime (for dlopen).
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

struct FileCloser {
    void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileCloser>;

// The running program's file; empty if the system does not say.
std::filesystem::path programFile();

// An environment variable; empty if it is not set. Values are UTF-8.
std::string environment(const char* name);
void setEnvironment(const char* name, const std::string& value);

// The user's own folder; empty if there is none.
std::filesystem::path userHomeFolder();
// Where paths begin: /, or the drives.
std::vector<std::filesystem::path> fileSystemRoots();

// Where programs keep what they can make again, and the user's choices; empty if the user has no such folder.
std::filesystem::path userCacheFolder();
std::filesystem::path userConfigFolder();
// Where the user's pictures are kept; it need not exist, and is empty if the user has no such place.
std::filesystem::path userPicturesFolder();

bool isTerminal(std::FILE* stream);

// The arguments of `main`, as UTF-8.
std::vector<std::string> programArguments(int count, const char* const* arguments);

// True if the program was started by a click, in a console of its own that closes when it ends.
bool isStartedByClick();
// Writes a line to standard error, and also shows it in a window if a click started the program.
void tellUser(const std::string& line);

// True if the program has rights over the whole machine, and must not trust its user's environment.
bool runsAsAdministrator();

// Raises SIGTERM if the system tells the program to end in other ways than by signals: the console is closed,
// or the user logs off. The system then waits some seconds for the program.
void watchForEnd();

// Advice for machines on which Vulkan finds no device.
extern const char* const kVulkanHint;

// True if there may be a window.
bool hasDisplay();
// Where the system keeps fonts with Latin, Greek and Cyrillic letters, and fonts with all others; the best
// first. They need not exist.
std::vector<std::filesystem::path> systemFonts();
std::vector<std::filesystem::path> furtherSystemFonts();

std::uint64_t processId();
// The calling thread's processor time.
double threadSeconds();

// From here on, a write beyond the limit of file sizes fails like one to a full disk, instead of ending the
// program.
void letLongWritesFail();

// Runs a program, found as a shell would find it, with its output going to the new file `log`; returns true
// if its exit status was 0. It is ended once `ends` says so, if that is given. Throws Error if it cannot be
// started.
bool runProgram(const std::vector<std::string>& words, const std::filesystem::path& log,
                const std::function<bool()>& ends = {});

// A function of a library that need not be installed, which stays loaded; null if it is missing.
void* functionOf(const char* library, const char* function);

// Opens a file on a disk for reading, without ever waiting. For anything else (a pipe, a device, a folder)
// returns null and the reason in a few words.
File openRegularFile(const std::filesystem::path& path, std::string& reason);

// Makes a new file for writing. Null, with the reason in errno (EEXIST), if anything has that name, even a
// dangling link.
File createFile(const std::filesystem::path& path);

// Makes a new folder in `parent` that others cannot enter, named `prefix` plus something random. Empty, with
// the reason in errno, if that fails.
std::filesystem::path createFolder(const std::filesystem::path& parent, const std::string& prefix);

// If a folder's files are kept in memory (tmpfs): the total memory, and how much of it is available. Empty
// for a disk.
std::optional<std::filesystem::space_info> memoryBehind(const std::filesystem::path& folder);

// A stamp that changes when a file is written to.
struct FileStamp {
    std::uint64_t size_bytes = 0;
    std::int64_t changed_s = 0, changed_ns = 0;
    bool operator==(const FileStamp&) const = default;
};
// Empty, with the reason in errno, if the system does not say.
std::optional<FileStamp> stampOf(std::FILE* file);

// Bytes from anywhere in a file, wherever it is being read; fewer at its end. Empty, with the reason in
// errno, if reading fails. Any thread may call it.
std::optional<std::size_t> readAt(std::FILE* file, std::uint64_t offset, std::span<std::byte> target);

// Advises the system that all of this fresh memory will be used: large pages, if available, save a third of
// the time that it takes to fill it.
void preferLargePages(void* begin, std::size_t bytes);

}  // namespace binosplat
