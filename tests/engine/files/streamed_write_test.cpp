// Facts about writing streamed SOG scenes.
#include "engine/files/streamed_write.h"
#include "engine/builtin/procedural.h"
#include "engine/scene/pick_splats.h"
#include "tests/engine/files/sog_scenes.h"

SUITE(streamed_write) {

std::map<std::string, std::string> filesIn(const std::filesystem::path& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.is_regular_file()) { files[entry.path().lexically_relative(folder).generic_string()] = textIn(entry.path()); }
    }
    return files;
}

std::vector<float> sortedX(const Scene& scene) {
    std::vector<float> values;
    for (const glm::vec3& position : scene.positions) { values.push_back(position.x); }
    std::ranges::sort(values);
    return values;
}

TEST_CASE("levels are written that read back whole, the same bytes every time; a folder that is cancelled or taken is left as it was") {
    const Folder folder;
    const Scene scene = makeBuiltin("builtin:slanted-wall");
    std::vector<std::uint32_t> half;
    for (std::uint32_t splat = 0; splat < scene.size(); splat += 2) { half.push_back(splat); }
    const Scene coarse = pickSplats(scene, half);
    const auto write = [&](const std::string& name, const Progress& progress = {}) {
        StreamedWriter writer(folder.file(name) + "/lod-meta.json", {.chunk_splats = 700, .leaf_splats = 250});
        writer.addLevel(scene, progress);
        writer.addLevel(coarse);
        writer.finish();
    };
    write("a");
    write("b");
    const auto files = filesIn(folder.file("a"));
    CHECK(these(files, files.contains("0_2/meta.json")) == these(filesIn(folder.file("b")), true));
    CHECK(files.at("lod-meta.json")
              .starts_with(R"({"version":1,"asset":{"generator":"binosplat"},"count":2522,"counts":[1681,841],"lodLevels":2,)"));
    for (const auto& [level, whole] : {std::pair(0u, &scene), std::pair(1u, &coarse)}) {
        const std::vector<float> back = sortedX(loadScene(folder.file("a"), 0, nullptr, {}, {level, {}})), expected = sortedX(*whole);
        REQUIRE(back.size() == expected.size());
        for (std::size_t i = 0; i < back.size(); ++i) { CHECK(std::abs(back[i] - expected[i]) < 1e-3f); }
    }
    CHECK_THROWS(write("c", [](double) { throw std::runtime_error("cancelled"); }));
    CHECK_THROWS_WITH_AS(write("a"), (folder.file("a") + ": is there already, must be absent or empty").c_str(), Error);
    CHECK(filesIn(folder.file("")).size() == 2 * files.size());
}

}  // SUITE(streamed_write)
