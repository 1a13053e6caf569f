// A text file with a path in each line.
#include "app/view/scenes/recent_scenes.h"

#include "app/view/view_files.h"
#include "engine/error.h"
#include "engine/scene/procedural.h"
#include "engine/setup/output_files.h"
#include "engine/setup/text_file.h"

#include <sstream>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr const char* kName = "recent-scenes.txt";

}  // namespace

std::vector<std::string> withLatest(std::vector<std::string> scenes, const std::string& scene) {
    std::erase(scenes, scene);
    scenes.insert(scenes.begin(), scene);
    if (scenes.size() > kMostRecentScenes) { scenes.resize(kMostRecentScenes); }
    return scenes;
}

std::vector<std::string> recentScenes() {
    std::vector<std::string> scenes;
    try {
        const fs::path file = viewFolder() / kName;
        std::error_code ignored;
        if (!fs::exists(file, ignored)) { return {}; }
        std::istringstream lines(readTextFile(file, "a list of scenes"));
        for (std::string line; std::getline(lines, line) && scenes.size() < kMostRecentScenes;) {
            if (!line.empty()) { scenes.push_back(line); }
        }
    } catch (const Error&) {  // a list that cannot be read is begun anew by the next scene
        return {};
    }
    return scenes;
}

void rememberScene(const std::string& scene) {
    std::error_code error;
    const std::string whole = isBuiltin(scene) ? scene : fs::absolute(scene, error).lexically_normal().string();
    check(!error, "{}: cannot be added to the recent scenes: the working directory no longer exists", scene);
    if (whole.find('\n') != std::string::npos) { return; }  // it would be two
    const std::vector<std::string> before = recentScenes(), after = withLatest(before, whole);
    if (after == before) { return; }
    std::string text;
    for (const std::string& line : after) { text += line + "\n"; }
    OutputFiles files(viewFolder());
    writeText(files.staging() / kName, text);
    files.publish();
}

}  // namespace binosplat
