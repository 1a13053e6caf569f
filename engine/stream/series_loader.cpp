// Which frame is read next, and which one makes room for it.
#include "engine/stream/series_loader.h"

#include "engine/error.h"

#include <algorithm>
#include <utility>

namespace binosplat {

SeriesLoader::SeriesLoader(Load load, std::size_t scenes, const SceneTraits& traits, const Settings& settings)
    : load_(std::move(load)), traits_(traits), settings_(settings), reading_(scenes, false) {
    for (int i = 0; i < settings.threads; ++i) {
        threads_.emplace_back([this] { run(); });
    }
}

SeriesLoader::~SeriesLoader() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    wanted_changed_.notify_all();
    for (std::thread& thread : threads_) { thread.join(); }
}

bool SeriesLoader::tryWant(const std::vector<std::size_t>& scenes) {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) { return false; }
    wanted_ = scenes;
    wanted_changed_.notify_all();
    return true;
}

SeriesLoader::Frame SeriesLoader::tryGet(std::size_t scene) const {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) { return nullptr; }
    const auto found = kept_.find(scene);
    return found == kept_.end() ? nullptr : found->second.frame;
}

bool SeriesLoader::isSurelyBroken(std::size_t scene) const {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock && troubles_.contains(scene);
}

SeriesLoader::Frame SeriesLoader::get(std::size_t scene) {
    std::unique_lock lock(mutex_);
    for (;;) {
        if (const auto found = kept_.find(scene); found != kept_.end()) { return found->second.frame; }
        if (const auto trouble = troubles_.find(scene); trouble != troubles_.end()) {
            trouble->second.said = true;
            fail("{}", trouble->second.what);
        }
        if (orderOf(scene) != 0) {
            std::erase(wanted_, scene);
            wanted_.insert(wanted_.begin(), scene);
            wanted_changed_.notify_all();
        }
        news_.wait(lock);
    }
}

std::vector<std::string> SeriesLoader::linesOf() {
    std::vector<std::string> lines;
    for (auto& [scene, trouble] : troubles_) {
        if (!std::exchange(trouble.said, true)) { lines.push_back(trouble.what); }
    }
    return lines;
}

std::vector<std::string> SeriesLoader::takeLines() {
    const std::lock_guard lock(mutex_);
    return linesOf();
}

std::vector<std::string> SeriesLoader::tryTakeLines() {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? linesOf() : std::vector<std::string>();
}

std::uint64_t SeriesLoader::bytesKept() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
}

std::size_t SeriesLoader::orderOf(std::size_t scene) const {
    return static_cast<std::size_t>(std::ranges::find(wanted_, scene) - wanted_.begin());
}

std::optional<std::size_t> SeriesLoader::next() {
    const auto found = std::ranges::find_if(
        wanted_, [&](std::size_t scene) { return !kept_.contains(scene) && !troubles_.contains(scene) && !reading_[scene]; });
    if (found == wanted_.end()) { return std::nullopt; }
    const auto order = static_cast<std::size_t>(found - wanted_.begin());
    // Scenes that are being read have no bytes yet.
    const auto under_way = static_cast<std::uint64_t>(std::ranges::count(reading_, true));
    while (bytes_ + (under_way + 1) * largest_ > settings_.most_bytes) {
        const auto last = std::ranges::max_element(kept_, {}, [&](const auto& kept) { return orderOf(kept.first); });
        if (last != kept_.end() && orderOf(last->first) > order && orderOf(last->first) >= kLeastKept) {
            bytes_ -= last->second.bytes;
            kept_.erase(last);
        } else if (order < kLeastKept) {
            break;
        } else {
            return std::nullopt;
        }
    }
    return *found;
}

void SeriesLoader::run() {
    std::unique_lock lock(mutex_);
    for (;;) {
        std::optional<std::size_t> scene;
        wanted_changed_.wait(lock, [&] { return stops_ || (scene = next()); });
        if (stops_) { return; }
        reading_[*scene] = true;
        // Much of a scene stays as it was.
        const auto before = kept_.find(*scene == 0 ? reading_.size() - 1 : *scene - 1);
        const Frame like = before == kept_.end() ? nullptr : before->second.frame;
        lock.unlock();
        Kept kept;
        std::string trouble;
        try {
            const SceneFrame none;
            SceneFrame frame = makeSceneFrame(load_(*scene), traits_, like ? *like : none);
            kept.bytes = bytesIn(frame, like ? *like : none);
            kept.frame = std::make_shared<const SceneFrame>(std::move(frame));
        } catch (const Error& error) { trouble = error.what(); } catch (const std::bad_alloc&) {
            trouble = "a frame of the moving scene does not fit into memory";
        }
        lock.lock();
        reading_[*scene] = false;
        if (kept.frame) {
            bytes_ += kept.bytes;
            largest_ = std::max(largest_, kept.bytes);
            kept_.emplace(*scene, std::move(kept));
        } else {
            troubles_.emplace(*scene, Trouble{trouble, false});
        }
        news_.notify_all();
        wanted_changed_.notify_all();
    }
}

}  // namespace binosplat
