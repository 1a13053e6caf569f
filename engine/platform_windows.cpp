// Windows. Texts of the program are UTF-8, those of the system UTF-16.
#include "engine/platform.h"

#include "engine/error.h"

#include <windows.h>

#include <shellapi.h>
#include <shlobj.h>

#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <random>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

std::wstring wide(const std::string& text) {
    const int length = static_cast<int>(text.size());
    std::wstring result(
        static_cast<std::size_t>(::MultiByteToWideChar(CP_UTF8, 0, text.data(), length, nullptr, 0)), L'\0');
    ::MultiByteToWideChar(CP_UTF8, 0, text.data(), length, result.data(), static_cast<int>(result.size()));
    return result;
}

std::string narrow(const std::wstring& text) {
    const int length = static_cast<int>(text.size());
    std::string result(static_cast<std::size_t>(::WideCharToMultiByte(CP_UTF8, 0, text.data(), length,
                                                                      nullptr, 0, nullptr, nullptr)),
                       '\0');
    ::WideCharToMultiByte(CP_UTF8, 0, text.data(), length, result.data(), static_cast<int>(result.size()),
                          nullptr, nullptr);
    return result;
}

HANDLE handleOf(std::FILE* file) { return reinterpret_cast<HANDLE>(::_get_osfhandle(::_fileno(file))); }

struct HandleCloser {
    using pointer = HANDLE;
    void operator()(HANDLE handle) const { ::CloseHandle(handle); }
};
using Handle = std::unique_ptr<HANDLE, HandleCloser>;

// As CommandLineToArgvW takes it apart again: quotes around it, backslashes doubled before quotes.
std::wstring quoted(const std::wstring& word) {
    std::wstring result = L"\"";
    std::size_t backslashes = 0;
    for (const wchar_t letter : word) {
        if (letter == L'"') { result.append(backslashes + 1, L'\\'); }
        backslashes = letter == L'\\' ? backslashes + 1 : 0;
        result += letter;
    }
    return result.append(backslashes, L'\\') + L'"';
}

}  // namespace

fs::path programFile() {
    std::wstring name(32768, L'\0');  // the longest there is
    name.resize(::GetModuleFileNameW(nullptr, name.data(), static_cast<DWORD>(name.size())));
    return name;
}

std::string environment(const char* name) {
    const wchar_t* value = ::_wgetenv(wide(name).c_str());
    return value != nullptr ? narrow(value) : "";
}

void setEnvironment(const char* name, const std::string& value) {
    ::_wputenv_s(wide(name).c_str(), wide(value).c_str());
}

static fs::path userFolder(const char* variable) {
    const fs::path folder = wide(environment(variable));
    return folder.is_absolute() ? folder : fs::path();
}

fs::path userHomeFolder() { return userFolder("USERPROFILE"); }

std::vector<fs::path> fileSystemRoots() {
    std::vector<fs::path> drives;
    const DWORD there = ::GetLogicalDrives();  // a bit for each, from A on
    for (int letter = 0; letter < 26; ++letter) {
        if ((there >> letter & 1) != 0) {
            drives.emplace_back(fmt::format("{}:\\", static_cast<char>('A' + letter)));
        }
    }
    return drives;
}

fs::path userCacheFolder() { return userFolder("LOCALAPPDATA"); }

fs::path userConfigFolder() { return userFolder("APPDATA"); }

fs::path userPicturesFolder() {
    std::array<wchar_t, MAX_PATH> folder{};
    if (::SHGetFolderPathW(nullptr, CSIDL_MYPICTURES, nullptr, SHGFP_TYPE_CURRENT, folder.data()) == S_OK) {
        return folder.data();
    }
    const fs::path home = userHomeFolder();
    return home.empty() ? fs::path() : home / "Pictures";
}

// One that understands how a line is cleared; older ones must be asked to.
bool isTerminal(std::FILE* stream) {
    DWORD mode = 0;
    return ::_isatty(::_fileno(stream)) != 0 && ::GetConsoleMode(handleOf(stream), &mode) != 0 &&
           ::SetConsoleMode(handleOf(stream), mode | ENABLE_VIRTUAL_TERMINAL_PROCESSING) != 0;
}

std::vector<std::string> programArguments(int count, const char* const* arguments) {
    // Those of `main` are in the code page of the system, which may lack their letters.
    int words = 0;
    wchar_t** const split = ::CommandLineToArgvW(::GetCommandLineW(), &words);
    if (split == nullptr) { return {arguments, arguments + count}; }
    std::vector<std::string> result(static_cast<std::size_t>(words));
    std::transform(split, split + words, result.begin(), narrow);
    ::LocalFree(split);
    return result;
}

bool isStartedByClick() {
    std::array<DWORD, 2> others{};  // in the console
    return ::GetConsoleProcessList(others.data(), static_cast<DWORD>(others.size())) == 1 &&
           isTerminal(stderr);
}

void tellUser(const std::string& line) {
    fmt::print(stderr, "{}\n", line);
    if (isStartedByClick()) {
        ::MessageBoxW(nullptr, wide(line).c_str(), L"binosplat", MB_OK | MB_ICONERROR | MB_SETFOREGROUND);
    }
}

const char* const kVulkanHint =
    "install the newest driver of the graphics card from its maker (NVIDIA, AMD, Intel): Vulkan comes with "
    "it";

bool runsAsAdministrator() { return ::IsUserAnAdmin() != 0; }

void watchForEnd() {
    ::SetConsoleCtrlHandler(
        [](DWORD event) -> BOOL {
            if (event == CTRL_C_EVENT || event == CTRL_BREAK_EVENT) { return FALSE; }  // a signal
            (void)std::raise(SIGTERM);
            ::Sleep(INFINITE);  // the process ends as soon as this returns
            return TRUE;
        },
        TRUE);
}

bool hasDisplay() { return true; }

static std::vector<fs::path> fontFiles(std::initializer_list<const char*> names) {
    const fs::path folder = fs::path(wide(environment("WINDIR"))) / "Fonts";
    std::vector<fs::path> files;
    for (const char* name : names) { files.push_back(folder / name); }
    return files;
}

std::vector<fs::path> systemFonts() {
    return fontFiles({"segoeui.ttf", "arial.ttf", "tahoma.ttf", "DejaVuSans.ttf"});
}

std::vector<fs::path> furtherSystemFonts() {
    return fontFiles({"segoeui.ttf", "seguisym.ttf", "msyh.ttc", "YuGothM.ttc", "meiryo.ttc", "malgun.ttf",
                      "msgothic.ttc", "simsun.ttc", "arial.ttf"});
}

std::uint64_t processId() { return ::GetCurrentProcessId(); }

double threadSeconds() {
    FILETIME created{}, ended{}, kernel{}, user{};
    ::GetThreadTimes(::GetCurrentThread(), &created, &ended, &kernel, &user);
    const auto steps = [](const FILETIME& time) {
        return static_cast<double>(time.dwHighDateTime) * 4294967296.0 + time.dwLowDateTime;
    };
    return 1e-7 * (steps(kernel) + steps(user));
}

void letLongWritesFail() {}  // they do

void* functionOf(const char*, const char*) { return nullptr; }

bool runProgram(const std::vector<std::string>& words, const fs::path& log,
                const std::function<bool()>& ends) {
    std::wstring line;
    for (const std::string& word : words) { line += (line.empty() ? L"" : L" ") + quoted(wide(word)); }
    SECURITY_ATTRIBUTES inherited{sizeof(SECURITY_ATTRIBUTES), nullptr, TRUE};
    const HANDLE made = ::CreateFileW(log.c_str(), GENERIC_WRITE, FILE_SHARE_READ, &inherited, CREATE_NEW,
                                      FILE_ATTRIBUTE_NORMAL, nullptr);
    check(made != INVALID_HANDLE_VALUE, "{} cannot be run (error {} of {})", words[0], ::GetLastError(),
          log.string());
    const Handle output(made);
    STARTUPINFOW start{};
    start.cb = sizeof(start);
    start.dwFlags = STARTF_USESTDHANDLES;
    start.hStdOutput = start.hStdError = output.get();
    PROCESS_INFORMATION process{};
    const BOOL started = ::CreateProcessW(nullptr, line.data(), nullptr, nullptr, TRUE, CREATE_NO_WINDOW,
                                          nullptr, nullptr, &start, &process);
    check(started != 0, "{} cannot be run (error {})", words[0], ::GetLastError());
    const Handle running(process.hProcess), thread(process.hThread);
    DWORD code = 1;
    while (::WaitForSingleObject(running.get(), ends ? 50 : INFINITE) == WAIT_TIMEOUT) {
        if (ends()) { ::TerminateProcess(running.get(), 1); }
    }
    return ::GetExitCodeProcess(running.get(), &code) != 0 && code == 0;
}

File openRegularFile(const fs::path& path, std::string& reason) {
    const DWORD attributes = ::GetFileAttributesW(path.c_str());
    if (attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0) {
        reason = "is a directory";
        return nullptr;
    }
    int descriptor = -1;
    const errno_t failed = ::_wsopen_s(&descriptor, path.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT,
                                       _SH_DENYNO, _S_IREAD | _S_IWRITE);
    if (failed != 0) {
        reason = std::strerror(failed);
        return nullptr;
    }
    if (::GetFileType(reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor))) != FILE_TYPE_DISK) {
        ::_close(descriptor);
        reason = "not a regular file";
        return nullptr;
    }
    return File(::_fdopen(descriptor, "rb"));
}

File createFile(const fs::path& path) {
    int descriptor = -1;
    errno = ::_wsopen_s(&descriptor, path.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT,
                        _SH_DENYNO, _S_IREAD | _S_IWRITE);
    return descriptor >= 0 ? File(::_fdopen(descriptor, "wb")) : nullptr;
}

// Who may enter it is what the parent says: a user's folder for temporary files is the user's alone.
fs::path createFolder(const fs::path& parent, const std::string& prefix) {
    std::random_device random;
    for (int attempt = 0; attempt < 100; ++attempt) {
        const fs::path folder = parent / wide(fmt::format("{}{:08x}", prefix, random()));
        if (::CreateDirectoryW(folder.c_str(), nullptr) != 0) { return folder; }
        const DWORD error = ::GetLastError();
        errno = error == ERROR_ALREADY_EXISTS ? EEXIST : error == ERROR_PATH_NOT_FOUND ? ENOENT : EACCES;
        if (errno != EEXIST) { break; }
    }
    return {};
}

std::optional<fs::space_info> memoryBehind(const fs::path&) { return std::nullopt; }

std::optional<FileStamp> stampOf(std::FILE* file) {
    BY_HANDLE_FILE_INFORMATION status{};
    if (::GetFileInformationByHandle(handleOf(file), &status) == 0) {
        errno = EIO;
        return std::nullopt;
    }
    // In ticks of 100 ns.
    const auto ticks = static_cast<std::int64_t>(std::uint64_t{status.ftLastWriteTime.dwHighDateTime} << 32 |
                                                 status.ftLastWriteTime.dwLowDateTime);
    return FileStamp{std::uint64_t{status.nFileSizeHigh} << 32 | status.nFileSizeLow, ticks / 10'000'000,
                     ticks % 10'000'000 * 100};
}

std::optional<std::size_t> readAt(std::FILE* file, std::uint64_t offset, std::span<std::byte> target) {
    // A handle of its own, since reading at a place moves the handle that is used for it.
    const HANDLE opened =
        ::ReOpenFile(handleOf(file), GENERIC_READ, FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE, 0);
    if (opened == INVALID_HANDLE_VALUE) {
        errno = EIO;
        return std::nullopt;
    }
    const Handle own(opened);
    std::size_t done = 0;
    while (done < target.size()) {
        OVERLAPPED place{};
        place.Offset = static_cast<DWORD>(offset + done);
        place.OffsetHigh = static_cast<DWORD>((offset + done) >> 32);
        const auto wanted =
            static_cast<DWORD>(std::min<std::size_t>(target.size() - done, std::size_t{1} << 30));
        DWORD got = 0;
        const BOOL read = ::ReadFile(own.get(), target.data() + done, wanted, &got, &place);
        if (read == 0 && ::GetLastError() != ERROR_HANDLE_EOF) {
            errno = EIO;
            return std::nullopt;
        }
        if (got == 0) { break; }
        done += got;
    }
    return done;
}

void preferLargePages(void*, std::size_t) {}  // they take a privilege

}  // namespace binosplat
