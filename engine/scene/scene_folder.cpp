// Looking through a folder's names.
#include "engine/scene/scene_folder.h"

#include "engine/scene/address.h"
#include "engine/scene/sog.h"
#include "engine/scene/streamed_sog.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

bool isDigit(char letter) { return letter >= '0' && letter <= '9'; }

// A number of any length, by its value first: its digits without zeros in front.
std::pair<std::size_t, std::string> numberOf(std::string_view digits) {
    digits.remove_prefix(std::min(digits.find_first_not_of('0'), digits.size()));
    return {digits.size(), std::string(digits)};
}

}  // namespace

std::optional<TrainingOutput> findTrainingOutput(const fs::path& folder) {
    if (isStreamedSogFolder(folder.string()) || isSogFolder(folder.string())) { return std::nullopt; }
    constexpr std::string_view kIteration = "iteration_";
    std::optional<TrainingOutput> found;
    std::pair<std::size_t, std::string> highest;
    std::error_code error;
    for (fs::directory_iterator entry(folder / "point_cloud", error), end; !error && entry != end; entry.increment(error)) {
        const std::string name = entry->path().filename().string();
        const std::string_view digits = std::string_view(name).substr(std::min(kIteration.size(), name.size()));
        if (!name.starts_with(kIteration) || digits.empty() || !std::ranges::all_of(digits, isDigit)) { continue; }
        const fs::path scene = entry->path() / "point_cloud.ply";
        std::error_code ignored;
        const auto number = numberOf(digits);
        if ((found && number <= highest) || !fs::is_regular_file(scene, ignored)) { continue; }
        highest = number;
        const fs::path cameras = folder / "cameras.json";
        found = {scene.string(), fs::is_regular_file(cameras, ignored) ? cameras.string() : ""};
    }
    return found;
}

fs::path findCameraFile(const fs::path& scene) {
    if (isAddress(scene.string())) { return {}; }
    std::error_code error;
    fs::path whole = fs::absolute(scene, error).lexically_normal();
    if (error) { return {}; }
    if (whole.filename().empty()) { whole = whole.parent_path(); }  // of a folder with a slash behind it
    const fs::path folder = whole.parent_path();
    const bool is_trained = folder.filename().string().starts_with("iteration_") && folder.parent_path().filename() == "point_cloud";
    // A training's output is a whole: what lies beside its folder is of another one.
    const fs::path beside = is_trained ? folder.parent_path().parent_path() : folder;
    std::vector<fs::path> places{whole, beside};
    if (findTrainingOutput(whole)) { places = {whole}; }
    for (const fs::path& place : places) {
        if (!fs::is_regular_file(place / "cameras.json", error)) { continue; }
        // As the scene was named.
        return scene.is_absolute() ? place / "cameras.json" : (place / "cameras.json").lexically_proximate(fs::current_path());
    }
    return {};
}

std::vector<std::vector<NumberedFile>> findNumberedFiles(const fs::path& folder) {
    // By what is left of a name without one of its numbers; a name with several numbers belongs to as many groups.
    std::map<std::string, std::map<std::pair<std::size_t, std::string>, std::string>> groups;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
        std::error_code ignored;
        const std::string name = entry->path().filename().string();
        if (name.starts_with('.') || !entry->is_regular_file(ignored)) { continue; }
        for (std::size_t begin = 0, stop = 0; begin < name.size(); begin = stop + 1) {
            begin = static_cast<std::size_t>(std::find_if(name.begin() + static_cast<std::ptrdiff_t>(begin), name.end(), isDigit) -
                                             name.begin());
            stop = std::min(name.find_first_not_of("0123456789", begin), name.size());
            if (begin == stop) { break; }
            // No file's name has a slash.
            groups[name.substr(0, begin) + '/' + name.substr(stop)].emplace(numberOf(std::string_view(name).substr(begin, stop - begin)),
                                                                            entry->path().string());
        }
    }
    std::vector<std::vector<NumberedFile>> found;
    for (const auto& [pattern, files] : groups) {
        if (files.size() < 2) { continue; }
        std::vector<NumberedFile>& group = found.emplace_back();
        for (const auto& [digits, file] : files) {
            std::uint64_t number = 0;  // of none but zeros
            const char* const begin = digits.second.data();
            if (std::from_chars(begin, begin + digits.second.size(), number).ec == std::errc::result_out_of_range) { number = ~number; }
            group.push_back({file, number});
        }
    }
    std::ranges::stable_sort(found, std::greater{}, [](const std::vector<NumberedFile>& group) { return group.size(); });
    return found;
}

}  // namespace binosplat
