// Moves from folder to folder.
#include "app/view/panel/scene_chooser.h"

#include "app/view/scenes/recent_scenes.h"

#include <algorithm>
#include <utility>

namespace binosplat {

SceneList makeSceneList(const SceneListWish& wish) {
    SceneList list = wish.recent ? listScenes("Favourites and recent scenes", favouriteAndRecentScenes())
                                 : listFolder(wish.folder);
    describeScenes(list);
    return list;
}

void SceneChooser::showFolder(const std::string& folder) {
    wish_.folder = folder;
    showAnother(false, folder);
}

void SceneChooser::showAnother(bool recent, const std::string& title) {
    wish_.recent = recent;
    list_ = {title, {}, {}, {}};
    page_ = 0;
    want();
}

void SceneChooser::want() {
    ++wish_.number;
    is_reading_ = is_wish_new_ = true;
}

std::optional<SceneListWish> SceneChooser::takeWish() {
    return std::exchange(is_wish_new_, false) ? std::optional(wish_) : std::nullopt;
}

void SceneChooser::show(SceneList list, const SceneListWish& wish) {
    if (wish.number != wish_.number) { return; }
    list_ = std::move(list);
    page_ = std::min(page_, pageCount() - 1);
    is_reading_ = false;
}

void SceneChooser::goUp() {
    if (!list_.above.empty()) { showFolder(list_.above); }
}

void SceneChooser::refresh(const std::string& scene) {
    if (isNew()) { return showFolder(folderOf(scene)); }
    want();  // the old list stays until the new one is loaded
}

void SceneChooser::turn(int pages) {
    const auto last = static_cast<std::ptrdiff_t>(pageCount()) - 1;
    page_ = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(static_cast<std::ptrdiff_t>(page_) + pages, 0, last));
}

std::string SceneChooser::open(const SceneEntry& entry) {
    if (!entry.trouble.empty()) { return {}; }
    if (!entry.is_folder) { return entry.place; }
    showFolder(std::string(entry.place));  // a copy, since `entry` goes with the list
    return {};
}

std::span<const SceneEntry> SceneChooser::shown() const {
    const std::size_t first = std::min(page_ * kRows, list_.entries.size());
    return std::span(list_.entries).subspan(first, std::min(kRows, list_.entries.size() - first));
}

std::size_t SceneChooser::pageCount() const {
    return std::max<std::size_t>((list_.entries.size() + kRows - 1) / kRows, 1);
}

}  // namespace binosplat
