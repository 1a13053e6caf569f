// Copies, validators, and servers that do not answer.
#include "engine/files/web/web_files.h"

#include "engine/address.h"
#include "engine/error.h"
#include "engine/files/load_scene.h"

#include <fmt/chrono.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

// The share of the whole time that fetching takes; the rest is reading.
constexpr double kFetchingShare = 0.7;
constexpr std::chrono::milliseconds kLook(50);
// Another program may remove what was just fetched, but hardly several times in a row.
constexpr int kMostTurns = 3;

std::string dateOf(std::int64_t seconds) {
    return fmt::format("{:%Y-%m-%d %H:%M} UTC", fmt::gmtime(static_cast<std::time_t>(seconds)));
}

FetchSettings withCacheLimit(const WebSettings& settings) {
    FetchSettings fetch = settings.fetch;
    if (!settings.cache_folder.empty()) { fetch.cache_bytes = settings.cache_bytes; }
    return fetch;
}

}  // namespace

fs::path webCacheFolder() {
    const fs::path folder = userCacheFolder();
    return folder.empty() ? folder : folder / "binosplat" / "web";
}

WebFiles::WebFiles(const std::string& address, const WebSettings& settings, Progress waiting)
    : address_(parseAddress(address)),
      waiting_(std::move(waiting)),
      cache_bytes_(settings.cache_bytes),
      own_folder_(settings.cache_folder.empty()
                      ? std::optional(TemporaryFolder("binosplat-web-", "scenes from the web"))
                      : std::nullopt),
      folder_(own_folder_ ? own_folder_->path() : settings.cache_folder),
      cache_(folder_),
      fetcher_(cache_, withCacheLimit(settings)) {}

WebFiles::~WebFiles() { cache_.trim(cache_bytes_); }

void WebFiles::ask(const std::string& address, std::uint64_t most_bytes) {
    if (settled_.contains(address) || asked_.contains(address)) { return; }
    const std::optional<KeptCopy> copy = cache_.find(address);
    if (copy && is_unreachable_) {
        settled_.insert(address);
        return;
    }
    asked_.emplace(address, fetcher_.request({address, copy ? copy->version : FileVersion(), most_bytes}));
}

void WebFiles::expect(const std::vector<std::string>& names, std::uint64_t most_bytes) {
    for (const std::string& name : names) { ask(addressOf(address_, name), most_bytes); }
}

fs::path WebFiles::settle(const std::string& address) {
    const auto found = asked_.find(address);
    if (found == asked_.end()) { return {}; }
    while (found->second.wait_for(kLook) != std::future_status::ready) {
        if (waiting_) { waiting_(fetcher_.share()); }
    }
    Fetched fetched = found->second.get();
    asked_.erase(found);
    fs::path path;
    if (fetched.kind == Fetched::Kind::kNew) {
        path = cache_.keep(address, std::move(fetched.file), fetched.version);
    }
    const bool is_unreachable = fetched.kind == Fetched::Kind::kUnreachable;
    const std::optional<KeptCopy> copy = is_unreachable ? cache_.find(address) : std::nullopt;
    if (fetched.kind == Fetched::Kind::kRefused || (is_unreachable && !copy)) {
        ++failed_count_;
        fail("{}: {}", address, fetched.reason);
    }
    if (is_unreachable) {
        is_unreachable_ = true;
        if (stale_.empty()) {
            stale_ = fmt::format("{}: {}; taken as it was on {}", address,
                                 fetched.reason.substr(0, fetched.reason.find(';')), dateOf(copy->fetched_s));
        }
    }
    settled_.insert(address);
    return path;
}

std::unique_ptr<InputFile> WebFiles::open(const std::string& name, std::uint64_t most_bytes) {
    const std::string address = addressOf(address_, name);
    for (int turn = 0; turn < kMostTurns; ++turn) {
        ask(address, most_bytes);
        // What was just fetched needs no note: if another program has put its own bytes there, these are as
        // new, while the note beside them may still be about ours.
        fs::path path = settle(address);
        if (path.empty()) {
            if (const std::optional<KeptCopy> copy = cache_.find(address)) { path = copy->path; }
        }
        try {
            if (!path.empty()) { return std::make_unique<InputFile>(path, address, *this); }
        } catch (const Error&) {
            // Another program may have put it back meanwhile.
            std::error_code error;
            if (turn + 1 == kMostTurns && fs::exists(path, error)) { throw; }
        }
        settled_.erase(address);
    }
    fail(
        "{}: is removed from the cache in {} before it can be read, expected more space there "
        "(--cache-limit)",
        address, folder_.string());
}

Scene loadSceneFromAnywhere(const std::string& source, std::uint64_t builtin_splats, LoadNotes& notes,
                            const Progress& progress, const LevelChoice& level, const WebSettings& settings) {
    if (!isAddress(source)) { return loadScene(source, builtin_splats, &notes, progress, level); }
    double fetched = 0.0, read = 0.0;
    const auto show = [&] {
        if (progress) { progress(kFetchingShare * fetched + (1.0 - kFetchingShare) * read); }
    };
    const auto fetching = [&](double share) {
        fetched = share;
        show();
    };
    const auto reading = [&](double share) {
        if (share > 0.0) { fetched = 1.0; }
        read = share;
        show();
    };
    WebFiles files(source, settings, fetching);
    Scene scene = loadScene(files.open(""), notes, progress ? Progress(reading) : Progress(), level);
    if (isOpenOnTheWay(source)) {
        notes.lines.push_back(fmt::format(
            "{}: came by http, so others on the way could read and change it; https is safer", source));
    }
    notes.stale = files.stale();
    if (!notes.stale.empty()) { notes.lines.push_back(notes.stale); }
    return scene;
}

}  // namespace binosplat
