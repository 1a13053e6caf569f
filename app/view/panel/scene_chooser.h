// Chooses a scene on the panel: the open folder, and the part of it that is shown. It does not read folders
// itself; see takeWish().
#pragma once

#include "app/view/scenes/scene_list.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace binosplat {

// A request for a list.
struct SceneListWish {
    bool recent = false;       // the favourites, and the scenes shown last; otherwise
    std::string folder;        // see listFolder
    std::uint64_t number = 0;  // only the latest one counts

    [[nodiscard]] const char* name() const { return recent ? "the recent scenes" : folder.c_str(); }
};

// On any thread: reads folders, and opens files in them.
SceneList makeSceneList(const SceneListWish& wish);

class SceneChooser {
public:
    static constexpr std::size_t kRows = 6;

    // Opens a folder, or kBuiltinFolder.
    void showFolder(const std::string& folder);
    void showRecent() { showAnother(true, "Favourites and recent scenes"); }
    void goUp();
    // Reopens what was opened last; the first time, the folder of `scene`.
    void refresh(const std::string& scene);
    // True if nothing has been opened yet.
    [[nodiscard]] bool isNew() const { return !wish_.recent && wish_.folder.empty(); }
    // Turns `pages` pages of kRows entries forwards or, below 0, back.
    void turn(int pages);
    // Opens an entry that is a folder; returns the place of a scene to load, otherwise empty.
    [[nodiscard]] std::string open(const SceneEntry& entry);

    // The list that it needs, returned once; answer with show().
    [[nodiscard]] std::optional<SceneListWish> takeWish();
    void show(SceneList list, const SceneListWish& wish);
    // True until the list is loaded.
    [[nodiscard]] bool isReading() const { return is_reading_; }

    [[nodiscard]] const SceneList& list() const { return list_; }
    [[nodiscard]] std::span<const SceneEntry> shown() const;
    [[nodiscard]] std::size_t page() const { return page_; }
    [[nodiscard]] std::size_t pageCount() const;

private:
    void showAnother(bool recent, const std::string& title);
    void want();

    SceneList list_;
    SceneListWish wish_;  // the latest; its folder is the one opened last, if any
    bool is_reading_ = false, is_wish_new_ = false;
    std::size_t page_ = 0;
};

}  // namespace binosplat
