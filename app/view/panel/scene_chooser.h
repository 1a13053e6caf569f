// Looking for a scene on the panel: which folder is open, which part of it is shown. It reads no folder itself, see takeWish().
#pragma once

#include "app/view/scenes/scene_list.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace binosplat {

// A list that somebody wants to see.
struct SceneListWish {
    bool recent = false;       // the scenes that were shown last; otherwise
    std::string folder;        // see listFolder
    std::uint64_t number = 0;  // the latest one counts

    [[nodiscard]] const char* name() const { return recent ? "the recent scenes" : folder.c_str(); }
};

// On any thread: reads folders, and opens what lies in them.
SceneList makeSceneList(const SceneListWish& wish);

class SceneChooser {
public:
    static constexpr std::size_t kRows = 6;

    // Looks into a folder, or kBuiltinFolder.
    void showFolder(const std::string& folder);
    void showRecent() { showAnother(true, "Recent scenes"); }
    void goUp();
    // Looks again where it looked last; the first time where `scene` lies.
    void refresh(const std::string& scene);
    // Nothing was looked at yet.
    [[nodiscard]] bool isNew() const { return !wish_.recent && wish_.folder.empty(); }
    // The next kRows entries, or those before.
    void turn(int pages);
    // Looks into an entry of the list that is a folder; the place of a scene to load, else empty.
    [[nodiscard]] std::string open(const SceneEntry& entry);

    // The list that it wants to see, once; show() brings it.
    [[nodiscard]] std::optional<SceneListWish> takeWish();
    void show(SceneList list, const SceneListWish& wish);
    // Until then.
    [[nodiscard]] bool isReading() const { return is_reading_; }

    [[nodiscard]] const SceneList& list() const { return list_; }
    [[nodiscard]] std::span<const SceneEntry> shown() const;
    [[nodiscard]] std::size_t page() const { return page_; }
    [[nodiscard]] std::size_t pageCount() const;

private:
    void showAnother(bool recent, const std::string& title);
    void want();

    SceneList list_;
    SceneListWish wish_;  // the latest; its folder is the one that was looked into last, if any was
    bool is_reading_ = false, is_wish_new_ = false;
    std::size_t page_ = 0;
};

}  // namespace binosplat
