// Lists folders.
#include "app/view/scenes/scene_list.h"

#include "app/view/scenes/natural_order.h"
#include "app/view/scenes/recent_scenes.h"
#include "app/view/scenes/scene_facts.h"
#include "app/view/scenes/view_scenes.h"
#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/platform.h"

#include <algorithm>
#include <filesystem>
#include <system_error>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

std::string troubleOf(const fs::path& place) {
    std::error_code error;
    if (!fs::exists(place, error)) { return error ? error.message() : "is not there"; }
    if (fs::is_directory(place, error)) {
        static_cast<void>(fs::directory_iterator(place, error));
        return error ? error.message() : "";
    }
    std::string reason;
    return openRegularFile(place, reason) ? "" : reason;
}

SceneList listBuiltinScenes() {
    SceneList list{"Built-in scenes", {}, {}, {}};
    for (const BuiltinInfo& info : listBuiltins()) {
        list.entries.push_back({std::string(info.name), "builtin:" + std::string(info.name), false, {}});
    }
    return list;
}

// They are not examined, since an empty or remote one may take long.
SceneList listDrives(const std::vector<fs::path>& roots) {
    SceneList list{"Drives", {}, {}, {}};
    for (const fs::path& root : roots) {
        list.entries.push_back(
            {(root.has_root_name() ? root.root_name() : root).string(), root.string(), true, {}});
    }
    return list;
}

// Without a trailing slash, which would count as an empty name.
fs::path wholePath(const fs::path& place) {
    std::error_code ignored;
    fs::path whole = fs::absolute(place, ignored).lexically_normal();
    return whole.has_filename() || !whole.has_relative_path() ? whole : whole.parent_path();
}

}  // namespace

std::string folderOf(const std::string& scene) {
    return isBuiltin(scene) || isAddress(scene) ? kBuiltinFolder : wholePath(scene).parent_path().string();
}

SceneList listFolder(const std::string& folder, const std::vector<fs::path>& roots) {
    if (folder == kBuiltinFolder) { return listBuiltinScenes(); }
    if (folder == kDrives) { return listDrives(roots); }
    const fs::path whole = wholePath(folder);
    SceneList list{whole.string(),
                   whole.has_relative_path() ? whole.parent_path().string()
                   : roots.size() > 1        ? kDrives
                                             : "",
                   {},
                   {}};
    std::error_code error;
    for (fs::directory_iterator entry(whole, error), end; !error && entry != end; entry.increment(error)) {
        const fs::path& place = entry->path();
        const std::string name = place.filename().string();
        std::error_code ignored;
        const bool is_scene = looksLikeScene(place),
                   is_folder = !is_scene && fs::is_directory(place, ignored);
        if (name.starts_with('.') || (!is_scene && !is_folder)) { continue; }
        list.entries.push_back({name, place.string(), is_folder, troubleOf(place)});
    }
    if (error) { list.trouble = error.message(); }
    std::ranges::sort(list.entries, [](const SceneEntry& a, const SceneEntry& b) {
        return a.is_folder != b.is_folder ? a.is_folder : comesBefore(a.name, b.name);
    });
    return list;
}

void describeScenes(SceneList& list) {
    const std::vector<std::string> favourites = favouriteScenes();
    for (SceneEntry& entry : list.entries) {
        if (entry.is_folder) { continue; }
        entry.is_favourite = std::ranges::find(favourites, entry.place) != favourites.end();
        SeenScene seen = findSeenScene(entry.place);
        entry.picture = std::move(seen.picture);
        entry.about = std::move(seen.about);
        std::error_code error;
        if (!entry.about.empty() || isBuiltin(entry.place) || !fs::is_regular_file(entry.place, error)) {
            continue;
        }
        if (const std::uintmax_t bytes = fs::file_size(entry.place, error); !error) {
            entry.about = inMib(bytes);
        }
    }
    std::ranges::stable_partition(list.entries, &SceneEntry::is_favourite);
}

SceneList listScenes(const std::string& title, const std::vector<std::string>& scenes) {
    SceneList list{title, {}, {}, {}};
    for (const std::string& scene : scenes) {
        const bool on_disk = !isBuiltin(scene) && !isAddress(scene);
        list.entries.push_back({on_disk ? wholePath(scene).filename().string() : scene, scene, false,
                                on_disk ? troubleOf(scene) : ""});
    }
    return list;
}

}  // namespace binosplat
