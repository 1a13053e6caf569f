// Loads scenes from a test's server.
#pragma once

#include "engine/files/web/web_files.h"
#include "tests/engine/files/ply_files.h"
#include "tests/engine/files/web/web_server.h"

namespace binosplat::test {

// Without pauses between attempts, into a cache in the test's folder.
inline WebSettings webSettings(const Folder& folder) {
    setEnvironment("no_proxy", "127.0.0.1");
    WebSettings settings;
    settings.cache_folder = folder.file("cache");
    settings.fetch.first_pause = std::chrono::milliseconds(0);
    return settings;
}

inline Scene loadFromWeb(const std::string& address, const WebSettings& settings, LoadNotes* notes = nullptr,
                         const LevelChoice& level = {}, const Progress& progress = {}) {
    LoadNotes ignored;
    return loadSceneFromAnywhere(address, 0, notes != nullptr ? *notes : ignored, progress, level, settings);
}

// The message of the Error that it throws, which must begin with the address; empty if it throws none.
inline std::string webError(const std::string& address, const WebSettings& settings) {
    try {
        (void)loadFromWeb(address, settings);
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::kBadInput);
        CHECK(std::string(error.what()).starts_with(address));
        return error.what();
    }
    return {};
}

// A scene that is on the disk and at addresses. For facts: TEST_CASE_FIXTURE(OnWeb, "...").
struct OnWeb : InFolder {
    static inline const std::string kPly = makePly(45).bytes();
    const Scene scene = loadScene(folder.write("a.ply", kPly));
    WebSettings settings = webSettings(folder);

    void checkSame(const std::string& address, LoadNotes* notes = nullptr) const {
        checkSameScene(scene, loadFromWeb(address, settings, notes));
    }
    // From an empty cache, after so many requests.
    void checkSame(const WebServer& server, std::size_t requests, LoadNotes* notes = nullptr) const {
        fs::remove_all(settings.cache_folder);
        checkSame(server.at("/a.ply"), notes);
        CHECK(server.asked().size() == requests);
    }
};

inline std::vector<std::string> filesIn(const fs::path& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder, error)) {
        names.push_back(entry.path().filename().string());
    }
    std::ranges::sort(names);
    return names;
}

// Everything in a folder, by path after `prefix`.
inline WebPages filesOf(const fs::path& folder, const std::string& prefix = "/") {
    WebPages files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().lexically_relative(folder).generic_string();
        if (entry.is_regular_file()) { files[prefix + name] = textIn(entry.path()); }
    }
    return files;
}

inline std::uint64_t bytesIn(const fs::path& folder) {
    std::uint64_t sum = 0;
    for (const std::string& name : filesIn(folder)) { sum += fs::file_size(folder / name); }
    return sum;
}

}  // namespace binosplat::test
