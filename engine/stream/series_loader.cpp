// Which frame is read next, and which one is dropped for it.
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

SeriesLoader::Held SeriesLoader::hold(std::size_t scene) const {
    const auto found = kept_.find(scene);
    if (found == kept_.end()) { return nullptr; }
    ++found->second.holders;
    return Held(&found->second);
}

SeriesLoader::Held SeriesLoader::tryGet(std::size_t scene) const {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock ? hold(scene) : nullptr;
}

bool SeriesLoader::isSurelyBroken(std::size_t scene) const {
    const std::unique_lock lock(mutex_, std::try_to_lock);
    return lock && troubles_.contains(scene);
}

SeriesLoader::Held SeriesLoader::get(std::size_t scene) {
    std::unique_lock lock(mutex_);
    for (;;) {
        if (Held held = hold(scene)) { return held; }
        if (const auto trouble = troubles_.find(scene); trouble != troubles_.end()) {
            trouble->second.said = true;
            fail("{}", trouble->second.what);
        }
        if (wanted_.empty() || wanted_.front() != scene) {
            std::erase(wanted_, scene);
            wanted_.insert(wanted_.begin(), scene);
            wanted_changed_.notify_all();
        }
        news_.wait(lock);
    }
}

std::vector<std::string> SeriesLoader::takeLines(Waits waits) {
    const std::unique_lock lock = lockOf(mutex_, waits);
    if (!lock) { return {}; }
    std::vector<std::string> lines;
    for (auto& [scene, trouble] : troubles_) {
        if (!std::exchange(trouble.said, true)) { lines.push_back(trouble.what); }
    }
    return lines;
}

std::uint64_t SeriesLoader::bytesKept() const {
    const std::lock_guard lock(mutex_);
    return bytes_;
}

std::size_t SeriesLoader::orderOf(std::size_t scene) const {
    return static_cast<std::size_t>(std::ranges::find(wanted_, scene) - wanted_.begin());
}

std::optional<std::size_t> SeriesLoader::next() {
    const auto found = std::ranges::find_if(wanted_, [&](std::size_t scene) {
        return !kept_.contains(scene) && !troubles_.contains(scene) && !reading_[scene];
    });
    if (found == wanted_.end()) { return std::nullopt; }
    const auto order = static_cast<std::size_t>(found - wanted_.begin());
    // Scenes that are being read have no bytes yet.
    const auto under_way = static_cast<std::uint64_t>(std::ranges::count(reading_, true));
    while (bytes_ + (under_way + 1) * largest_ > settings_.most_bytes) {
        const auto orderToGo = [&](const auto& kept) {
            return kept.second.holders > 0 ? 0 : orderOf(kept.first);
        };
        const auto last = std::ranges::max_element(kept_, {}, orderToGo);
        if (last != kept_.end() && orderToGo(*last) > order && orderToGo(*last) >= kLeastKept) {
            bytes_ -= bytesIn(last->second.splats);
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
        lock.unlock();
        std::optional<SceneFrame> splats;
        std::string trouble;
        try {
            splats = makeSceneFrame(load_(*scene), traits_);
        } catch (const std::bad_alloc&) {
            trouble = "a frame of the moving scene does not fit into memory";
        } catch (const std::exception& error) { trouble = error.what(); }
        lock.lock();
        reading_[*scene] = false;
        if (splats) {
            bytes_ += bytesIn(*splats);
            largest_ = std::max(largest_, bytesIn(*splats));
            kept_[*scene].splats = *std::move(splats);
        } else {
            troubles_.emplace(*scene, Trouble{trouble, false});
        }
        news_.notify_all();
        wanted_changed_.notify_all();
    }
}

}  // namespace binosplat
