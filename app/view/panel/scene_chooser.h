// Looking for a scene on the panel: which folder is open, which part of it is shown.
#pragma once

#include "app/view/scenes/scene_list.h"

#include <cstddef>
#include <span>
#include <string>

namespace binosplat {

class SceneChooser {
public:
    static constexpr std::size_t kRows = 12;

    // Looks into a folder, or kBuiltinFolder.
    void showFolder(const std::string& folder);
    void showRecent();
    void goUp();
    // Looks again where it looked last; the first time where `scene` lies.
    void refresh(const std::string& scene);
    // The next kRows entries, or those before.
    void turn(int pages);
    // Looks into an entry of the list that is a folder; the place of a scene to load, else empty.
    [[nodiscard]] std::string open(const SceneEntry& entry);

    [[nodiscard]] const SceneList& list() const { return list_; }
    [[nodiscard]] std::span<const SceneEntry> shown() const;
    [[nodiscard]] std::size_t page() const { return page_; }
    [[nodiscard]] std::size_t pageCount() const;

private:
    SceneList list_;
    std::string folder_;
    bool recent_ = false;
    std::size_t page_ = 0;
};

}  // namespace binosplat
