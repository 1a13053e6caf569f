// Facts about scene files that change while they are read: here, when the reader reports its progress.
#include "engine/builtin/procedural.h"
#include "engine/files/ply.h"
#include "engine/files/read_ahead.h"
#include "engine/files/spz.h"
#include "tests/engine/files/hostile_scenes.h"
#include "tests/engine/files/sog_scenes.h"

#include <chrono>

SUITE(changing_file) {

// Loads a scene while `change` happens once; returns the error's message, or "read".
std::string load(const std::string& path, const std::function<void()>& change, Scene* scene = nullptr) {
    // Time stamps are coarse: make sure that what is written from now on is newer.
    if (fs::is_regular_file(path)) {
        fs::last_write_time(path, fs::file_time_type::clock::now() - std::chrono::hours(1));
    }
    bool changed = false;
    try {
        Scene loaded = loadScene(path, 0, nullptr, [&](double) {
            if (!std::exchange(changed, true)) { change(); }
        });
        if (scene != nullptr) { *scene = std::move(loaded); }
    } catch (const Error& error) {
        CHECK(error.code() == ExitCode::kBadInput);
        return error.what();
    }
    CHECK(changed);
    return "read";
}

// Small files of every format that consists of one file, and a PLY that fills several of the reader's blocks.
std::vector<std::string> writeFiles(const Folder& folder) {
    std::vector<std::string> paths{folder.write("ascii.ply", makePly(9, true).bytes()),
                                   folder.write("packed.ply", makeCompressedPly()),
                                   folder.write("a.splat", makeSplatFile()),
                                   folder.write("a.spz", gzip(makeSpz(3).bytes())), folder.file("large.ply")};
    writePly(makeBuiltin("builtin:atelier", 5000), paths.back());
#ifdef BINOSPLAT_SOG
    paths.push_back(folder.write("a.sog", makeZip(makeSog())));
#endif
    return paths;
}

TEST_CASE("a file that changes while it is read is refused, one removed or replaced is read as it was") {
    const Folder folder;
    for (const std::string change : {"cut", "grow", "write", "remove", "replace"}) {
#ifdef _WIN32  // on Windows, a file that is open stays where it is
        if (change.starts_with("re")) { continue; }
#endif
        for (const std::string& path : writeFiles(folder)) {
            INFO("change ", change, ", path ", path);
            const std::size_t splats = loadScene(path).size();
            const std::string other = folder.write("other", "not a scene");
            Scene scene;
            const std::string message = load(
                path,
                [&] {
                    if (change == "remove") { return (void)fs::remove(path); }
                    if (change == "replace") { return fs::rename(other, path); }
                    const std::uintmax_t bytes = fs::file_size(path);
                    if (change != "write") { fs::resize_file(path, change == "cut" ? bytes / 2 : bytes + 1); }
                    std::fstream(path, std::ios::binary | std::ios::in | std::ios::out).put('p');
                },
                &scene);
            const bool is_read = change.starts_with("re");
            CHECK(
                message ==
                (is_read ? "read" : path + ": was changed while it was read, must stay as it is until then"));
            CHECK(scene.size() == (is_read ? splats : 0));
        }
    }
}

TEST_CASE("blocks are read a little ahead, and whoever stops taking them waits for nothing") {
    for (const int taken : {0, 1, 9, 40}) {
        int filled = 0;
        {
            ReadAhead blocks(100'000'000, [&](ReadAhead::Block&) { ++filled; });
            for (int i = 0; i < taken; ++i) { REQUIRE(blocks.next() != nullptr); }
        }
        CHECK(filled == within(taken, taken + 48));
    }
}

#ifdef BINOSPLAT_SOG
TEST_CASE_FIXTURE(InFolder, "a SOG folder that loses a picture while it is read is refused in one line") {
    const std::string path = writeSogFolder(folder, "sog", makeSog());
    CHECK(withSlashes(load(path, [&] { fs::remove(path + "/q.webp"); })) ==
          withSlashes(path + "/q.webp: no such file"));
    (void)writeSogFolder(folder, "sog", makeSog());
    CHECK(contains(load(path, [&] { fs::resize_file(path + "/s.webp", 20); }), path + "/s.webp: "));
}
#endif

}  // SUITE(changing_file)
