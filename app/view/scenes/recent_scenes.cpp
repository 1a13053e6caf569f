// Keeps the lists in text files with a path on each line.
#include "app/view/scenes/recent_scenes.h"

#include "app/view/settings/view_files.h"
#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/error.h"
#include "engine/setup/output_files.h"
#include "engine/setup/text_file.h"

#include <algorithm>
#include <sstream>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr const char *kRecentName = "recent-scenes.txt", *kFavouritesName = "favourite-scenes.txt";
constexpr std::size_t kMostFavourites = 1000;

// One on each line. If the list is missing or unreadable, the next scene begins a new one.
std::vector<std::string> readList(const char* name, std::size_t most) {
    std::vector<std::string> scenes;
    try {
        std::istringstream lines(readTextFile(viewFolder() / name, "a list of scenes"));
        for (std::string line; std::getline(lines, line) && scenes.size() < most;) {
            if (!line.empty()) { scenes.push_back(line); }
        }
    } catch (const Error&) { return {}; }
    return scenes;
}

void writeList(const char* name, const std::vector<std::string>& scenes) {
    std::string text;
    for (const std::string& line : scenes) { text += line + "\n"; }
    OutputFiles files(viewFolder());
    writeText(files.staging() / name, text);
    files.publish();
}

}  // namespace

std::vector<std::string> withLatest(std::vector<std::string> scenes, const std::string& scene) {
    std::erase(scenes, scene);
    scenes.insert(scenes.begin(), scene);
    if (scenes.size() > kMostRecentScenes) { scenes.resize(kMostRecentScenes); }
    return scenes;
}

std::vector<std::string> recentScenes() { return readList(kRecentName, kMostRecentScenes); }

std::vector<std::string> favouriteScenes() { return readList(kFavouritesName, kMostFavourites); }

std::vector<std::string> favouriteAndRecentScenes() {
    std::vector<std::string> scenes = favouriteScenes();
    for (const std::string& scene : recentScenes()) {
        if (std::ranges::find(scenes, scene) == scenes.end()) { scenes.push_back(scene); }
    }
    return scenes;
}

void toggleFavourite(const std::string& scene) {
    if (scene.find('\n') != std::string::npos) { return; }  // it would be two lines
    std::vector<std::string> scenes = favouriteScenes();
    if (std::erase(scenes, scene) == 0) { scenes.push_back(scene); }
    writeList(kFavouritesName, scenes);
}

void rememberScene(const std::string& scene) {
    std::error_code error;
    const std::string whole =
        isBuiltin(scene) || isAddress(scene) ? scene : fs::absolute(scene, error).lexically_normal().string();
    check(!error, "{}: cannot be added to the recent scenes: the working directory no longer exists", scene);
    if (whole.find('\n') != std::string::npos) { return; }  // it would be two lines
    const std::vector<std::string> before = recentScenes(), after = withLatest(before, whole);
    if (after == before) { return; }
    writeList(kRecentName, after);
}

}  // namespace binosplat
