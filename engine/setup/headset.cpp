// Headset geometry from configs/headsets/NAME.toml.
#include "engine/setup/headset.h"

#include "engine/error.h"
#include "engine/setup/data_folders.h"
#include "engine/setup/values.h"

#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <set>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

const Setting& require(const SettingsTable& table, const std::string& key) {
    const auto found = table.settings.find(key);
    check(found != table.settings.end(), "{}: {}{} is missing, must be given", table.origin, table.name.empty() ? "" : table.name + ".",
          key);
    return found->second;
}

void refuseUnknown(const SettingsTable& table, const std::set<std::string>& known) {
    for (const auto& [key, setting] : table.settings) {
        check(known.contains(key), "{} is not a key of a headset{}", setting.origin, table.name.empty() ? "" : "'s [" + table.name + "]");
    }
}

double angle(const SettingsTable& table, const std::string& key) { return glm::radians(readNumber(require(table, key), -85.0, 85.0)); }

ViewAngles anglesOf(const SettingsTable& table) {
    refuseUnknown(table, {"left", "right", "up", "down"});
    const ViewAngles angles{angle(table, "left"), angle(table, "right"), angle(table, "up"), angle(table, "down")};
    check(angles.left_rad < angles.right_rad, "{}: {}.left must be less than {}.right", table.origin, table.name, table.name);
    check(angles.down_rad < angles.up_rad, "{}: {}.down must be less than {}.up", table.origin, table.name, table.name);
    return angles;
}

// Outwards is to the left for the left eye; y points down, so a positive turn about it carries z towards x.
glm::dquat outwardTurn(int side, double canting_rad) {
    return glm::angleAxis(side == kLeft ? -canting_rad : canting_rad, glm::dvec3(0.0, 1.0, 0.0));
}

}  // namespace

Headset readHeadset(const fs::path& path) {
    Headset headset;
    std::array<bool, 2> given{};
    for (const SettingsTable& table : readSettingsFile(path)) {
        if (table.name.empty()) {
            refuseUnknown(table, {"name", "source", "size", "canting-deg", "eye-distance-m"});
            headset.name = readText(require(table, "name"));
            headset.source = readText(require(table, "source"));
            headset.size_px = readSize(require(table, "size"));
            headset.canting_rad = glm::radians(readNumber(require(table, "canting-deg"), 0.0, 45.0));
            headset.eye_distance_m = readNumber(require(table, "eye-distance-m"), 0.0, 1.0);
        } else {
            check(table.name == "left" || table.name == "right", "{}: [{}] is not a table of a headset, must be [left] or [right]",
                  table.origin, table.name);
            const int side = table.name == "left" ? kLeft : kRight;
            headset.angles[static_cast<std::size_t>(side)] = anglesOf(table);
            given[static_cast<std::size_t>(side)] = true;
        }
    }
    check(given[kLeft] && given[kRight], "{}: [{}] is missing, must be given", path.string(), given[kLeft] ? "right" : "left");
    return headset;
}

fs::path findHeadset(const std::string& name) {
    if (name.ends_with(".toml")) { return name; }
    check(!name.empty() && name.find('/') == std::string::npos, "--headset is {}, must be a name of configs/headsets or a .toml file",
          name);
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
    fail("configs/headsets/{}.toml: not found, must be one of: {}", name,
         list.empty() ? "(no configs/headsets here; BINOSPLAT_DATA may name the folder that holds configs)" : list);
}

std::array<Eye, 2> headsetEyes(const Headset& headset, const Pose& world_from_middle, double eye_distance, glm::uvec2 size_px) {
    std::array<Eye, 2> eyes;
    for (int side : {kLeft, kRight}) {
        const double x = (side == kLeft ? -0.5 : 0.5) * eye_distance;
        const Pose middle_from_camera{outwardTurn(side, headset.canting_rad), {x, 0.0, 0.0}};
        const auto index = static_cast<std::size_t>(side);
        eyes[index] = {compose(world_from_middle, middle_from_camera), intrinsicsFromAngles(headset.angles[index], size_px), size_px};
    }
    return eyes;
}

Eye headsetMiddle(const Headset& headset, const Pose& world_from_middle, glm::uvec2 size_px) {
    const ViewAngles& left = headset.angles[kLeft];
    const ViewAngles& right = headset.angles[kRight];
    const double limit = glm::radians(85.0);
    const ViewAngles both{std::max(-limit, std::min(left.left_rad - headset.canting_rad, right.left_rad + headset.canting_rad)),
                          std::min(limit, std::max(left.right_rad - headset.canting_rad, right.right_rad + headset.canting_rad)),
                          std::max(left.up_rad, right.up_rad), std::min(left.down_rad, right.down_rad)};
    return {world_from_middle, intrinsicsFromAngles(both, size_px), size_px};
}

}  // namespace binosplat
