// Streamed SOG: a level is its chunks, splat by splat; the choice of a level; progress; what the program says.
#include "engine/scene/lod_meta.h"
#include "tests/engine/scene/streamed_scenes.h"
#include "tests/run_program.h"

#include <sys/resource.h>

#include <span>

TEST_SUITE_BEGIN("streamed_sog");

namespace streamed_sog_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

Scene loadLevel(const std::string& source, std::uint32_t level, LoadNotes* notes = nullptr) {
    return loadScene(source, 0, notes, {}, {level, {}});
}

// Splats `first` to `first + count` of `part`, behind those of `whole`; rows of SH get the whole's width, zeros where the part has less.
void addSplats(Scene& whole, const Scene& part, std::size_t first, std::size_t count) {
    const auto addTo = [&](auto& values, const auto& more) {
        values.insert(values.end(), more.begin() + static_cast<std::ptrdiff_t>(first),
                      more.begin() + static_cast<std::ptrdiff_t>(first + count));
    };
    addTo(whole.positions, part.positions);
    addTo(whole.rotations, part.rotations);
    addTo(whole.scales, part.scales);
    addTo(whole.thicknesses, part.thicknesses);
    addTo(whole.opacities, part.opacities);
    const auto width = [](const Scene& scene) { return static_cast<std::size_t>(3 * shCoefficientCount(scene.sh_degree)); };
    for (std::size_t splat = first; splat < first + count; ++splat) {
        for (std::size_t i = 0; i < width(whole); ++i) { whole.sh.push_back(i < width(part) ? part.sh[splat * width(part) + i] : 0.0f); }
    }
}

void addWhole(Scene& whole, const Scene& part) { addSplats(whole, part, 0, part.size()); }

}  // namespace

TEST_CASE("a level is its chunks in their order, with the environment behind") {
    const Folder folder;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    const Scene a = loadScene(source + "/a"), b = loadScene(source + "/b"), c = loadScene(source + "/c"), env = loadScene(source + "/env");
    REQUIRE(a.positions[0] != b.positions[0]);
    REQUIRE(a.sh_degree == 1);
    REQUIRE(b.sh_degree == 0);

    Scene finest;
    finest.sh_degree = 1;
    for (const Scene* part : {&a, &b, &env}) { addWhole(finest, *part); }
    LoadNotes notes;
    checkSameScene(loadLevel(source, 0, &notes), finest);
    CHECK(notes.level == 0);
    CHECK(notes.level_splats == std::vector<std::uint64_t>{16, 8});
    CHECK(notes.environment_splats == 8);
    CHECK(notes.splats_in_file == 24);
    checkSameScene(loadScene(source), finest);
    checkSameScene(loadScene(source + "/lod-meta.json"), finest);
    std::filesystem::rename(source + "/lod-meta.json", source + "/other");
    checkSameScene(loadScene(source + "/other"), finest);
    CHECK(loadScene(source + "/other").name == source + "/other");
}

TEST_CASE("the tree says where each leaf lies and which splats show it, the finest level first") {
    const std::string text = makeLodMeta();
    const LodMeta meta = parseLodMeta(std::as_bytes(std::span(text)), "lod-meta.json");
    REQUIRE(meta.tree.size() == 3);
    CHECK(meta.leaves == 3);
    for (const LodLeaf& leaf : meta.tree) {
        CHECK(leaf.low == glm::vec3(-1.0f, -2.0f, 0.0f));
        CHECK(leaf.high == glm::vec3(1.0f, 0.5f, 2.0f));
    }
    const auto isRange = [](const LodRange& range, std::uint32_t level, std::uint32_t file, std::uint64_t first, std::uint64_t count) {
        return range.level == level && range.file == file && range.splats.first == first && range.splats.count == count;
    };
    REQUIRE(meta.tree[0].levels.size() == 2);
    CHECK(isRange(meta.tree[0].levels[0], 0, 0, 5, 3));
    CHECK(isRange(meta.tree[0].levels[1], 1, 2, 0, 6));
    REQUIRE(meta.tree[1].levels.size() == 2);
    CHECK(isRange(meta.tree[1].levels[1], 1, 2, 6, 2));
    REQUIRE(meta.tree[2].levels.size() == 1);
    CHECK(isRange(meta.tree[2].levels[0], 0, 1, 0, 8));
    // A leaf without splats has no place, and counts as a leaf.
    const std::string with_empty = replaced(text, R"({"0":{"file":1,"offset":0,"count":8}})", "{}");
    const LodMeta fewer = parseLodMeta(std::as_bytes(std::span(with_empty)), "lod-meta.json");
    CHECK(fewer.tree.size() == 2);
    CHECK(fewer.leaves == 3);
}

namespace {

// Makes bundles of some of the chunks' folders, and names them in lod-meta.json.
void bundleChunks(const Folder& folder, const std::string& name, const std::vector<std::string>& chunks) {
    std::string meta = makeLodMeta();
    for (const std::string& chunk : chunks) {
        SogText files;
        for (const auto& entry : std::filesystem::directory_iterator(folder.file(name + "/" + chunk))) {
            std::ifstream file(entry.path(), std::ios::binary);
            files[entry.path().filename().string()] = std::string(std::istreambuf_iterator<char>(file), {});
        }
        std::filesystem::remove_all(folder.file(name + "/" + chunk));
        std::filesystem::create_directories(folder.file(name + "/packed"));
        (void)folder.write(name + "/packed/" + chunk + ".sog", makeZip(files, chunk == "b"));
        meta = replaced(meta, "\"" + chunk + "/meta.json\"", "\"packed/" + chunk + ".sog\"");
    }
    (void)folder.write(name + "/lod-meta.json", meta);
}

}  // namespace

TEST_CASE("chunks and the environment may be bundles") {
    const Folder folder;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    const Scene fine = loadLevel(source, 0), coarse = loadLevel(source, 1);
    for (const std::vector<std::string>& chunks : {std::vector<std::string>{"a"}, {"env"}, {"a", "b", "c", "env"}}) {
        (void)writeStreamed(folder, "scene", makeLodMeta());
        bundleChunks(folder, "scene", chunks);
        LoadNotes notes;
        checkSameScene(loadLevel(source, 0, &notes), fine);
        CHECK(notes.environment_splats == 8);
        checkSameScene(loadLevel(source, 1), coarse);
    }
    std::filesystem::remove(source + "/packed/b.sog");
    std::filesystem::create_symlink("a.sog", source + "/packed/b.sog");
    CHECK(contains(loadError(source), "b.sog is a link to a chunk that is named already"));
    std::filesystem::remove(source + "/packed/b.sog");
    (void)folder.write("scene/packed/b.sog", "no archive");
    CHECK(contains(loadError(source), "packed/b.sog: not a whole zip archive"));
}

TEST_CASE("a scene may have more bundles than a program may have open files") {
    constexpr int kChunks = 100;
    const Folder folder;
    std::string names, leaves;
    for (int i = 0; i < kChunks; ++i) {
        (void)folder.write(fmt::format("{}.sog", i), makeZip(makeChunk(2)));
        names += fmt::format("{}\"{}.sog\"", i == 0 ? "" : ",", i);
        leaves += fmt::format(R"({}{{"bound":{{"min":[0,0,0],"max":[1,1,1]}},"lods":{{"0":{{"file":{},"offset":0,"count":8}}}}}})",
                              i == 0 ? "" : ",", i);
    }
    (void)folder.write(
        "lod-meta.json",
        fmt::format(R"({{"lodLevels":1,"filenames":[{}],"tree":{{"bound":{{"min":[0,0,0],"max":[1,1,1]}},"children":[{}]}}}})", names,
                    leaves));
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_NOFILE, &before) == 0);
    const rlimit few{64, before.rlim_max};
    REQUIRE(setrlimit(RLIMIT_NOFILE, &few) == 0);
    const std::string message = loadError(folder.file("."));
    REQUIRE(setrlimit(RLIMIT_NOFILE, &before) == 0);
    CHECK(message == "");
    CHECK(loadScene(folder.file(".")).size() == 8 * kChunks);
}

TEST_CASE("a leaf without the level has no splats there") {
    const Folder folder;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    Scene coarse;
    coarse.sh_degree = 1;
    for (const char* part : {"/c", "/env"}) { addWhole(coarse, loadScene(source + part)); }
    LoadNotes notes;
    checkSameScene(loadLevel(source, 1, &notes), coarse);
    CHECK(notes.level == 1);
    CHECK(contains(notes.lines.back(), "level of detail 1 of 0 (the finest) to 1; 1 of 3 leaves have no splats at this level"));
}

TEST_CASE("chunks of other levels need not be there") {
    const Folder folder;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    for (const char* chunk : {"/a", "/b"}) { std::filesystem::remove_all(source + chunk); }
    CHECK(loadLevel(source, 1).size() == 16);
    CHECK_THROWS_AS(loadLevel(source, 0), Error);
}

TEST_CASE("what a leaf names is counted in stored splats, broken ones among them") {
    const Folder folder;
    // Of the chunk only splats 2 to 4 and 6 are wanted; 3 and 7 are broken.
    std::string meta = replaced(makeLodMeta(), R"("offset":5,"count":3)", R"("offset":6,"count":1)");
    meta = replaced(meta, R"("offset":0,"count":5)", R"("offset":2,"count":3)");
    const std::string source = writeStreamed(folder, "scene", meta);
    const Scene a = loadScene(source + "/a");
    std::vector<std::uint8_t> quats(36, 128);
    for (std::size_t i = 0; i < 8; ++i) { quats[4 * i + 3] = static_cast<std::uint8_t>(i == 3 || i == 7 ? 251 : 252 + i % 4); }
    (void)folder.write("scene/a/q.webp", makeWebp(3, 3, quats));

    Scene expected;
    expected.sh_degree = 1;
    for (const std::size_t splat : {2u, 4u, 6u}) { addSplats(expected, a, splat, 1); }
    for (const char* part : {"/b", "/env"}) { addWhole(expected, loadScene(source + part)); }
    LoadNotes notes;
    checkSameScene(loadScene(source, 0, &notes), expected);
    CHECK(notes.skipped_zero_rotation == 1);
    CHECK(notes.splats_in_file == 20);
}

TEST_CASE("files of the first writers, without version, counts and environment, are read") {
    const Folder folder;
    std::string meta = replaced(makeLodMeta(), R"("version":1,"asset":{"generator":"a test"},"count":24,"counts":[16,8],)", "");
    meta = replaced(meta, R"("lodErrors":true,"environment":"env/meta.json")", R"("environment":null)");
    CHECK(loadScene(writeStreamed(folder, "scene", meta)).size() == 16);
}

TEST_CASE("the finest level that fits is chosen, or the coarsest") {
    const Folder folder;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    std::vector<std::pair<std::uint64_t, int>> asked;
    const auto levelWithin = [&](std::uint64_t most) {
        LoadNotes notes;
        asked.clear();
        const auto fits = [&](std::uint64_t splats, int sh_degree) {
            asked.emplace_back(splats, sh_degree);
            return splats <= most;
        };
        const Scene scene = loadScene(source, 0, &notes, {}, {std::nullopt, fits});
        CHECK(scene.size() == (notes.level == 0 ? 24 : 16));
        CHECK(contains(notes.lines.back(), "the finest that fits the memory limit") == (notes.level == 1 && most > 0));
        CHECK(contains(notes.lines.back(), "as none fits the memory limit") == (most == 0));
        return notes.level;
    };
    CHECK(levelWithin(24) == 0);
    CHECK(asked == std::vector<std::pair<std::uint64_t, int>>{{24, 1}});
    CHECK(levelWithin(23) == 1);
    CHECK(levelWithin(0) == 1);
}

TEST_CASE("a level that a scene does not have is refused") {
    const Folder folder;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    const auto errorAt = [](const std::string& scene, std::uint32_t level) -> std::string {
        try {
            (void)loadLevel(scene, level);
        } catch (const Error& error) { return error.what(); }
        return {};
    };
    CHECK(contains(errorAt(source, 2), "scene/lod-meta.json: lod is 2, expected one of the scene's levels of detail, 0 (the finest) to 1"));
    CHECK(contains(errorAt(source, 0xffffffff), "lod is 4294967295"));
    CHECK(contains(errorAt(source + "/a", 0), "a: lod is 0, but a scene of this kind (SOG (directory)) has no levels of detail"));
    CHECK(contains(errorAt("builtin:one-splat", 1), "builtin:one-splat: lod is 1, but a scene of this kind (built-in)"));
}

TEST_CASE("progress runs from 0 to 1 over all chunks") {
    const Folder folder;
    std::vector<double> shares;
    (void)loadScene(writeStreamed(folder, "scene", makeLodMeta()), 0, nullptr, [&](double share) { shares.push_back(share); });
    CHECK(std::ranges::is_sorted(shares));
    CHECK(shares == std::vector<double>{0.0, 0.0, 8.0 / 24, 16.0 / 24, 1.0});
}

TEST_CASE("the program loads the level that --lod names and says which levels there are") {
    const Folder folder;
    const Workplace work;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    const Outcome info = work.run("info '" + source + "'");
    CHECK(info.exit_code == 0);
    CHECK(contains(info.output, "levels of detail   0: 16 splats (loaded)\n                   1: 8 splats\n"));
    CHECK(contains(info.output, "environment: 8 splats (loaded)"));
    CHECK(contains(work.run("info --lod 1 '" + source + "'").output, "1: 8 splats (loaded)"));
    CHECK(work.run("convert --lod 1 '" + source + "' coarse.ply").exit_code == 0);
    checkSameScene(loadScene((work.path / "coarse.ply").string()), loadLevel(source, 1));
    // The report says what the program chose.
    CHECK(work.run("render '" + source + "' --mode mono --size 16x16 --out seen").exit_code == 0);
    std::ifstream file(work.path / "seen" / "report.json");
    const std::string report{std::istreambuf_iterator<char>(file), {}};
    CHECK(contains(report, "\"lod\": 0,"));
    CHECK(contains(report, "\"sh-degree\": 1,"));
    CHECK(contains(report, "\"antialiased\": false"));
    const Outcome beyond = work.run("info --lod 2 '" + source + "'");
    CHECK(beyond.exit_code == 1);
    CHECK(contains(beyond.errors, "levels of detail, 0 (the finest) to 1\n"));
    CHECK(std::ranges::count(beyond.errors, '\n') == 1);
    CHECK(work.run("info --lod fine '" + source + "'").exit_code == 1);
    CHECK(work.run("scene one-splat --lod 0 --out a.ply").exit_code == 2);
}

}  // namespace streamed_sog_test
