// Broken SOG scenes: each loads or is refused in one line.
#include "engine/scene/sog.h"
#include "tests/engine/scene/streamed_scenes.h"
#include "tests/hostile.h"

TEST_SUITE_BEGIN("hostile_sog");

namespace hostile_sog_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

struct SogAttempts {
    Folder folder;
    Tally tally;
    std::string name;
    std::size_t most_splats;

    explicit SogAttempts(std::string what, std::size_t most = 9) : name(std::move(what)), most_splats(most) {}
    ~SogAttempts() {
        MESSAGE(fmt::format("{}: {} broken files, {} loaded, {} refused", name, tally.inputs, tally.read, tally.refused));
        CHECK(tally.refused > tally.inputs / 8);
        CHECK(peakMebibytes() < 768);
    }
    SogAttempts(const SogAttempts&) = delete;
    SogAttempts& operator=(const SogAttempts&) = delete;
    void load(const std::string& what, const std::string& source) {
        tally.attempt(name + ", " + what, [&] {
            const std::size_t splats = loadScene(source).size();
            CHECK(splats <= most_splats);
        });
    }
};

}  // namespace

TEST_CASE("broken meta.json files") {
    for (const int version : {1, 2}) {
        SogAttempts attempts(fmt::format("meta.json of version {}", version));
        SogText files = makeSog(version);
        // Codebooks of two entries keep the text short.
        std::string& good = files["meta.json"];
        for (std::size_t at = good.find("\"codebook\":["); at != std::string::npos; at = good.find("\"codebook\":[", at + 1)) {
            good.replace(at + 12, good.find(']', at) - at - 12, "-3,1");
        }
        const std::string source = writeSogFolder(attempts.folder, "scene", files);
        const Attempt attempt = [&](const std::string& what, const std::string& bytes) {
            (void)attempts.folder.write("scene/meta.json", bytes);
            attempts.load(what, source);
        };
        truncate(good, attempt);
        flipBits(good, 800, attempt);
        spliceBytes(good, 800, attempt);
        replaceNumbers(good, good.size(), attempt);
        attempt("deeply nested", std::string(1'000'000, '['));
        attempt("deeply nested and closed", R"({"version":2,"count":)" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
    }
}

TEST_CASE("broken lod-meta.json files") {
    SogAttempts attempts("lod-meta.json", 32);  // of four chunks
    const std::string good = makeLodMeta();
    const std::string source = writeStreamed(attempts.folder, "scene", good);
    const Attempt attempt = [&](const std::string& what, const std::string& bytes) {
        (void)attempts.folder.write("scene/lod-meta.json", bytes);
        attempts.load(what, source);
    };
    truncate(good, attempt);
    flipBits(good, 800, attempt);
    spliceBytes(good, 800, attempt);
    replaceNumbers(good, good.size(), attempt);
    attempt("deeply nested", std::string(1'000'000, '['));
    attempt("deeply nested and closed", R"({"lodLevels":1,"tree":)" + std::string(100'000, '[') + std::string(100'000, ']') + "}");
}

TEST_CASE("broken pictures") {
    const SogText good = makeSog();
    for (const char* picture : {"l.webp", "q.webp", "p.webp"}) {
        SogAttempts attempts(picture);
        const std::string source = writeSogFolder(attempts.folder, "scene", good);
        const Attempt attempt = [&](const std::string& what, const std::string& bytes) {
            (void)attempts.folder.write(std::string("scene/") + picture, bytes);
            attempts.load(what, source);
        };
        const std::string& bytes = good.at(picture);
        truncate(bytes.substr(0, 400), attempt);
        flipBits(bytes, 400, attempt);
        flipBits(bytes.substr(0, 60), 200,
                 [&](const std::string& what, const std::string& head) { attempt("head, " + what, head + bytes.substr(60)); });
        spliceBytes(bytes, 300, attempt);
    }
}

TEST_CASE("broken bundles as convert writes them, alone and as chunks") {
    SogAttempts attempts("written bundle", 40);
    const SogText text = makeSog();
    const Scene scene = loadScene(writeSogFolder(attempts.folder, "scene", text));
    const std::string path = attempts.folder.file("a.sog");
    writeSog(scene, path);
    std::ifstream file(path, std::ios::binary);
    const std::string good{std::istreambuf_iterator<char>(file), {}};
    const Attempt attempt = [&](const std::string& what, const std::string& bytes) {
        attempts.load(what, attempts.folder.write("broken.sog", bytes));
    };
    for (std::size_t length = 0; length < good.size(); length += 13 * kStep) {
        attempt(fmt::format("the first {} bytes", length), good.substr(0, length));
    }
    flipBits(good, 600, attempt);
    spliceBytes(good, 600, attempt);

    std::string meta = makeLodMeta();
    for (const char* chunk : {"a", "b", "c", "env"}) {
        meta = replaced(meta, fmt::format("\"{}/meta.json\"", chunk), fmt::format("\"{}.sog\"", chunk));
    }
    std::filesystem::create_directories(attempts.folder.file("streamed"));
    for (const char* chunk : {"a", "b", "c", "env"}) { (void)attempts.folder.write(fmt::format("streamed/{}.sog", chunk), good); }
    const std::string source = attempts.folder.write("streamed/lod-meta.json", meta);
    REQUIRE(loadScene(source).size() == 24);
    const Attempt as_chunk = [&](const std::string& what, const std::string& bytes) {
        (void)attempts.folder.write("streamed/b.sog", bytes);
        attempts.load("a chunk, " + what, source);
    };
    flipBits(good, 300, as_chunk);
    spliceBytes(good, 300, as_chunk);
}

TEST_CASE("broken bundles") {
    SogText files = makeSog(2, false);
    std::string& meta = files["meta.json"];
    for (std::size_t at = meta.find("\"codebook\":["); at != std::string::npos; at = meta.find("\"codebook\":[", at + 1)) {
        meta.replace(at + 12, meta.find(']', at) - at - 12, "-3,1");
    }
    for (const bool deflated : {false, true}) {
        const std::string good = makeZip(files, deflated);
        SogAttempts attempts(deflated ? "deflated bundle" : "stored bundle");
        const Attempt attempt = [&](const std::string& what, const std::string& bytes) {
            attempts.load(what, attempts.folder.write("broken.sog", bytes));
        };
        truncate(good, attempt);
        flipBits(good, 1000, attempt);
        spliceBytes(good, 1000, attempt);
        // Most of the harm is done in the directory at the end.
        const std::size_t directory = good.find("PK\x01\x02");
        const Attempt at_end = [&](const std::string& what, const std::string& tail) {
            attempt("directory, " + what, good.substr(0, directory) + tail);
        };
        flipBits(good.substr(directory), 800, at_end);
        spliceBytes(good.substr(directory), 800, at_end);
    }
}

}  // namespace hostile_sog_test
