// Which files of a folder are a moving scene, and in which order.
#include "engine/files/scene_series.h"

#include "engine/address.h"
#include "engine/error.h"
#include "engine/files/compressed_ply.h"
#include "engine/files/gltf.h"
#include "engine/files/load_scene.h"
#include "engine/files/packed_scene.h"
#include "engine/files/ply.h"
#include "engine/files/scene_folder.h"
#include "engine/files/sog.h"
#include "engine/files/streamed_sog.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace binosplat {
namespace {

namespace fs = std::filesystem;

// If more numbers are missing than this factor allows, the numbers say nothing about time.
constexpr std::uint64_t kMostFramesAFile = 4;

std::string shortName(const std::string& path) { return fs::path(path).filename().string(); }

// Groups of files that are scenes of one format, by the first and the last of each; the largest first.
std::vector<std::vector<NumberedFile>> findSceneGroups(const std::string& folder) {
    std::vector<std::vector<NumberedFile>> groups = findNumberedFiles(folder);
    const auto formatIn = [](const std::string& path) {
        try {
            return mayHaveScene(path) ? formatOfFile(path) : std::string();
        } catch (const Error&) { return std::string(); }  // such as a network's weights
    };
    std::erase_if(groups, [&](const std::vector<NumberedFile>& group) {
        const std::string format = formatIn(group.front().path);
        return format.empty() || format != formatIn(group.back().path);
    });
    return groups;
}

glm::dvec3 originOf(const std::string& path) {
    try {
        const std::unique_ptr<InputFile> file = openUnpacked(path);
        if (isPly(*file) && !isCompressedPly(*file)) { return originOfPly(*file); }
        return isGltf(*file) ? originOfGltf(*file) : glm::dvec3(0.0);
    } catch (const Error&) { return glm::dvec3(0.0); }  // reading it will report why
}

}  // namespace

bool isMovingScene(const std::string& source) {
    std::error_code error;
    if (isAddress(source) || !fs::is_directory(source, error) || isStreamedSogFolder(source) ||
        isSogFolder(source) || findTrainingOutput(source)) {
        return false;
    }
    return !findSceneGroups(source).empty();
}

SceneSeries::SceneSeries(const std::string& source) : name_(source) {
    const std::vector<std::vector<NumberedFile>> groups = findSceneGroups(name_);
    check(!groups.empty(), "{}: has no numbered files of one format, expected a moving scene", name_);
    check(groups.size() < 2 || groups[1].size() < groups[0].size(),
          "{}: {} to {} are numbered files, and so are {} to {}, expected one moving scene", name_,
          shortName(groups[0].front().path), shortName(groups[0].back().path),
          groups.size() < 2 ? "" : shortName(groups[1].front().path),
          groups.size() < 2 ? "" : shortName(groups[1].back().path));
    const std::vector<NumberedFile>& files = groups[0];
    format_ = formatOfFile(files.front().path);
    origin_ = originOf(files.front().path);
    std::uint64_t step = ~std::uint64_t{0};
    for (std::size_t i = 1; i < files.size(); ++i) {
        step = std::min(step, files[i].number - files[i - 1].number);
    }
    step = std::max<std::uint64_t>(step, 1);
    const bool is_regular =
        (files.back().number - files.front().number) / step < kMostFramesAFile * files.size() &&
        std::ranges::all_of(files, [&](const NumberedFile& file) {
            return (file.number - files.front().number) % step == 0;
        });
    std::vector<std::string> before_missing;
    double first_bytes = 0.0;
    for (const NumberedFile& file : files) {
        while (is_regular && files.front().number + frames_.size() * step < file.number) {
            if (before_missing.empty() || before_missing.back() != scenes_.back()) {
                before_missing.push_back(scenes_.back());
            }
            frames_.push_back(scenes_.size() - 1);
        }
        frames_.push_back(scenes_.size());
        scenes_.push_back(file.path);
        std::error_code error;
        const auto bytes = static_cast<double>(fs::file_size(file.path, error));
        if (error) { continue; }  // reading it will report it
        if (first_bytes == 0.0) { first_bytes = std::max(bytes, 1.0); }
        growth_ = std::max(growth_, bytes / first_bytes);
    }
    if (!before_missing.empty()) {
        lines_.push_back(fmt::format(
            "{}: {} of {} numbered files are missing, the first after {}: the frame before a missing one is "
            "shown for longer",
            name_, frames_.size() - scenes_.size(), frames_.size(), shortName(before_missing.front())));
    }
}

Scene SceneSeries::load(std::size_t scene, LoadNotes& notes, const Progress& progress) const {
    Scene loaded = loadScene(scenes_[scene], 0, &notes, progress);
    check(notes.format == format_, "{}: {}, the moving scene's first file is {}", scenes_[scene],
          notes.format, format_);
    countFrom(loaded, origin_);
    return loaded;
}

}  // namespace binosplat
