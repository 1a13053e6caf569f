// Headset geometry from configs/headsets/NAME.toml: asymmetric angles per eye, eye distance, canting.
#pragma once

#include "engine/geometry.h"

#include <array>
#include <filesystem>
#include <string>

namespace binosplat {

struct Headset {
    std::string name;
    std::string source;  // who measured the numbers
    glm::uvec2 size_px{0, 0};
    std::array<ViewAngles, 2> angles{};  // by Side, each relative to its own eye's axis
    double canting_rad = 0.0;            // each eye's axis is turned outwards by this
    double eye_distance_m = 0.0;
    std::array<glm::dvec3, 2> lens_centres{};  // by Side: the lens's centre, a direction in the eye's axes
};

// Keys name, source, size, canting_deg, eye_distance_m; tables [left] and [right] with left, right, up, down
// in degrees (left and down negative for a usual eye), and lens_centre, to the right and upwards, if that is
// not on the eye's axis. Throws Error with file and line.
Headset readHeadset(const std::filesystem::path& path);

// A headset's file: NAME itself if it is a path to a .toml, otherwise configs/headsets/NAME.toml in the first
// of dataFolders() that has it. Throws Error listing the available names.
std::filesystem::path findHeadset(const std::string& name);

// Both eyes of a wearer; the midpoint between them is at `world_from_middle`.
std::array<Eye, 2> headsetEyes(const Headset& headset, const Pose& world_from_middle, double eye_distance,
                               glm::uvec2 size_px);

// The eye for `mono`, midway between both: its angles cover both eyes' views of distant things.
Eye headsetMiddle(const Headset& headset, const Pose& world_from_middle, glm::uvec2 size_px);

}  // namespace binosplat
