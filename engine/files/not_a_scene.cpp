// Tables of words and names.
#include "engine/files/not_a_scene.h"

#include "engine/files/input_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr const char
    *kTrainIt =
        "expected the scene that a training makes from it, such as point_cloud/iteration_N/point_cloud.ply",
    *kTiles = "expected the file of its splats, such as a .glb that it names",
    *kForCameras = "expected the scene itself (--cameras takes the cameras of a 3DGS training)";

// A file with both words in its first bytes, or, without words, of this name.
struct OtherFile {
    std::array<std::string_view, 2> words;
    std::string_view name;
    const char* what;
    const char* instead;
};
constexpr std::array<OtherFile, 9> kOtherFiles{{
    {{"\"geometricError\"", "\"asset\""}, "", "a tileset of 3D Tiles", kTiles},
    {{"\"transform_matrix\"", "\"frames\""},
     "",
     "a list of photographs with their cameras (transforms.json)",
     kTrainIt},
    {{"\"img_name\"", "\"rotation\""}, "", "the cameras of a 3DGS training (cameras.json)", kForCameras},
    {{"\"cameras\"", ""}, "", "a list of cameras", kForCameras},
    {{}, "cameras.bin", "the cameras of a COLMAP project", kTrainIt},
    {{}, "images.bin", "the photographs of a COLMAP project", kTrainIt},
    {{}, "points3D.bin", "the point cloud of a COLMAP project", kTrainIt},
    {{}, "project.ini", "the settings of a COLMAP project", kTrainIt},
    {{}, "database.db", "the matches of a COLMAP project", kTrainIt},
}};

// A folder with this in it.
struct OtherFolder {
    const char* member;
    const char* what;
    const char* instead;
};
constexpr std::array<OtherFolder, 8> kOtherFolders{{
    {"sparse/0/cameras.bin", "a COLMAP project", kTrainIt},
    {"sparse/0/cameras.txt", "a COLMAP project", kTrainIt},
    {"cameras.bin", "the point cloud and cameras of a COLMAP project", kTrainIt},
    {"cameras.txt", "the point cloud and cameras of a COLMAP project", kTrainIt},
    {"opensfm", "an OpenDroneMap project", kTrainIt},
    {"odm_georeferencing", "an OpenDroneMap project", kTrainIt},
    {"transforms.json", "photographs with their cameras (transforms.json)", kTrainIt},
    {"tileset.json", "a tileset of 3D Tiles", kTiles},
}};

bool isWebPage(std::string_view start) {
    start = withoutByteOrderMark(start);
    start.remove_prefix(std::min(start.find_first_not_of(" \t\r\n"), start.size()));
    std::string lower(start.substr(0, 16));
    for (char& letter : lower) {
        if (letter >= 'A' && letter <= 'Z') { letter = static_cast<char>(letter - 'A' + 'a'); }
    }
    return lower.starts_with("<!doctype html") || lower.starts_with("<html");
}

std::string describe(const char* what, const char* instead) {
    return fmt::format("{}, not a splat scene, {}", what, instead);
}

}  // namespace

std::string describeOther(std::string_view start, const std::string& path) {
    if (isWebPage(start)) {
        return describe("a web page (HTML)",
                        "expected the file that its download button gives: a link to a viewer was saved");
    }
    const std::string name = fs::path(path).filename().string();
    for (const OtherFile& other : kOtherFiles) {
        const bool is_it = !other.name.empty() ? name == other.name
                                               : std::ranges::all_of(other.words, [&](std::string_view word) {
                                                     return start.find(word) != std::string_view::npos;
                                                 });
        if (is_it) { return describe(other.what, other.instead); }
    }
    return {};
}

std::string describeOtherFolder(const std::string& folder) {
    std::error_code error;
    for (const OtherFolder& other : kOtherFolders) {
        if (fs::exists(fs::path(folder) / other.member, error)) {
            return describe(other.what, other.instead);
        }
    }
    return {};
}

}  // namespace binosplat
