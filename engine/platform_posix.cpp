// POSIX, and Linux where POSIX says nothing.
#include "engine/platform.h"

#include "engine/error.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cinttypes>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>

extern char** environ;

namespace binosplat {

namespace fs = std::filesystem;

// The file that this code is mapped from; empty if the system does not tell.
static fs::path mappedFile() {
    const auto here = reinterpret_cast<std::uintptr_t>(&mappedFile);
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);) {
        std::uintptr_t begin = 0, end = 0;
        int name_at = 0;
        const int read =
            std::sscanf(line.c_str(), "%" SCNxPTR "-%" SCNxPTR " %*s %*s %*s %*s %n", &begin, &end, &name_at);
        if (read == 2 && begin <= here && here < end) {
            return line.substr(static_cast<std::size_t>(name_at));
        }
    }
    return {};
}

fs::path programFile() {
    std::error_code not_told;
    // /proc/self/exe names the dynamic loader if the program was started as `ld-linux.so binosplat`.
    if (fs::path mapped = mappedFile(); mapped.is_absolute() && fs::exists(mapped, not_told)) {
        return mapped;
    }
    return fs::read_symlink("/proc/self/exe", not_told);
}

std::string environment(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr ? value : "";
}

void setEnvironment(const char* name, const std::string& value) { ::setenv(name, value.c_str(), 1); }

fs::path userHomeFolder() {
    const fs::path home = environment("HOME");
    return home.is_absolute() ? home : fs::path();
}

std::vector<fs::path> fileSystemRoots() { return {"/"}; }

// By the XDG base directory specification, which has relative paths ignored.
static fs::path userFolder(const char* variable, const char* at_home) {
    const fs::path chosen = environment(variable), home = userHomeFolder();
    if (chosen.is_absolute()) { return chosen; }
    return home.empty() ? fs::path() : home / at_home;
}

fs::path userCacheFolder() { return userFolder("XDG_CACHE_HOME", ".cache"); }

fs::path userConfigFolder() { return userFolder("XDG_CONFIG_HOME", ".config"); }

// From the lines of xdg-user-dirs: XDG_PICTURES_DIR="$HOME/Pictures".
fs::path userPicturesFolder() {
    const fs::path home = userHomeFolder();
    constexpr std::string_view kBegin = "XDG_PICTURES_DIR=\"", kHome = "$HOME/";
    std::ifstream lines(userConfigFolder() / "user-dirs.dirs");
    for (std::string line; std::getline(lines, line);) {
        const std::size_t end = line.rfind('"');
        if (!line.starts_with(kBegin) || end < kBegin.size()) { continue; }
        const std::string place = line.substr(kBegin.size(), end - kBegin.size());
        if (place.starts_with(kHome) && !home.empty()) { return home / place.substr(kHome.size()); }
        if (place.starts_with('/')) { return place; }
    }
    return home.empty() ? fs::path() : home / "Pictures";
}

bool isTerminal(std::FILE* stream) { return ::isatty(::fileno(stream)) == 1; }

std::vector<std::string> programArguments(int count, const char* const* arguments) {
    return {arguments, arguments + count};
}

bool isStartedByClick() { return false; }

void tellUser(const std::string& line) { fmt::print(stderr, "{}\n", line); }

const char* const kVulkanHint =
    "install a Vulkan driver, e.g. mesa-vulkan-drivers, and look at `vulkaninfo --summary`";

bool runsAsAdministrator() { return ::geteuid() == 0; }

void watchForEnd() {}

bool hasDisplay() { return !environment("DISPLAY").empty() || !environment("WAYLAND_DISPLAY").empty(); }

std::vector<fs::path> systemFonts() {
    std::vector<fs::path> files;
    for (const char* folder : {"truetype/dejavu", "TTF", "dejavu-sans-fonts", "dejavu"}) {
        files.push_back(fs::path("/usr/share/fonts") / folder / "DejaVuSans.ttf");
    }
    return files;
}

std::vector<fs::path> furtherSystemFonts() {
    std::vector<fs::path> files = systemFonts();
    for (const char* file : {"opentype/noto/NotoSansCJK-Regular.ttc", "noto-cjk/NotoSansCJK-Regular.ttc",
                             "google-noto-cjk/NotoSansCJK-Regular.ttc", "truetype/wqy/wqy-microhei.ttc",
                             "truetype/droid/DroidSansFallbackFull.ttf"}) {
        files.push_back(fs::path("/usr/share/fonts") / file);
    }
    return files;
}

std::uint64_t processId() { return static_cast<std::uint64_t>(::getpid()); }

double threadSeconds() {
    timespec worked{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &worked);
    return static_cast<double>(worked.tv_sec) + 1e-9 * static_cast<double>(worked.tv_nsec);
}

void letLongWritesFail() { std::signal(SIGXFSZ, SIG_IGN); }

void* functionOf(const char* library, const char* function) {
    void* const loaded = ::dlopen(library, RTLD_NOW | RTLD_LOCAL);
    return loaded != nullptr ? ::dlsym(loaded, function) : nullptr;
}

bool runProgram(const std::vector<std::string>& words, const fs::path& log,
                const std::function<bool()>& ends) {
    std::vector<std::string> copies = words;  // posix_spawn wants text that may be changed
    std::vector<char*> arguments;
    for (std::string& word : copies) { arguments.push_back(word.data()); }
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_EXCL, 0600);
    posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
    pid_t child = 0;
    const int failed = ::posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    check(failed == 0, "{} cannot be run ({})", words[0], std::strerror(failed));
    int status = 0;
    for (;;) {
        const pid_t ended = ::waitpid(child, &status, ends ? WNOHANG : 0);
        if (ended == child || (ended < 0 && errno != EINTR)) { break; }
        if (ended < 0) { continue; }
        if (ends()) { ::kill(child, SIGTERM); }
        constexpr timespec kBetween{0, 50'000'000};
        ::nanosleep(&kBetween, nullptr);
    }
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

File openRegularFile(const fs::path& path, std::string& reason) {
    // Checked before it is opened, since opening a device may have effects, and again afterwards, since it
    // may be another file by then. O_NONBLOCK: a pipe without a writer would keep us waiting.
    const auto isRegular = [&](int answer, const struct stat& status) {
        if (answer != 0) {
            reason = std::strerror(errno);
        } else if (S_ISDIR(status.st_mode)) {
            reason = "is a directory";
        } else if (!S_ISREG(status.st_mode)) {
            reason = "not a regular file";
        }
        return answer == 0 && S_ISREG(status.st_mode);
    };
    struct stat status {};
    if (!isRegular(::stat(path.c_str(), &status), status)) { return nullptr; }
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (descriptor < 0) {
        reason = std::strerror(errno);
        return nullptr;
    }
    std::FILE* file = isRegular(::fstat(descriptor, &status), status) ? ::fdopen(descriptor, "rb") : nullptr;
    if (file == nullptr) { ::close(descriptor); }
    return File(file);
}

File createFile(const fs::path& path) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor < 0) { return nullptr; }
    std::FILE* file = ::fdopen(descriptor, "wb");
    if (file == nullptr) { ::close(descriptor); }
    return File(file);
}

fs::path createFolder(const fs::path& parent, const std::string& prefix) {
    std::string name = (parent / (prefix + "XXXXXX")).string();
    return ::mkdtemp(name.data()) != nullptr ? fs::path(name) : fs::path();
}

std::optional<fs::space_info> memoryBehind(const fs::path& folder) {
    constexpr std::array<unsigned, 2> kKeptInMemory{0x01021994, 0x858458f6};  // tmpfs, ramfs
    struct statfs disk {};
    if (::statfs(folder.c_str(), &disk) != 0 ||
        std::ranges::find(kKeptInMemory, static_cast<unsigned>(disk.f_type)) == kKeptInMemory.end()) {
        return std::nullopt;
    }
    std::uintmax_t total_kib = 0, available_kib = 0;
    std::ifstream memory("/proc/meminfo");
    for (std::string line; std::getline(memory, line);) {
        std::sscanf(line.c_str(), "MemTotal: %ju", &total_kib);
        std::sscanf(line.c_str(), "MemAvailable: %ju", &available_kib);
    }
    if (total_kib == 0) { return std::nullopt; }
    return fs::space_info{total_kib << 10, available_kib << 10, available_kib << 10};
}

std::optional<FileStamp> stampOf(std::FILE* file) {
    struct stat status {};
    if (::fstat(::fileno(file), &status) != 0) { return std::nullopt; }
    return FileStamp{static_cast<std::uint64_t>(status.st_size), status.st_mtim.tv_sec,
                     status.st_mtim.tv_nsec};
}

std::optional<std::size_t> readAt(std::FILE* file, std::uint64_t offset, std::span<std::byte> target) {
    const ssize_t got = ::pread(::fileno(file), target.data(), target.size(), static_cast<off_t>(offset));
    return got >= 0 ? std::optional(static_cast<std::size_t>(got)) : std::nullopt;
}

void preferLargePages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#ifdef MADV_HUGEPAGE
    constexpr std::uintptr_t kPage = std::uintptr_t{1} << 21;
    const auto first_byte = reinterpret_cast<std::uintptr_t>(begin), end = first_byte + bytes;
    const std::uintptr_t first = (first_byte + kPage - 1) / kPage * kPage, last = end / kPage * kPage;
    // advice: failing is fine
    if (first < last) { ::madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE); }
#endif
}

}  // namespace binosplat
