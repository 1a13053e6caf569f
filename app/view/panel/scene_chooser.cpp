// From folder to folder.
#include "app/view/panel/scene_chooser.h"

#include "app/view/scenes/recent_scenes.h"

#include <algorithm>

namespace binosplat {

void SceneChooser::showFolder(const std::string& folder) {
    folder_ = folder;
    recent_ = false;
    list_ = listFolder(folder);
    page_ = 0;
}

void SceneChooser::showRecent() {
    recent_ = true;
    list_ = listScenes("Recent scenes", recentScenes());
    page_ = 0;
}

void SceneChooser::goUp() {
    if (!list_.above.empty()) { showFolder(list_.above); }
}

void SceneChooser::refresh(const std::string& scene) {
    const std::size_t page = page_;
    if (recent_) {
        showRecent();
    } else {
        showFolder(folder_.empty() ? folderOf(scene) : folder_);
    }
    page_ = std::min(page, pageCount() - 1);
}

void SceneChooser::turn(int pages) {
    const auto last = static_cast<std::ptrdiff_t>(pageCount()) - 1;
    page_ = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(page_) + pages, 0, last));
}

std::string SceneChooser::open(const SceneEntry& entry) {
    if (!entry.trouble.empty()) { return {}; }
    if (!entry.is_folder) { return entry.place; }
    showFolder(std::string(entry.place));  // `entry` goes with the list
    return {};
}

std::span<const SceneEntry> SceneChooser::shown() const {
    const std::size_t first = std::min(page_ * kRows, list_.entries.size());
    return std::span(list_.entries).subspan(first, std::min(kRows, list_.entries.size() - first));
}

std::size_t SceneChooser::pageCount() const { return std::max<std::size_t>((list_.entries.size() + kRows - 1) / kRows, 1); }

}  // namespace binosplat
