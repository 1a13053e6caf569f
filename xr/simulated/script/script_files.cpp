// Script files from disk.
#include "xr/simulated/script/script_files.h"

#include "xr/simulated/files/file_words.h"
#include "xr/simulated/files/motion_file.h"
#include "xr/simulated/script/script_words.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>

namespace simulated {

namespace fs = std::filesystem;

namespace {

// Rethrows a file's own error as the script's.
auto readWith(const auto& parse, const auto& text, const std::string& name) {
    try {
        return parse(text, name);
    } catch (const files::Error& error) { throw ScriptError(error.what()); }
}

}  // namespace

std::string readText(const fs::path& path, const std::string& place, const char* expected,
                     std::size_t most_bytes) {
    const auto refuse = [&](const std::string& reason) {
        throw ScriptError(
            fmt::format("{}{}: cannot be read ({}), must be {}", place, path.string(), reason, expected));
    };
    std::error_code error;
    const fs::file_status status = fs::status(path, error);
    if (!fs::exists(status)) { refuse(error ? error.message() : "No such file or directory"); }
    // Devices and pipes may never end.
    if (!fs::is_regular_file(status)) { refuse("not a regular file"); }
    std::ifstream stream(path, std::ios::binary);
    if (!stream) { refuse(std::strerror(errno)); }
    std::string text(std::min<std::uintmax_t>(fs::file_size(path, error), most_bytes) + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(stream.gcount()));
    if (text.size() > most_bytes) { refuse(fmt::format("longer than {} MiB", most_bytes >> 20)); }
    if (text.starts_with("version https://git-lfs.github.com/spec/")) {
        refuse("a Git LFS pointer, to be fetched with `git lfs pull`");
    }
    return text;
}

files::HeadsetFile readHeadset(const std::string& text, const std::string& name) {
    return readWith(files::parseHeadset, text, name);
}

Track<Pose> readHeadTrack(std::string_view text, const std::string& name, MotionAxes axes,
                          std::vector<std::string>& notes) {
    Track<Pose> track;
    const files::MotionFile motion = readWith(files::parseMotion, text, name);
    if (!motion.note.empty()) { notes.push_back(motion.note); }
    for (const files::MotionSample& sample : motion.samples) {
        const auto& [x, y, z] = sample.position_m;
        const auto& [qx, qy, qz, qw] = sample.orientation_xyzw;
        // Unity's axes: a reflection in z mirrors the axis and reverses the rotation.
        const Pose pose = axes == MotionAxes::kOpenXr ? Pose{glm::dquat(qw, qx, qy, qz), {x, y, z}}
                                                      : Pose{glm::dquat(qw, -qx, -qy, qz), {x, y, -z}};
        track.add(sample.time_s, pose);
    }
    return track;
}

}  // namespace simulated
