// Scenes that are split into streamed ones: every splat is somewhere, in leaves that say where, with half as many from level to level.
#include "tests/engine/stream/split_scene.h"

#include "engine/scene/procedural.h"
#include "engine/scene/streamed_chunks.h"
#include "tests/engine/scene/ply_files.h"

TEST_SUITE_BEGIN("split_scene");

namespace split_scene_test {

using namespace binosplat;
using namespace binosplat::test;

TEST_CASE("the finest level has every splat, each coarser one half of them, in leaves that hold them") {
    const Folder folder;
    const Scene scene = makeBuiltin("builtin:atelier", 20'000);
    splitScene(scene, folder.file("split"), {.leaf_splats = 1000, .levels = 4, .chunk_splats = 4000});
    LoadNotes notes;
    const Scene finest = loadScene(folder.file("split"), 0, &notes);
    CHECK(finest.size() == scene.size());
    REQUIRE(notes.level_splats.size() == 4);
    StreamedChunks chunks(folder.file("split"));
    const LodMeta& meta = chunks.meta();
    CHECK(meta.tree.size() == 32);
    CHECK(meta.files.size() > 4);
    for (std::size_t level = 1; level < 4; ++level) {
        CHECK(notes.level_splats[level] >= notes.level_splats[level - 1] / 2);
        CHECK(notes.level_splats[level] <= notes.level_splats[level - 1] / 2 + meta.tree.size());
    }
    std::uint64_t found = 0;
    for (const LodLeaf& leaf : meta.tree) {
        REQUIRE(leaf.levels.size() == 4);
        CHECK(leaf.levels[0].splats.count <= 1000);
        const Scene chunk = loadScene(folder.file("split/" + meta.files[leaf.levels[0].file]));
        for (std::uint64_t i = 0; i < leaf.levels[0].splats.count; ++i) {
            const glm::vec3& p = chunk.positions[leaf.levels[0].splats.first + i];
            found += glm::all(glm::greaterThan(p, leaf.low - 0.01f)) && glm::all(glm::lessThan(p, leaf.high + 0.01f));
        }
    }
    CHECK(found == scene.size());
    // What a level covers stays about the same.
    const auto area = [](const Scene& of) {
        double sum = 0.0;
        for (std::size_t i = 0; i < of.size(); ++i) { sum += static_cast<double>(of.scales[i].x * of.scales[i].y * of.opacities[i]); }
        return sum;
    };
    const Scene coarsest = loadScene(folder.file("split"), 0, nullptr, {}, {3, {}});
    CHECK(area(coarsest) / area(finest) > 0.7);
    CHECK(area(coarsest) / area(finest) < 1.4);
}

}  // namespace split_scene_test
