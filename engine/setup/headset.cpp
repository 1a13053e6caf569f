// Headset geometry from configs/headsets/NAME.toml.
#include "engine/setup/headset.h"

#include "engine/error.h"
#include "engine/setup/data_folders.h"
#include "engine/setup/text_file.h"
#include "xr/simulated/files/file_words.h"
#include "xr/simulated/files/headset_file.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cmath>
#include <set>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

// Outwards is to the left for the left eye; y points down, so a positive turn about it moves z towards x.
glm::dquat outwardTurn(int side, double canting_rad) {
    return glm::angleAxis(side == kLeft ? -canting_rad : canting_rad, glm::dvec3(0.0, 1.0, 0.0));
}

}  // namespace

Headset readHeadset(const fs::path& path) {
    const std::string text = readTextFile(path, "a TOML file of a headset");
    try {
        const files::HeadsetFile file = files::parseHeadset(text, path.string());
        Headset headset{
            .name = file.name, .source = file.source, .size_px = {file.size_px[0], file.size_px[1]}};
        headset.canting_rad = file.canting_rad;
        headset.eye_distance_m = file.eye_distance_m;
        for (std::size_t side = 0; side < 2; ++side) {
            const files::HeadsetAngles& angles = file.angles[side];
            headset.angles[side] = {angles.left_rad, angles.right_rad, angles.up_rad, angles.down_rad};
            const auto& [right_rad, up_rad] = file.lens_centres_rad[side];
            headset.lens_centres[side] = {std::tan(right_rad), -std::tan(up_rad), 1.0};
        }
        return headset;
    } catch (const files::Error& error) { throw Error(error.what()); }
}

fs::path findHeadset(const std::string& name) {
    if (name.ends_with(".toml")) { return name; }
    check(!name.empty() && name.find('/') == std::string::npos,
          "--headset is {}, must be a name of configs/headsets or a .toml file", name);
    std::set<std::string> known;
    for (const fs::path& root : dataFolders()) {
        const fs::path folder = root / "configs" / "headsets";
        if (fs::path file = folder / (name + ".toml"); fs::exists(file)) { return file; }
        std::error_code no_folder;
        for (const fs::directory_entry& entry : fs::directory_iterator(folder, no_folder)) {
            if (entry.path().extension() == ".toml") { known.insert(entry.path().stem().string()); }
        }
    }
    std::string list;
    for (const std::string& one : known) { list += (list.empty() ? "" : ", ") + one; }
    check(!list.empty(),
          "configs/headsets/{}.toml: not found: there is no configs/headsets in the searched folders; set "
          "BINOSPLAT_DATA",
          name);
    fail("configs/headsets/{}.toml: not found, must be one of: {}", name, list);
}

std::array<Eye, 2> headsetEyes(const Headset& headset, const Pose& world_from_middle, double eye_distance,
                               glm::uvec2 size_px) {
    std::array<Eye, 2> eyes;
    for (int side : {kLeft, kRight}) {
        const double x = (side == kLeft ? -0.5 : 0.5) * eye_distance;
        const Pose middle_from_camera{outwardTurn(side, headset.canting_rad), {x, 0.0, 0.0}};
        const auto index = static_cast<std::size_t>(side);
        eyes[index] = {compose(world_from_middle, middle_from_camera),
                       intrinsicsFromAngles(headset.angles[index], size_px), size_px};
    }
    return eyes;
}

Eye headsetMiddle(const Headset& headset, const Pose& world_from_middle, glm::uvec2 size_px) {
    const ViewAngles& left = headset.angles[kLeft];
    const ViewAngles& right = headset.angles[kRight];
    const double limit = glm::radians(85.0);
    const ViewAngles both{
        std::max(-limit, std::min(left.left_rad - headset.canting_rad, right.left_rad + headset.canting_rad)),
        std::min(limit,
                 std::max(left.right_rad - headset.canting_rad, right.right_rad + headset.canting_rad)),
        std::max(left.up_rad, right.up_rad), std::min(left.down_rad, right.down_rad)};
    return {world_from_middle, intrinsicsFromAngles(both, size_px), size_px};
}

}  // namespace binosplat
