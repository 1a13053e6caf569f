// Changes of the list are written beside the frames.
#include "app/view/scenes/viewpoint_list.h"

#include "engine/error.h"

#include <algorithm>
#include <utility>

namespace binosplat {

namespace {

constexpr const char* kNone =
    "this scene has no viewpoints: keep one on the page Scenes, or put a cameras.json beside it";

bool areSame(const View& a, const View& b) { return a.eye == b.eye && a.look == b.look && a.up == b.up; }

// In the coordinates of the scene's file.
std::vector<Viewpoint> ownOnes(const LoadedScene& scene) {
    std::vector<Viewpoint> own;
    for (Viewpoint viewpoint : scene.viewpoints) {
        if (!viewpoint.is_own) { continue; }
        viewpoint.view.eye += scene.origin, viewpoint.view.look += scene.origin;
        own.push_back(std::move(viewpoint));
    }
    return own;
}

}  // namespace

void ViewpointList::show(LoadedScene* scene) {
    scene_ = scene;
    at_.reset();
    endTour();
}

const Viewpoint* ViewpointList::go(std::size_t index) {
    if (scene_ == nullptr) { return nullptr; }
    if (index >= count()) {
        say_(count() == 0 ? kNone : fmt::format("this scene has {} viewpoints", count()));
        return nullptr;
    }
    at_ = index;
    return current();
}

const Viewpoint* ViewpointList::goBy(int step) {
    if (count() == 0) { return go(0); }
    const auto all = static_cast<std::ptrdiff_t>(count());
    const std::ptrdiff_t before = at_ ? static_cast<std::ptrdiff_t>(*at_) : step > 0 ? -1 : 0;
    return go(static_cast<std::size_t>(((before + step) % all + all) % all));
}

std::string ViewpointList::words() const {
    return at_ ? fmt::format("viewpoint {} of {}: {}", *at_ + 1, count(), current()->name) : std::string();
}

void ViewpointList::keep(const View& view) {
    if (scene_ == nullptr) { return; }
    std::vector<Viewpoint>& all = scene_->viewpoints;
    const auto isTaken = [&](const std::string& name) {
        return std::ranges::find(all, name, &Viewpoint::name) != all.end();
    };
    auto number = 1 + std::ranges::count_if(all, &Viewpoint::is_own);
    while (isTaken(fmt::format("your own {}", number))) { ++number; }
    all.push_back({fmt::format("your own {}", number), view, true});
    at_ = all.size() - 1;
    save("this viewpoint is kept");
}

bool ViewpointList::requireOwn() {
    if (current() != nullptr && current()->is_own) { return true; }
    say_("go to one of your own viewpoints first: those of a cameras.json stay as they are");
    return false;
}

void ViewpointList::rename(const std::string& name) {
    if (name.empty() || !requireOwn()) { return; }
    scene_->viewpoints[*at_].name = name;
    save("this viewpoint is called " + name);
}

void ViewpointList::moveBy(int step) {
    if (!requireOwn()) { return; }
    std::vector<Viewpoint>& all = scene_->viewpoints;
    const std::ptrdiff_t to = static_cast<std::ptrdiff_t>(*at_) + step;
    if (to < 0 || to >= static_cast<std::ptrdiff_t>(all.size()) ||
        !all[static_cast<std::size_t>(to)].is_own) {
        return;
    }
    std::swap(all[*at_], all[static_cast<std::size_t>(to)]);
    at_ = static_cast<std::size_t>(to);
    save(words());
}

void ViewpointList::forget() {
    if (!requireOwn()) { return; }
    const std::string name = current()->name;
    scene_->viewpoints.erase(scene_->viewpoints.begin() + static_cast<std::ptrdiff_t>(*at_));
    at_.reset();
    endTour();
    save(name + " is forgotten");
}

void ViewpointList::save(const std::string& outcome) {
    files_.write("keeping viewpoints",
                 [this, outcome, source = scene_->name, own = ownOnes(*scene_)]() -> FileWorker::Done {
                     std::string said = outcome;
                     try {
                         keepViewpoints(source, own);
                     } catch (const Error& error) { said = error.what(); }
                     return [this, said] { say_(said); };
                 });
}

void ViewpointList::writeShared() {
    if (scene_ == nullptr) { return; }
    const std::vector<Viewpoint> own = ownOnes(*scene_);
    if (own.empty()) { return say_("there are no viewpoints of your own to share: keep one first"); }
    files_.write("sharing viewpoints", [this, source = scene_->name, own]() -> FileWorker::Done {
        std::string said;
        try {
            const std::filesystem::path file = sharedViewpoints(source);
            writeViewpoints(file, own);
            said = fmt::format("{} viewpoints are in {}", own.size(), file.string());
        } catch (const Error& error) { said = error.what(); }
        return [this, said] { say_(said); };
    });
}

void ViewpointList::read(std::string file) {
    if (scene_ == nullptr) { return; }
    files_.read("reading viewpoints",
                [this, file = std::move(file), source = scene_->name]() -> FileWorker::Done {
                    std::string from = file, trouble;
                    std::vector<Viewpoint> found;
                    try {
                        if (from.empty()) { from = sharedViewpoints(source).string(); }
                        found = readViewpoints(from);
                    } catch (const Error& error) { trouble = error.what(); }
                    return [this, source, from, trouble, found] {
                        if (!trouble.empty()) { return say_(trouble); }
                        // Otherwise another scene came meanwhile.
                        if (scene_ != nullptr && scene_->name == source) { add(found, from); }
                    };
                });
}

bool ViewpointList::take(const std::string& file) {
    if (!file.ends_with(".viewpoints.json")) { return false; }
    read(file);
    return true;
}

void ViewpointList::add(const std::vector<Viewpoint>& read, const std::string& file) {
    std::size_t added = 0;
    for (Viewpoint viewpoint : read) {
        viewpoint.view.eye -= scene_->origin, viewpoint.view.look -= scene_->origin;
        const auto isIt = [&](const Viewpoint& other) { return areSame(other.view, viewpoint.view); };
        if (std::ranges::any_of(scene_->viewpoints, isIt)) { continue; }
        scene_->viewpoints.push_back(std::move(viewpoint));
        ++added;
    }
    const std::string outcome =
        fmt::format("{} viewpoints from {}, {} of them new", read.size(), file, added);
    added > 0 ? save(outcome) : say_(outcome);
}

void ViewpointList::toggleTour() {
    if (isTouring()) { return endTour(); }
    if (count() == 0) { return say_(kNone); }
    tour_.emplace();
}

const Viewpoint* ViewpointList::pass(double seconds, bool is_there) {
    if (!tour_) { return nullptr; }
    tour_->rested_s = is_there ? tour_->rested_s + seconds : 0.0;
    if (tour_->rested_s < kRestSeconds) { return nullptr; }
    if (tour_->next >= count()) {
        endTour();
        say_("the tour is over");
        return nullptr;
    }
    tour_->rested_s = 0.0;
    return go(tour_->next++);
}

}  // namespace binosplat
