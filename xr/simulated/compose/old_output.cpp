// An earlier run's files, as its log names them, are removed; anything else that is in the way is refused.
#include "xr/simulated/compose/old_output.h"

#include "xr/simulated/compose/picture_file.h"

#include <fmt/format.h>

#include <charconv>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <stdexcept>
#include <string_view>

namespace simulated {

namespace fs = std::filesystem;

namespace {

// A run leaves no links, wherever they lead.
bool isPlainFile(const fs::path& path) {
    std::error_code error;
    return fs::is_regular_file(fs::symlink_status(path, error));
}

// The frame whose picture has this name.
std::optional<std::uint64_t> frameOfPicture(std::string_view name) {
    constexpr std::string_view kPrefix = "frame_";
    if (!name.starts_with(kPrefix)) { return {}; }
    std::uint64_t frame = 0;
    const auto read = std::from_chars(name.data() + kPrefix.size(), name.data() + name.size(), frame);
    if (read.ec != std::errc() || namePicture(frame) != name) { return {}; }
    return frame;
}

// The picture that a file of this name is, or was to become.
std::string pictureOf(std::string name) {
    constexpr std::string_view kUnfinished = ".unfinished.png";
    if (!name.starts_with('.') || !name.ends_with(kUnfinished)) { return name; }
    return name.substr(1, name.size() - 1 - kUnfinished.size()) + ".png";
}

// A run that ended before its first frame leaves an empty log. Others begin with a frame, a refused frame, or
// a session's states.
bool isOurLog(const fs::path& path) {
    if (!isPlainFile(path)) { return false; }
    std::error_code error;
    if (fs::file_size(path, error) == 0 && !error) { return true; }
    std::string beginning(40, ' ');
    std::ifstream(path, std::ios::binary)
        .read(beginning.data(), static_cast<std::streamsize>(beginning.size()));
    return beginning.starts_with("{\"frame\":0,\"display_time_ns\":") ||
           beginning.starts_with("{\"refused\":\"XR_ERROR_") ||
           beginning.starts_with("{\"session_state\":\"");
}

// The valid picture names in the log's lines.
std::set<std::string> loggedPictures(const fs::path& log) {
    std::set<std::string> names;
    std::ifstream stream(log, std::ios::binary);
    for (std::string line; std::getline(stream, line);) {
        if (line.find("\"picture\":") == std::string::npos) { continue; }
        const auto json = nlohmann::json::parse(line, nullptr, false);
        if (!json.is_object()) { continue; }
        const auto picture = json.find("picture");
        if (picture == json.end() || !picture->is_string()) { continue; }
        if (frameOfPicture(picture->get<std::string>())) { names.insert(picture->get<std::string>()); }
    }
    return names;
}

}  // namespace

std::string namePicture(std::uint64_t frame) { return fmt::format("frame_{:06}.png", frame); }

void removeOldOutput(const fs::path& folder, bool writes_pictures, const FrameChoice& frames) {
    const auto refuse = [](const fs::path& path) {
        throw std::runtime_error(path.string() +
                                 ": not what an earlier run left here, must be moved elsewhere");
    };
    const fs::path log = folder / kLogName;
    std::error_code error;
    const bool has_log = fs::exists(fs::symlink_status(log, error));
    if (has_log && !isOurLog(log)) { refuse(log); }
    const std::set<std::string> old = has_log ? loggedPictures(log) : std::set<std::string>();
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = pictureOf(entry->path().filename().string());
        const std::optional<std::uint64_t> frame = frameOfPicture(name);
        const bool is_in_the_way = frame && writes_pictures && frames.contains(*frame);
        if (is_in_the_way && !(old.contains(name) && isPlainFile(entry->path()))) { refuse(entry->path()); }
    }
    for (const std::string& name : old) {
        for (const fs::path& path : {folder / name, nameUnfinishedPicture(folder / name)}) {
            if (isPlainFile(path)) { fs::remove(path, error); }
        }
    }
    fs::remove(log, error);
}

}  // namespace simulated
