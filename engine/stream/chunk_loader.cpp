// Loads one file after another, with all its requested parts.
#include "engine/stream/chunk_loader.h"

#include "engine/error.h"
#include "engine/files/scene_builder.h"
#include "engine/parallel.h"

#include <algorithm>
#include <array>
#include <exception>
#include <iterator>
#include <numeric>
#include <utility>

namespace binosplat {

namespace {

struct Cancelled {};

// This many files are requested before their turn.
constexpr std::size_t kFilesAhead = 8;
// After this long, it is reported again that a server does not answer.
constexpr std::chrono::seconds kForgotten(10);
// Parts that are read together, before checking which of the others are still wanted.
constexpr std::size_t kPartsAtOnce = 8;

}  // namespace

ChunkLoader::ChunkLoader(std::unique_ptr<ChunkSource> source, LoaderSettings settings)
    : source_(std::move(source)),
      settings_(std::move(settings)),
      pause_(settings_.first_pause),
      troubles_(source_->fileCount()) {
    source_->callWhileWaiting([this](double) {
        const std::lock_guard lock(mutex_);
        if (stops_) { throw Cancelled(); }
    });
    thread_ = std::thread([this] { run(); });
}

ChunkLoader::~ChunkLoader() {
    {
        const std::lock_guard lock(mutex_);
        stops_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

bool ChunkLoader::want(std::vector<LeafLevel> coarsest, std::vector<LeafLevel> finer, Waits waits) {
    const std::unique_lock lock = lockOf(mutex_, waits);
    if (!lock) { return false; }
    coarsest_ = std::move(coarsest);
    finer_ = std::move(finer);
    for (const LoadedPart& part : done_) { removeWish(part.at); }
    changed_.notify_all();
    return true;
}

std::vector<LoadedPart> ChunkLoader::take(Waits waits) {
    const std::unique_lock lock = lockOf(mutex_, waits);
    if (!lock) { return {}; }
    std::vector<LoadedPart> taken(std::make_move_iterator(done_.begin()),
                                  std::make_move_iterator(done_.end()));
    done_.clear();
    done_splats_ = 0;
    changed_.notify_all();
    return taken;
}

std::vector<std::string> ChunkLoader::takeLines(Waits waits) {
    const std::unique_lock lock = lockOf(mutex_, waits);
    return lock ? std::exchange(lines_, {}) : std::vector<std::string>();
}

std::optional<std::vector<bool>> ChunkLoader::brokenFiles(Waits waits) const {
    const std::unique_lock lock = lockOf(mutex_, waits);
    if (!lock) { return std::nullopt; }
    std::vector<bool> broken;
    for (const Trouble& trouble : troubles_) { broken.push_back(trouble.broken); }
    return broken;
}

bool ChunkLoader::isDone(Waits waits) const {
    const std::unique_lock lock = lockOf(mutex_, waits);
    return lock && done_.empty() && !nextFile();
}

std::optional<LoaderWork> ChunkLoader::tryWork() const {
    const std::unique_lock lock = lockOf(mutex_, Waits::kNever);
    return lock ? std::optional(work_) : std::nullopt;
}

bool ChunkLoader::waitForNews(std::chrono::milliseconds most) const {
    std::unique_lock lock(mutex_);
    const bool came = news_.wait_for(
        lock, most, [&] { return !done_.empty() || news_count_ != news_seen_ || !nextFile(); });
    news_seen_ = news_count_;
    return came;
}

std::optional<std::size_t> ChunkLoader::nextFile() const {
    for (const std::vector<LeafLevel>* wishes : {&coarsest_, &finer_}) {
        for (const LeafLevel at : *wishes) {
            if (const std::size_t file = rangeOf(at).file; !troubles_[file].broken) { return file; }
        }
    }
    return std::nullopt;
}

std::vector<LeafLevel> ChunkLoader::wishesIn(std::size_t file) const {
    std::vector<LeafLevel> all;
    for (const std::vector<LeafLevel>* wishes : {&coarsest_, &finer_}) {
        std::ranges::copy_if(*wishes, std::back_inserter(all),
                             [&](LeafLevel at) { return rangeOf(at).file == file; });
        const bool is_any_left = std::ranges::any_of(*wishes, [&](LeafLevel at) {
            return rangeOf(at).file != file && !troubles_[rangeOf(at).file].broken;
        });
        if (is_any_left) { break; }  // finer levels have their turn later
    }
    return all;
}

std::vector<std::size_t> ChunkLoader::filesAhead() const {
    std::vector<std::size_t> files;
    for (const std::vector<LeafLevel>* wishes : {&coarsest_, &finer_}) {
        for (const LeafLevel at : *wishes) {
            const std::size_t file = rangeOf(at).file;
            if (files.size() < kFilesAhead && !troubles_[file].broken &&
                std::ranges::find(files, file) == files.end()) {
                files.push_back(file);
            }
        }
    }
    return files;
}

bool ChunkLoader::isWished(LeafLevel at) const {
    return std::ranges::find(coarsest_, at) != coarsest_.end() ||
           std::ranges::find(finer_, at) != finer_.end();
}

void ChunkLoader::removeWish(LeafLevel at) {
    std::erase(coarsest_, at);
    std::erase(finer_, at);
}

void ChunkLoader::forgetTroubles() {
    const Clock::time_point now = Clock::now();
    for (Trouble& trouble : troubles_) {
        if (!trouble.again || *trouble.again > now) { continue; }
        trouble = {.is_said = trouble.is_said, .again = {}};
        ++news_count_;
    }
}

std::optional<ChunkLoader::Clock::time_point> ChunkLoader::nextAttempt() const {
    std::optional<Clock::time_point> first;
    for (const Trouble& trouble : troubles_) {
        if (trouble.again && (!first || *trouble.again < *first)) { first = trouble.again; }
    }
    return first;
}

void ChunkLoader::run() {
    std::unique_lock lock(mutex_);
    while (!stops_) {
        forgetTroubles();
        const std::optional<std::size_t> file = nextFile();
        if (!file) {
            news_.notify_all();
            if (const auto again = nextAttempt()) {
                changed_.wait_until(lock, *again);
            } else {
                changed_.wait(lock);
            }
            continue;
        }
        const std::vector<LeafLevel> wishes = wishesIn(*file);
        const std::vector<std::size_t> ahead = filesAhead();
        lock.unlock();
        const std::uint64_t failed_before = source_->failedFetches();
        try {
            source_->expect(ahead);
            load(*file, wishes);
        } catch (const Cancelled&) {  // the loop ends
        } catch (const Error& error) {
            meetTrouble(*file, error.what(), source_->failedFetches() != failed_before);
        } catch (const std::bad_alloc&) {
            meetTrouble(*file,
                        fmt::format("{}: a chunk needs more memory than this machine gives", source_->name()),
                        false);
        } catch (const std::exception& error) {
            meetTrouble(*file, fmt::format("{}: {}", source_->name(), error.what()), false);
        }
        lock.lock();
    }
}

void ChunkLoader::meetTrouble(std::size_t file, const std::string& why, bool may_pass) {
    const std::lock_guard lock(mutex_);
    Trouble& trouble = troubles_[file];
    const bool says = !trouble.is_said && !(may_pass && said_gone_);
    trouble.is_said = trouble.is_said || says;
    said_gone_ = said_gone_ || (may_pass && says);
    if (may_pass) {
        came_since_ = 0;
        failed_at_ = Clock::now();
    }
    trouble.broken = true;
    if (may_pass) {
        trouble.again = Clock::now() + pause_;
        pause_ = std::min<Clock::duration>(2 * pause_, settings_.most_pause);
    }
    if (says) { lines_.push_back(why + "; what is there stays"); }
    ++news_count_;
    news_.notify_all();
}

const ChunkLoader::Decoded& ChunkLoader::decode(std::size_t file) {
    const auto there = std::ranges::find(decoded_, file, &Decoded::file);
    if (there != decoded_.end()) {
        std::rotate(decoded_.begin(), there, there + 1);
        return decoded_.front();
    }
    SogSplats splats = source_->open(file);
    splats.expect();
    splats.requirePlausibleCount();
    // Frees memory first: the kept files are not needed for the next one.
    while (!decoded_.empty() && decoded_.size() >= settings_.kept_files) { decoded_.pop_back(); }
    SogPictures pictures = splats.decode(settings_.threads);
    decoded_.push_front({file, std::move(splats), std::move(pictures)});
    pause_ = settings_.first_pause;
    // Files that were requested ahead may still fail as earlier ones did.
    if (++came_since_ > kFilesAhead || Clock::now() - failed_at_ > kForgotten) { said_gone_ = false; }
    const std::lock_guard lock(mutex_);
    troubles_[file].is_said = false;
    return decoded_.front();
}

LoadedPart ChunkLoader::read(const Decoded& decoded, LeafLevel at) const {
    const SplatRange range = rangeOf(at).splats;
    source_->requireRange(decoded.file, range, decoded.splats);
    SceneBuilder builder(source_->name(), range.count, decoded.splats.shDegree(), true);
    decoded.splats.append(decoded.pictures, range, decoded.splats.shDegree(), builder, {});
    LoadNotes notes;
    LoadedPart part{at, 0, builder.finish(notes), {}};
    part.splats = static_cast<std::uint32_t>(part.scene.size());
    if (settings_.finish) { settings_.finish(part); }
    return part;
}

void ChunkLoader::load(std::size_t file, const std::vector<LeafLevel>& wishes) {
    auto began = Clock::now();
    const Decoded& decoded = decode(file);
    // With the mutex held.
    const auto count = [&](std::uint64_t splats) {
        const auto now = Clock::now();
        work_.splats += splats;
        work_.seconds += std::chrono::duration<double>(now - std::exchange(began, now)).count();
    };
    for (std::size_t first = 0; first < wishes.size();) {
        // Those that are still wanted.
        std::vector<LeafLevel> batch;
        {
            std::unique_lock lock(mutex_);
            count(0);
            changed_.wait(lock, [&] { return stops_ || done_splats_ < settings_.waiting_splats; });
            began = Clock::now();
            if (stops_) { throw Cancelled(); }
            for (; first < wishes.size() && batch.size() < kPartsAtOnce; ++first) {
                if (isWished(wishes[first])) { batch.push_back(wishes[first]); }
            }
        }
        std::vector<std::optional<LoadedPart>> parts(batch.size());
        forBlocks(batch.size(), 1, settings_.threads,
                  [&](std::size_t i, std::size_t) { parts[i] = read(decoded, batch[i]); });
        const std::lock_guard lock(mutex_);
        count(std::accumulate(parts.begin(), parts.end(), std::uint64_t{0},
                              [](std::uint64_t sum, const auto& part) { return sum + part->splats; }));
        for (std::optional<LoadedPart>& part : parts) {
            if (!isWished(part->at)) { continue; }
            removeWish(part->at);
            done_splats_ += part->splats;
            done_.push_back(std::move(*part));
        }
        news_.notify_all();
    }
}

}  // namespace binosplat
