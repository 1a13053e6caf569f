// Folders that are not a format of their own: the output of a training, or the numbered files of a moving
// scene.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace binosplat {

// As the training of 3DGS and 2DGS leaves it: point_cloud/iteration_N/point_cloud.ply, and cameras.json
// beside point_cloud. Also that folder point_cloud by itself, or a folder of checkpoints:
// iteration_N/point_cloud.ply, or files such as point_cloud_N.ply with round numbers.
struct TrainingOutput {
    std::string scene;               // the one with the highest N
    std::string cameras;             // empty: there are none
    std::vector<std::string> older;  // the other scenes, newest first, relative to the folder
};

// Empty if the folder is not such an output, or is recognized as something else first: a SOG scene, streamed
// or not.
std::optional<TrainingOutput> findTrainingOutput(const std::filesystem::path& folder);

// The cameras.json of a scene, a file or a folder: in its folder, beside it, or, for
// FOLDER/point_cloud/iteration_N/FILE, in FOLDER. Empty if there is none.
std::filesystem::path findCameraFile(const std::filesystem::path& scene);

// The only file of a folder that is a scene by its content, among those whose names do not rule that out;
// empty if there are several, or more files than are worth opening.
inline constexpr int kMostFilesOpened = 64;
std::optional<std::string> findOnlyScene(const std::filesystem::path& folder);

struct NumberedFile {
    std::string path;
    std::uint64_t number = 0;  // the highest value if it does not fit
};

// Files whose names differ in a single number, in the order of that number: every such group of two or more,
// the largest first.
std::vector<std::vector<NumberedFile>> findNumberedFiles(const std::filesystem::path& folder);

}  // namespace binosplat
