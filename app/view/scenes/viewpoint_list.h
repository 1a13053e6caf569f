// The viewpoints of the scene that is shown: which one people are at, what they do with the list, and a tour
// through it.
#pragma once

#include "app/view/files/file_worker.h"
#include "app/view/scenes/scene_notes.h"

#include <optional>
#include <string>

namespace binosplat {

class ViewpointList {
public:
    // How long a tour rests at each, once it is there.
    static constexpr double kRestSeconds = 1.5;

    // Both must outlive this.
    ViewpointList(FileWorker& files, Say say) : files_(files), say_(std::move(say)) {}

    // Another scene is shown, or none (null); it must exist until the next call.
    void show(LoadedScene* scene);
    [[nodiscard]] std::size_t count() const { return scene_ == nullptr ? 0 : scene_->viewpoints.size(); }
    // The one gone to last, if any.
    [[nodiscard]] std::optional<std::size_t> at() const { return at_; }
    [[nodiscard]] const Viewpoint* current() const { return at_ ? &scene_->viewpoints[*at_] : nullptr; }

    // Each of these returns where to go now; null: nowhere. The first takes a number, the other goes this
    // many further on, wrapping around.
    const Viewpoint* go(std::size_t index);
    const Viewpoint* goBy(int step);
    // "viewpoint 2 of 3: door".
    [[nodiscard]] std::string words() const;

    // True if the current one is somebody's own; says so if not.
    [[nodiscard]] bool requireOwn();
    // Keeps a view, with a name of its own; and what is done with the current one, if it is one of those.
    void keep(const View& view);
    void rename(const std::string& name);
    void moveBy(int step);
    void forget();
    // For others, as a file; see sharedViewpoints.
    void writeShared();
    // Adds those of a file that are not there yet; with no file, those of the shared one.
    void read(std::string file);
    // Reads a file that may be anything; false if it is none of viewpoints, by its name.
    bool take(const std::string& file);

    // A tour begins with the first, or ends.
    void toggleTour();
    void endTour() { tour_.reset(); }
    [[nodiscard]] bool isTouring() const { return tour_.has_value(); }
    // `is_there`: not on the way to one. Where the tour goes now, if it is time; null: nowhere yet, or it has
    // ended.
    const Viewpoint* pass(double seconds, bool is_there);

private:
    void save(const std::string& outcome);
    void add(const std::vector<Viewpoint>& read, const std::string& file);

    FileWorker& files_;
    Say say_;
    LoadedScene* scene_ = nullptr;
    std::optional<std::size_t> at_;
    struct Tour {
        std::size_t next = 0;
        double rested_s = kRestSeconds;
    };
    std::optional<Tour> tour_;
};

}  // namespace binosplat
