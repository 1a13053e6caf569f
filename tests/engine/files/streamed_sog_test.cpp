// Streamed SOG: where each splat of a level comes from, the choice of a level, progress, and what is refused.
#include "engine/files/lod_meta.h"
#include "engine/scene/pick_splats.h"
#include "tests/engine/files/streamed_scenes.h"

#ifndef _WIN32
#include <sys/resource.h>
#endif

SUITE(streamed_sog) {

struct Streamed : InFolder {
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
};

Scene loadLevel(const std::string& source, std::uint32_t level, LoadNotes* notes = nullptr) {
    return loadScene(source, 0, notes, {}, {level, {}});
}

Scene joined(const std::vector<Scene>& parts) {
    Scene whole;
    for (const Scene& part : parts) { appendSplats(whole, part); }
    return whole;
}

TEST_CASE_FIXTURE(Streamed, "a level is its chunks in their order, with the environment behind") {
    const Scene a = loadScene(source + "/a"), b = loadScene(source + "/b"), c = loadScene(source + "/c"),
                env = loadScene(source + "/env");
    REQUIRE(a.positions[0] != b.positions[0]);
    REQUIRE(these(a.sh_degree, b.sh_degree) == these(1, 0));
    const Scene finest = joined({a, b, env});
    LoadNotes notes;
    checkSameScene(loadLevel(source, 0, &notes), finest);
    CHECK(these(notes.level, notes.level_splats, notes.environment_splats, notes.splats_in_file) ==
          these(0, std::vector<std::uint64_t>{16, 8}, 8, 24));
    checkSameScene(loadScene(source), finest);
    checkSameScene(loadScene(source + "/lod-meta.json"), finest);
    fs::rename(source + "/lod-meta.json", source + "/other");
    const Scene other = loadScene(source + "/other");
    fs::rename(source + "/other", source + "/lod-meta.json");
    checkSameScene(other, finest);
    CHECK(other.name == source + "/other");

    // One leaf has no splats at the other level; only that level's chunks need to exist.
    for (const char* chunk : {"/a", "/b"}) { fs::remove_all(source + chunk); }
    checkSameScene(loadLevel(source, 1, &notes), joined({c, env}));
    CHECK(notes.level == 1);
    CHECK(contains(notes.lines.back(),
                   "level of detail 1 of 0 (the finest) to 1; 1 of 3 leaves have no splats at this level"));
    CHECK_THROWS_AS(loadLevel(source, 0), Error);
}

TEST_CASE("the tree says where each leaf lies and which splats show it, the finest level first") {
    // For each leaf its box, and for each of its levels the chunk and the range of its splats.
    const auto told = [](const std::string& text) {
        const LodMeta meta = parseLodMeta(std::as_bytes(std::span(text)), "lod-meta.json");
        std::string leaves = fmt::format("{}:", meta.leaves);
        for (const LodLeaf& leaf : meta.tree) {
            leaves += fmt::format(" ({},{},{} to {},{},{}", leaf.low.x, leaf.low.y, leaf.low.z, leaf.high.x,
                                  leaf.high.y, leaf.high.z);
            for (const auto& [level, file, splats] : leaf.levels) {
                leaves += fmt::format("; {}: {} from {} of {}", level, splats.count, splats.first, file);
            }
            leaves += ")";
            std::vector<float> errors{0.0f, 0.5f};
            errors.resize(meta.has_errors ? leaf.levels.size() : 0);
            CHECK(leaf.errors == errors);
        }
        return leaves;
    };
    const std::string two =
        "3: (-1,-2,0 to 1,0.5,2; 0: 3 from 5 of 0; 1: 6 from 0 of 2) (-1,-2,0 to 1,0.5,2; 0: 5 from 0 of 0; "
        "1: 2 from 6 of 2)";
    CHECK(told(makeLodMeta()) == two + " (-1,-2,0 to 1,0.5,2; 0: 8 from 0 of 1)");
    // A writer that has not measured the levels' errors says so, or leaves the field out.
    for (const char* without : {"", R"("lodErrors":false,)"}) {
        CHECK(told(replaced(makeLodMeta(), R"("lodErrors":true,)", without)).starts_with(two));
    }
    // A leaf without splats has no place, but counts as a leaf.
    CHECK(told(replaced(makeLodMeta(), R"({"0":{"file":1,"offset":0,"count":8}})", "{}")) == two);
}

TEST_CASE("a leaf without splats at a level shows the next coarser one; an environment may be missing") {
    const Folder folder;
    // The first leaf has only level 1; the third, as before, has only level 0.
    const std::string less = replaced(makeLodMeta(), R"("0":{"file":0,"offset":5,"count":3},)", "");
    const std::string source = writeStreamed(folder, "scene", less);
    const Scene a = loadScene(source + "/a"), b = loadScene(source + "/b"), c = loadScene(source + "/c"),
                env = loadScene(source + "/env");
    const std::uint32_t first[] = {0, 1, 2, 3, 4, 5};
    const Scene expected = joined({pickSplats(a, std::span(first, 5)), b, pickSplats(c, first)});
    LoadNotes notes;
    checkSameScene(loadLevel(source, 0, &notes), joined({expected, env}));
    CHECK(notes.level_splats == std::vector<std::uint64_t>{19, 8});
    CHECK(contains(notes.lines.back(),
                   "; 1 of 3 leaves have no splats at this level, 1 of them show a coarser one"));
    CHECK(loadLevel(source, 1).size() == 16);

    fs::remove_all(source + "/env");
    checkSameScene(loadLevel(source, 0, &notes), expected);
    CHECK(notes.environment_splats == 0);
    CHECK(contains(notes.lines.back(), "scene: is shown without its environment: "));
    CHECK(contains(notes.lines.back(), "scene/env/meta.json is not there"));
}

TEST_CASE_FIXTURE(Streamed, "chunks and the environment may be bundles") {
    const Scene fine = loadLevel(source, 0), coarse = loadLevel(source, 1);
    for (const auto& bundles : {std::vector<std::string>{"a"}, {"env"}, {"a", "b", "c", "env"}}) {
        (void)writeStreamed(folder, "scene", makeLodMeta(), bundles);
        LoadNotes notes;
        checkSameScene(loadLevel(source, 0, &notes), fine);
        CHECK(notes.environment_splats == 8);
        checkSameScene(loadLevel(source, 1), coarse);
    }
    (void)folder.write("scene/b.sog", "no archive");
    checkError("scene/b.sog: not a whole zip archive", source);
#ifndef _WIN32  // on Windows, links need a privilege
    fs::remove(source + "/b.sog");
    fs::create_symlink("a.sog", source + "/b.sog");
    checkError("b.sog is a link to a chunk that is named already", source);
#endif
}

#ifndef _WIN32
TEST_CASE("a scene may have more bundles than a program may have open files") {
    constexpr int kChunks = 100;
    const Folder folder;
    const nlohmann::json bound{{"min", {0, 0, 0}}, {"max", {1, 1, 1}}};
    nlohmann::json meta{{"lodLevels", 1}, {"tree", {{"bound", bound}}}};
    for (int i = 0; i < kChunks; ++i) {
        (void)folder.write(fmt::format("{}.sog", i), makeZip(makeChunk(2)));
        meta["filenames"].push_back(fmt::format("{}.sog", i));
        const nlohmann::json splats{{"file", i}, {"offset", 0}, {"count", 8}};
        meta["tree"]["children"].push_back({{"bound", bound}, {"lods", {{"0", splats}}}});
    }
    (void)folder.write("lod-meta.json", meta.dump());
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_NOFILE, &before) == 0);
    const rlimit few{64, before.rlim_max};
    REQUIRE(setrlimit(RLIMIT_NOFILE, &few) == 0);
    const std::string message = loadError(folder.file("."));
    REQUIRE(setrlimit(RLIMIT_NOFILE, &before) == 0);
    CHECK(message == "");
    CHECK(loadScene(folder.file(".")).size() == 8 * kChunks);
}
#endif

TEST_CASE_FIXTURE(InFolder, "what a leaf names is counted in stored splats, broken ones among them") {
    // Only splats 2 to 4 and 6 of the chunk are used; 3 and 7 are broken.
    std::string meta = replaced(makeLodMeta(), R"("offset":5,"count":3)", R"("offset":6,"count":1)");
    meta = replaced(meta, R"("offset":0,"count":5)", R"("offset":2,"count":3)");
    const std::string source = writeStreamed(folder, "scene", meta);
    const Scene a = loadScene(source + "/a");
    const auto rotations = [](int i) {
        return std::array{128, 128, 128, i == 3 || i == 7 ? 251 : 252 + i % 4};
    };
    (void)folder.write("scene/a/q.webp", makeNine(rotations));
    const auto [notes, scene] = readScene(source);
    const std::uint32_t kept[] = {2, 4, 6};
    checkSameScene(scene,
                   joined({pickSplats(a, kept), loadScene(source + "/b"), loadScene(source + "/env")}));
    CHECK(these(notes.skipped_zero_rotation, notes.splats_in_file) == these(1, 20));
}

TEST_CASE("the first writers' files are read; progress runs from 0 to 1 over all chunks") {
    const Folder folder;
    std::vector<double> shares;
    const auto tell = [&](double share) { shares.push_back(share); };
    (void)loadScene(writeStreamed(folder, "scene", makeLodMeta()), 0, nullptr, tell);
    CHECK(shares == std::vector<double>{0.0, 0.0, 8.0 / 24, 16.0 / 24, 1.0});
    std::string meta = replaced(
        makeLodMeta(), R"("version":1,"asset":{"generator":"a test"},"count":24,"counts":[16,8],)", "");
    meta = replaced(meta, R"("lodErrors":true,"environment":"env/meta.json")", R"("environment":null)");
    CHECK(loadScene(writeStreamed(folder, "scene", meta)).size() == 16);
}

TEST_CASE_FIXTURE(Streamed, "the finest level that fits is chosen, or the coarsest") {
    using Asked = std::vector<std::pair<std::uint64_t, int>>;
    for (const std::uint64_t most : {24, 23, 0}) {
        LoadNotes notes;
        Asked asked;
        const Scene scene = loadScene(source, 0, &notes, {},
                                      {std::nullopt, [&, limit = most](std::uint64_t splats, int sh_degree) {
                                           asked.emplace_back(splats, sh_degree);
                                           return splats <= limit;
                                       }});
        CHECK(these(scene.size(), notes.level) == (most == 24 ? these(24, 0) : these(16, 1)));
        CHECK(contains(notes.lines.back(), "the finest that fits the memory limit") == (most == 23));
        CHECK(contains(notes.lines.back(), "as none fits the memory limit") == (most == 0));
        if (most == 24) { CHECK(asked == Asked{{24, 1}}); }
    }
}

TEST_CASE_FIXTURE(Streamed, "a level that a scene does not have is refused") {
    const std::tuple<std::string, std::uint32_t, const char*> faults[]{
        {source, 2,
         "scene/lod-meta.json: lod is 2, expected one of the scene's levels of detail, 0 (the finest) to 1"},
        {source, 0xffffffff, "lod is 4294967295"},
        {source + "/a", 0, "a: lod is 0, but a scene of this kind (SOG (directory)) has no levels of detail"},
        {"builtin:one-splat", 1, "builtin:one-splat: lod is 1, but a scene of this kind (built-in)"}};
    for (const auto& [scene, level, message] : faults) {
        CHECK_THROWS_WITH_AS(loadLevel(scene, level), doctest::Contains(message), Error);
    }
}

SCRIPT(streamed_sog, "engine/files/streamed_sog") {
    const Streamed streamed;
    runFaults(makeLodMeta(), [&](const std::string& broken) {
        (void)streamed.folder.write("scene/lod-meta.json", broken);
        const std::string message = loadError(streamed.source);
        CHECK(contains(message, "scene/lod-meta.json: "));
        return message;
    });
}

TEST_CASE_FIXTURE(InFolder, "a lod-meta.json that is none, is cut off or lies too deep is refused") {
    const auto nest = [](int nodes) {
        std::string meta = R"({"lodLevels":1,"filenames":["a/meta.json"],"tree":)";
        for (int i = 1; i < nodes; ++i) { meta += R"({"bound":{"min":[0,0,0],"max":[1,1,1]},"children":[)"; }
        meta += R"({"bound":{"min":[0,0,0],"max":[1,1,1]},"lods":{"0":{"file":0,"offset":0,"count":8}}})";
        for (int i = 1; i < nodes; ++i) { meta += "]}"; }
        return meta + "}";
    };
    const std::string too_deep = "nested more than 132 levels deep";
    const std::string childless =
        R"({"lodLevels":1,"filenames":[],"tree":{"bound":{"min":[0,0,0],"max":[0,0,0]},"children":[]}})";
    CHECK(loadScene(writeStreamed(folder, "scene", nest(64))).size() == 8);
    for (const auto& [meta, message] :
         {std::pair(std::string(), std::string("not JSON")),
          {makeLodMeta().substr(0, 300), "expected the levels of a streamed SOG scene"},
          {"[]", "is array, expected an object"},
          {"{}", "has no lodLevels, expected one"},
          {childless, "tree.children: is empty"},
          {nest(70), too_deep},
          {nest(100'000), too_deep},
          {std::string(1'000'000, '['), too_deep}}) {
        (void)folder.write("scene/lod-meta.json", meta);
        checkError("scene/lod-meta.json: ", folder.file("scene"));
        checkError(message, folder.file("scene"));
    }
}

#ifndef _WIN32  // on Windows, links need a privilege
TEST_CASE_FIXTURE(Streamed, "links that lead out of the folder or to the same chunk are refused") {
    fs::rename(source + "/b", folder.file("elsewhere"));
    fs::create_directory_symlink(folder.file("elsewhere"), source + "/b");
    std::string message = loadError(source);
    CHECK(contains(message, "scene/lod-meta.json: filenames[1]: "));
    CHECK(contains(message, "elsewhere/meta.json, expected a place within"));
    fs::remove(source + "/b");
    fs::create_directory_symlink("a", source + "/b");
    message = loadError(source);
    CHECK(contains(message, "filenames[1]: "));
    CHECK(contains(message, "is a link to a chunk that is named already"));
    // A link to the whole scene stays within it.
    fs::remove(source + "/b");
    fs::rename(folder.file("elsewhere"), source + "/b");
    fs::create_directory_symlink("scene", folder.file("linked"));
    CHECK(loadScene(folder.file("linked")).size() == 24);
}
#endif

TEST_CASE_FIXTURE(Streamed, "chunks that are missing or broken are named before any is decoded") {
    const std::string meta = makeSog().at("meta.json");
    const auto error = [&] {
        std::vector<double> shares;
        const std::string message = errorOf(
            [&] { (void)loadScene(source, 0, nullptr, [&](double share) { shares.push_back(share); }); });
        CHECK(shares == std::vector<double>{0.0});
        return message;
    };
    fs::remove(source + "/env/q.webp");
    CHECK(contains(error(), "scene/env/q.webp: no such file"));
    fs::remove(source + "/b/meta.json");
    CHECK(contains(error(), "scene/lod-meta.json: filenames[1]: "));
    CHECK(contains(error(), "scene/b/meta.json is not there, expected a chunk of the scene"));
    (void)folder.write("scene/a/meta.json", replaced(meta, "\"count\":8", "\"count\":4294967296"));
    CHECK(contains(error(), "scene/a/meta.json: count: is 4294967296, expected fewer than 256 for each"));
    (void)folder.write("scene/a/meta.json", "{");
    CHECK(contains(error(), "scene/a/meta.json: not JSON"));
}

}  // SUITE(streamed_sog)
