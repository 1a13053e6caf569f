// Facts about writing streamed SOG scenes.
#include "engine/files/streamed_write.h"
#include "engine/builtin/procedural.h"
#include "engine/files/lod_meta.h"
#include "engine/files/scene_spill.h"
#include "engine/scene/pick_splats.h"
#include "tests/engine/files/sog_scenes.h"

SUITE(streamed_write) {

std::map<std::string, std::string> filesIn(const fs::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(folder)) {
        const std::string name = entry.path().lexically_relative(folder).generic_string();
        if (entry.is_regular_file()) { files[name] = textIn(entry.path()); }
    }
    return files;
}

std::vector<float> sortedX(const Scene& scene) {
    std::vector<float> values;
    for (const glm::vec3& position : scene.positions) { values.push_back(position.x); }
    std::ranges::sort(values);
    return values;
}

struct Wall : InFolder {
    const Scene scene = makeBuiltin("builtin:slanted-wall");

    // Of the scene that is written to a folder of this name.
    [[nodiscard]] std::string pathOf(const std::string& name) const {
        return folder.file(name + "/lod-meta.json");
    }
    [[nodiscard]] LodMeta metaOf(const std::string& name) const {
        const std::string text = textIn(pathOf(name));
        return parseLodMeta(std::as_bytes(std::span(text)), "lod-meta.json");
    }
    [[nodiscard]] Scene picked(const std::vector<std::uint32_t>& splats) const {
        return pickSplats(scene, splats);
    }
};

TEST_CASE_FIXTURE(Wall, "levels read back whole, the same bytes every time; a taken folder is left") {
    std::vector<std::uint32_t> half;
    for (std::uint32_t splat = 0; splat < scene.size(); splat += 2) { half.push_back(splat); }
    const Scene coarse = picked(half);
    const auto write = [&](const std::string& name, const Progress& progress = {}) {
        StreamedWriter writer(pathOf(name), {.chunk_splats = 700, .leaf_splats = 250});
        writer.cutLeaves(scene.positions);
        writer.add(0, scene, {}, 0, progress);
        writer.add(1, coarse);
        writer.finish();
    };
    write("a");
    write("b");
    const auto files = filesIn(folder.file("a"));
    CHECK(these(files, files.contains("0_2/meta.json")) == these(filesIn(folder.file("b")), true));
    CHECK(
        files.at("lod-meta.json")
            .starts_with(R"({"version":1,"asset":{"generator":"binosplat"},"count":2522,"counts":[1681,841],)"
                         R"("lodLevels":2,"lodErrors":false,)"));
    for (const auto& [level, whole] : {std::pair(0u, &scene), std::pair(1u, &coarse)}) {
        const std::vector<float> back = sortedX(loadScene(folder.file("a"), 0, nullptr, {}, {level, {}})),
                                 expected = sortedX(*whole);
        REQUIRE(back.size() == expected.size());
        for (std::size_t i = 0; i < back.size(); ++i) { CHECK(std::abs(back[i] - expected[i]) < 1e-3f); }
    }
    CHECK_THROWS(write("c", [](double) { throw std::runtime_error("cancelled"); }));
    CHECK_THROWS_WITH_AS(write("a"),
                         (folder.file("a") + ": is there already, must be absent or empty").c_str(), Error);
    CHECK(filesIn(folder.file("")).size() == 2 * files.size());
}

TEST_CASE_FIXTURE(Wall, "large splats of a coarser level do not make a leaf's box larger") {
    Scene large = picked({0, 700, 1600});
    for (glm::vec2& scale : large.scales) { scale = glm::vec2(50.0f); }
    const auto boxesWith = [&](const std::string& name, const Scene& coarse) {
        StreamedWriter writer(pathOf(name), {.leaf_splats = 250});
        writer.cutLeaves(scene.positions);
        writer.add(0, scene);
        writer.add(1, coarse);
        writer.finish();
        std::vector<glm::vec3> corners;
        for (const LodLeaf& leaf : metaOf(name).tree) {
            corners.insert(corners.end(), {leaf.low, leaf.high});
        }
        return corners;
    };
    CHECK(boxesWith("large", large) == boxesWith("small", picked({0})));
}

TEST_CASE_FIXTURE(Wall, "an environment is a chunk of its own that every level shows, and no leaf holds") {
    Scene sky = picked({0, 1, 2});
    for (glm::vec3& position : sky.positions) { position.z += 900.0f; }
    StreamedWriter writer(pathOf("a"), {.leaf_splats = 250});
    writer.cutLeaves(scene.positions);
    for (const std::size_t level : {0u, 1u}) { writer.add(level, scene); }
    writer.addEnvironment(sky);
    writer.finish();
    const LodMeta meta = metaOf("a");
    CHECK(these(meta.environment, meta.levels[0].splats) == these("env/meta.json", scene.size()));
    for (const LodLeaf& leaf : meta.tree) { CHECK(leaf.high.z < 100.0f); }
    for (const std::uint32_t level : {0u, 1u}) {
        LoadNotes notes;
        const Scene back = loadScene(folder.file("a"), 0, &notes, {}, {level, {}});
        REQUIRE(these(back.size(), notes.environment_splats) == these(scene.size() + 3, 3u));
        CHECK(back.positions.back().z == doctest::Approx(sky.positions[2].z).epsilon(1e-3));
    }
}

TEST_CASE_FIXTURE(Wall, "what levels are off by adds up, never falls, and is the mean where nobody looked") {
    Scene row = scene;
    for (std::size_t i = 0; i < row.size(); ++i) {
        row.positions[i] = glm::vec3(static_cast<float>(i), 0.0f, 0.0f);
    }
    const float cut = row.positions[row.size() / 2].x;
    StreamedWriter writer(pathOf("a"), {.leaf_splats = row.size() / 2 + 1});
    writer.cutLeaves(row.positions);
    writer.add(0, row);
    const auto sees = [&](const SplatError& left, const SplatError& right) {
        std::vector<SplatError> errors;
        for (const glm::vec3& p : row.positions) { errors.push_back(p.x < cut ? left : right); }
        return errors;
    };
    writer.add(1, row, sees({2.0, 2.0 * 0.25}, {2.0, 2.0 * 0.5}));
    writer.add(2, row, sees({1.0, 0.125}, {1.0, 0.25}), 1);
    writer.add(3, row, sees({1.0, 0.125}, {}));
    writer.finish();
    const LodMeta meta = metaOf("a");
    REQUIRE(these(meta.has_errors, meta.tree.size()) == these(true, 2u));
    for (const LodLeaf& leaf : meta.tree) {
        const bool is_left = leaf.low.x < 0.0f;
        CHECK(leaf.errors ==
              (is_left ? std::vector{0.0f, 0.25f, 0.375f, 0.375f} : std::vector{0.0f, 0.5f, 0.75f, 0.75f}));
    }
}

TEST_CASE_FIXTURE(Wall, "blocks are whole leaves, no larger than asked for, and are added one by one") {
    StreamedWriter writer(pathOf("a"), {.leaf_splats = 100});
    writer.cutLeaves(scene.positions);
    std::vector<std::uint32_t> all;
    for (const std::vector<std::uint32_t>& block : writer.sortInto(writer.cutBlocks(500), scene.positions)) {
        CHECK(these(block.size() <= 500, block.size() > 200) == these(true, true));
        all.insert(all.end(), block.begin(), block.end());
        for (const std::size_t level : {0u, 1u}) { writer.add(level, picked(block)); }
    }
    std::ranges::sort(all);
    std::vector<std::uint32_t> expected(scene.size());
    std::iota(expected.begin(), expected.end(), 0u);
    CHECK(all == expected);
    CHECK(writer.counts() == std::vector<std::uint64_t>(2, scene.size()));
    writer.finish();
    for (const LodLeaf& leaf : metaOf("a").tree) { CHECK(leaf.levels.size() == 2); }
    CHECK(sortedX(loadScene(folder.file("a"))).size() == scene.size());
}

TEST_CASE_FIXTURE(Wall, "a scene that waits on the disk comes back as it was, and leaves nothing there") {
    Scene solids = picked({3, 1});
    solids.thicknesses = {0.5f, 0.25f};
    {
        SceneSpill spill(folder.file("spill"));
        std::vector<std::uint32_t> all(scene.size());
        std::iota(all.begin(), all.end(), 0u);
        spill.add(0, pickSplats(scene, std::span(all).first(all.size() / 2)));
        spill.add(1, solids);
        spill.add(0, pickSplats(scene, std::span(all).subspan(all.size() / 2)));
        for (const std::size_t i : {0, 1}) {
            const Scene &was = i == 0 ? scene : solids, is = spill.read(i);
            checkSameScene(is, was);
            CHECK(is.name == was.name);
        }
    }
    CHECK(!fs::exists(folder.file("spill")));
    CHECK_THROWS_AS(SceneSpill(folder.file("no/folder")), Error);
}

}  // SUITE(streamed_write)
