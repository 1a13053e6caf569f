// The files of a scene on the web: kept copies if they are still current, otherwise what the server sends.
#pragma once

#include "engine/files/load_scene.h"
#include "engine/files/scene_files.h"
#include "engine/files/web/address.h"
#include "engine/files/web/fetcher.h"

#include <filesystem>
#include <functional>
#include <future>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace binosplat {

struct WebSettings {
    std::filesystem::path cache_folder;  // empty: nothing is kept after the run
    std::uint64_t cache_bytes = std::uint64_t{4} << 30;
    FetchSettings fetch;
};

// Where scenes from the web are kept: web/ in the program's folder in the user's cache folder; empty if there
// is none.
std::filesystem::path webCacheFolder();

// For one thread. Files in the cache stay while it exists, unless another program needs the space; then they
// are fetched again.
class WebFiles final : public SceneFiles {
public:
    // `waiting` is called now and then while waiting for a file, with the share of all requests that is done;
    // it may throw. Throws Error if `address` is not an address, in a build without network access, and if
    // the cache cannot be written.
    WebFiles(const std::string& address, const WebSettings& settings, Progress waiting = {});
    WebFiles(const WebFiles&) = delete;
    WebFiles& operator=(const WebFiles&) = delete;
    ~WebFiles() override;

    std::unique_ptr<InputFile> open(const std::string& name, std::uint64_t most_bytes = kAnyLength) override;
    void expect(const std::vector<std::string>& names, std::uint64_t most_bytes = kAnyLength) override;
    std::string place(const std::string& name) const override { return addressOf(address_, name); }

    // A sentence if a server did not answer and copies were used for its files; otherwise empty.
    [[nodiscard]] const std::string& stale() const { return stale_; }
    // How many files could not be fetched so far; this may succeed later.
    [[nodiscard]] std::uint64_t failedCount() const { return failed_count_; }

private:
    void ask(const std::string& address, std::uint64_t most_bytes);
    // Waits until there is a copy in the cache, or there will not be; returns its file if it was just
    // fetched, else nothing. Throws Error if there is none.
    std::filesystem::path settle(const std::string& address);

    Address address_;
    Progress waiting_;
    std::uint64_t cache_bytes_;
    std::optional<TemporaryFolder> own_folder_;
    std::filesystem::path folder_;
    WebCache cache_;
    std::map<std::string, std::future<Fetched>> asked_;
    std::set<std::string> settled_;
    std::string stale_;
    std::uint64_t failed_count_ = 0;
    bool is_unreachable_ = false;  // kept copies are used as they are
    Fetcher fetcher_;              // destroyed first
};

// Loads `source`, which is an address or anything that loadScene takes.
Scene loadSceneFromAnywhere(const std::string& source, std::uint64_t builtin_splats, LoadNotes& notes,
                            const Progress& progress, const LevelChoice& level, const WebSettings& settings);

}  // namespace binosplat
