// The files that a script names, and the script itself.
#pragma once

#include "xr/simulated/files/headset_file.h"
#include "xr/simulated/script/script.h"

namespace simulated {

// Limits for files that people write, and for those that programs record.
inline constexpr std::size_t kMostTextBytes = std::size_t{4} << 20,
                             kMostRecordingBytes = std::size_t{16} << 20;

// The text of a regular file of at most `most_bytes`. `place` is where it is named, for messages
// ("walk.script:3: ", or nothing). Throws ScriptError.
[[nodiscard]] std::string readText(const std::filesystem::path& path, const std::string& place,
                                   const char* expected, std::size_t most_bytes = kMostTextBytes);

// As headset_file.h describes it. Throws ScriptError with the file's own line.
[[nodiscard]] files::HeadsetFile readHeadset(const std::string& text, const std::string& name);

// The axes a recording was made in; y points up in both, x to the right.
enum class MotionAxes {
    kOpenXr,  // right-handed, the wearer looks along -z
    kUnity,   // left-handed, the wearer looks along +z
};
// Head poses by time since the first one, from a text as motion_file.h describes it; its note goes to
// `notes`. Throws ScriptError with the file's own line.
[[nodiscard]] Track<Pose> readHeadTrack(std::string_view text, const std::string& name, MotionAxes axes,
                                        std::vector<std::string>& notes);

}  // namespace simulated
