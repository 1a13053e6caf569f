#include "xr/simulated/compose/old_output.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace simulated {

namespace fs = std::filesystem;

namespace {

// frame_000012.png, or .frame_000012.unfinished.png of a run that died.
bool isPicture(std::string_view name) {
    const bool is_unfinished = name.starts_with(".");
    if (is_unfinished) { name.remove_prefix(1); }
    const std::string_view suffix = is_unfinished ? ".unfinished.png" : ".png";
    constexpr std::string_view kPrefix = "frame_";
    if (!name.starts_with(kPrefix) || !name.ends_with(suffix) || name.size() < kPrefix.size() + suffix.size()) { return false; }
    const std::string_view number = name.substr(kPrefix.size(), name.size() - kPrefix.size() - suffix.size());
    return number.size() >= 6 && std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
}

bool isOurLog(const fs::path& path) {
    std::error_code error;
    if (!fs::is_regular_file(fs::symlink_status(path, error))) { return false; }
    constexpr std::string_view kBeginning = "{\"frame\":0,\"display_time_ns\":";
    std::string beginning(kBeginning.size(), ' ');
    std::ifstream(path, std::ios::binary).read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    return beginning == kBeginning;
}

}  // namespace

void removeOldOutput(const fs::path& folder) {
    if (!isOurLog(folder / kLogName)) { return; }
    std::vector<fs::path> old;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (isPicture(entry->path().filename().string()) && entry->is_regular_file(error) && !entry->is_symlink(error)) {
            old.push_back(entry->path());
        }
    }
    for (const fs::path& path : old) { fs::remove(path, error); }
}

}  // namespace simulated
