// Windows, whose own texts are UTF-16.
#include <windows.h>

#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>

#include <cerrno>

#include "xr/simulated/system.h"

namespace simulated {

const char* const kVulkanLoader = "vulkan-1.dll";

std::optional<std::string> readEnvironmentVariable(const std::string& name) {
    const std::wstring wide(name.begin(), name.end());  // ours are ASCII
    std::wstring value(32767, L'\0');                   // the longest there is
    ::SetLastError(ERROR_SUCCESS);
    const DWORD length =
        ::GetEnvironmentVariableW(wide.c_str(), value.data(), static_cast<DWORD>(value.size()));
    if (length == 0 && ::GetLastError() != ERROR_SUCCESS) { return std::nullopt; }
    std::string text(std::size_t{3} * length, '\0');
    text.resize(static_cast<std::size_t>(
        ::WideCharToMultiByte(CP_UTF8, 0, value.data(), static_cast<int>(length), text.data(),
                              static_cast<int>(text.size()), nullptr, nullptr)));
    return text;
}

std::FILE* createFile(const std::filesystem::path& path) {
    int descriptor = -1;
    errno = ::_wsopen_s(&descriptor, path.c_str(), _O_WRONLY | _O_CREAT | _O_EXCL | _O_BINARY | _O_NOINHERIT,
                        _SH_DENYNO, _S_IREAD | _S_IWRITE);
    return descriptor >= 0 ? ::_fdopen(descriptor, "wb") : nullptr;
}

void* findVulkanFunction(const char* name) {
    static const HMODULE library = ::LoadLibraryW(L"vulkan-1.dll");
    return library != nullptr ? reinterpret_cast<void*>(::GetProcAddress(library, name)) : nullptr;
}

void keepThisLibrary() {
    HMODULE kept = nullptr;
    ::GetModuleHandleExW(GET_MODULE_HANDLE_EX_FLAG_PIN | GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS,
                         reinterpret_cast<LPCWSTR>(&keepThisLibrary), &kept);
}

}  // namespace simulated
