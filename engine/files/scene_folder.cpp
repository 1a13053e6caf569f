// Finds scenes by the names in a folder.
#include "engine/files/scene_folder.h"

#include "engine/address.h"
#include "engine/error.h"
#include "engine/files/load_scene.h"
#include "engine/files/packed_scene.h"
#include "engine/files/sog.h"
#include "engine/files/streamed_sog.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

bool isDigit(char letter) { return letter >= '0' && letter <= '9'; }

// A number of any length, compared by value: by its digits without leading zeros.
std::pair<std::size_t, std::string> numberOf(std::string_view digits) {
    digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
    return {digits.size(), std::string(digits)};
}

struct Checkpoint {
    std::pair<std::size_t, std::string> number;
    fs::path scene;
};

// The part between a name's front and its end, if it is all digits.
std::string_view digitsOf(std::string_view name, std::string_view front, std::string_view end) {
    if (!name.starts_with(front) || !name.ends_with(end) || name.size() <= front.size() + end.size()) {
        return {};
    }
    const std::string_view digits = name.substr(front.size(), name.size() - front.size() - end.size());
    return std::ranges::all_of(digits, isDigit) ? digits : std::string_view();
}

// Folders iteration_N with a scene in them, in no particular order.
std::vector<Checkpoint> findIterations(const fs::path& folder) {
    std::vector<Checkpoint> found;
    std::error_code error, ignored;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        const std::string_view digits = digitsOf(name, "iteration_", "");
        const fs::path scene = entry->path() / "point_cloud.ply";
        if (!digits.empty() && fs::is_regular_file(scene, ignored)) {
            found.push_back({numberOf(digits), scene});
        }
    }
    return found;
}

// Training programs save after round numbers of steps, some counting from 0; the frames of a film are
// numbered one by one.
bool isRound(std::string_view steps) { return steps.ends_with("00") || steps.ends_with("99"); }

// Scenes named after the training step at which they were saved, in no particular order. Empty if one of the
// numbers cannot be a step.
std::vector<Checkpoint> findCheckpointFiles(const fs::path& folder) {
    std::vector<Checkpoint> found;
    std::error_code error, ignored;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        // As gsplat and others name them; the last is Brush's.
        for (const char* front : {"point_cloud_", "iteration_", "export_"}) {
            const std::string_view digits = digitsOf(name, front, ".ply");
            if (digits.empty() || !entry->is_regular_file(ignored)) { continue; }
            if (!isRound(digits)) { return {}; }
            found.push_back({numberOf(digits), entry->path()});
        }
    }
    return found;
}

}  // namespace

std::optional<TrainingOutput> findTrainingOutput(const fs::path& folder) {
    if (isStreamedSogFolder(folder.string()) || isSogFolder(folder.string())) { return std::nullopt; }
    std::vector<Checkpoint> found = findIterations(folder / "point_cloud");
    if (found.empty()) { found = findIterations(folder); }
    if (found.empty()) { found = findCheckpointFiles(folder); }
    if (found.empty()) { return std::nullopt; }
    std::ranges::sort(found, std::greater{}, &Checkpoint::number);
    TrainingOutput output{found.front().scene.string(), "", {}};
    for (const Checkpoint& older : std::span(found).subspan(1)) {
        output.older.push_back(older.scene.lexically_relative(folder).string());
    }
    // The path may end with a slash.
    const fs::path named = folder.has_filename() ? folder : folder.parent_path();
    std::error_code ignored;
    for (const fs::path& place : {named, named.filename() == "point_cloud" ? named.parent_path() : named}) {
        const fs::path cameras = place / "cameras.json";
        if (output.cameras.empty() && fs::is_regular_file(cameras, ignored)) {
            output.cameras = cameras.string();
        }
    }
    return output;
}

fs::path findCameraFile(const fs::path& scene) {
    if (isAddress(scene.string())) { return {}; }
    std::error_code error;
    fs::path whole = fs::absolute(scene, error).lexically_normal();
    if (error) { return {}; }
    if (whole.filename().empty()) { whole = whole.parent_path(); }  // of a folder with a slash behind it
    const fs::path folder = whole.parent_path();
    const bool is_trained = folder.filename().string().starts_with("iteration_") &&
                            folder.parent_path().filename() == "point_cloud";
    // The output of a training run is complete: what is next to its folder belongs to another run.
    const fs::path beside = is_trained ? folder.parent_path().parent_path() : folder;
    std::vector<fs::path> places{whole, beside};
    if (const std::optional<TrainingOutput> training = findTrainingOutput(whole)) {
        if (training->cameras.empty()) { return {}; }
        places = {fs::path(training->cameras).parent_path()};
    }
    for (const fs::path& place : places) {
        if (!fs::is_regular_file(place / "cameras.json", error)) { continue; }
        // As the scene was named.
        return scene.is_absolute() ? place / "cameras.json"
                                   : (place / "cameras.json").lexically_proximate(fs::current_path());
    }
    return {};
}

std::optional<std::string> findOnlyScene(const fs::path& folder) {
    std::optional<std::string> found;
    int files = 0;
    std::error_code error, ignored;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        if (!mayHaveScene(entry->path()) || entry->path().filename().string().starts_with('.') ||
            !entry->is_regular_file(ignored)) {
            continue;
        }
        if (++files > kMostFilesOpened) { return std::nullopt; }
        const std::string path = entry->path().string();
        try {
            if (formatOfFile(path).empty()) { continue; }
        } catch (const Error&) { continue; }  // what cannot be read is not the scene
        if (found) { return std::nullopt; }
        found = path;
    }
    return found;
}

std::vector<std::vector<NumberedFile>> findNumberedFiles(const fs::path& folder) {
    // Grouped by what is left of a name without one of its numbers; a name with several numbers belongs to
    // several groups.
    std::map<std::string, std::map<std::pair<std::size_t, std::string>, std::string>> groups;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        std::error_code ignored;
        const std::string name = entry->path().filename().string();
        if (name.starts_with('.') || !entry->is_regular_file(ignored)) { continue; }
        for (std::size_t begin = 0, stop = 0; begin < name.size(); begin = stop + 1) {
            begin = static_cast<std::size_t>(
                std::find_if(name.begin() + static_cast<std::ptrdiff_t>(begin), name.end(), isDigit) -
                name.begin());
            stop = std::min(name.find_first_not_of("0123456789", begin), name.size());
            if (begin == stop) { break; }
            // File names do not contain slashes.
            groups[name.substr(0, begin) + '/' + name.substr(stop)].emplace(
                numberOf(std::string_view(name).substr(begin, stop - begin)), entry->path().string());
        }
    }
    std::vector<std::vector<NumberedFile>> found;
    for (const auto& [pattern, files] : groups) {
        if (files.size() < 2) { continue; }
        std::vector<NumberedFile>& group = found.emplace_back();
        for (const auto& [digits, file] : files) {
            std::uint64_t number = 0;  // if there are only zeros
            const char* const begin = digits.second.data();
            if (std::from_chars(begin, begin + digits.second.size(), number).ec ==
                std::errc::result_out_of_range) {
                number = ~number;
            }
            group.push_back({file, number});
        }
    }
    std::ranges::stable_sort(found, std::greater{},
                             [](const std::vector<NumberedFile>& group) { return group.size(); });
    return found;
}

}  // namespace binosplat
