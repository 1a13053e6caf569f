// Head motion files in the camera's axes.
#include "engine/error.h"
#include "engine/setup/data_folders.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/text_file.h"
#include "xr/simulated/files/file_words.h"
#include "xr/simulated/files/motion_file.h"

namespace binosplat {

HeadMotion parseHeadMotion(std::string_view text, const std::string& file, MotionAxes axes) {
    try {
        std::vector<HeadSample> samples;
        files::MotionFile motion = files::parseMotion(text, file);
        for (const files::MotionSample& sample : motion.samples) {
            const auto& [x, y, z] = sample.position_m;
            const auto& [qx, qy, qz, qw] = sample.orientation_xyzw;
            samples.push_back(
                {sample.time_s, poseFromRecording({x, y, z}, glm::dquat(qw, qx, qy, qz), axes)});
        }
        return HeadMotion(std::move(samples), std::move(motion.note));
    } catch (const files::Error& error) { throw Error(error.what()); }
}

HeadMotion readHeadMotion(const std::filesystem::path& path, MotionAxes axes) {
    return parseHeadMotion(
        readTextFile(givenOrShipped(path), "a CSV file of head motion", kMostRecordingBytes), path.string(),
        axes);
}

}  // namespace binosplat
