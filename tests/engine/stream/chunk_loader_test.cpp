// Parts of streamed scenes, loaded beside the frames: what is requested, in that order, whatever files do.
#include "engine/stream/chunk_loader.h"

#include "engine/builtin/procedural.h"
#include "tests/engine/files/streamed_scenes.h"
#include "tests/engine/stream/split_scene.h"
#include "tests/run_program.h"
#ifdef BINOSPLAT_WEB_TESTS
#include "tests/engine/files/web/web_runs.h"
#endif

SUITE(chunk_loader) {

constexpr std::chrono::milliseconds kPatience(60'000);

// 20,000 splats in 32 leaves of four levels, several leaves to a file, in a folder that all tests share.
std::string writtenSplit() {
    static const Workplace place;
    const std::string folder = (place.path / "split").string();
    if (place.isEmpty()) {
        splitScene(makeBuiltin("builtin:atelier", 20'000), folder,
                   {.leaf_splats = 1000, .levels = 4, .chunk_splats = 4000});
    }
    return folder;
}

std::unique_ptr<ChunkSource> open(const std::string& source = writtenSplit(), const WebSettings& web = {}) {
    return std::make_unique<ChunkSource>(source, web);
}

// One level of every leaf.
std::vector<LeafLevel> everyLeaf(const ChunkSource& source, std::uint32_t level) {
    std::vector<LeafLevel> all;
    for (std::uint32_t leaf = 0; leaf < source.leaves().size(); ++leaf) { all.push_back({leaf, level}); }
    return all;
}

// Takes until nothing more comes.
std::vector<LoadedPart> takeAll(ChunkLoader& loader) {
    std::vector<LoadedPart> all;
    while (!loader.isDone()) {
        REQUIRE(loader.waitForNews(kPatience));
        for (LoadedPart& part : loader.take()) { all.push_back(std::move(part)); }
    }
    return all;
}

std::vector<LeafLevel> placesOf(const std::vector<LoadedPart>& parts) {
    std::vector<LeafLevel> places;
    for (const LoadedPart& part : parts) { places.push_back(part.at); }
    return places;
}

TEST_CASE("what is wished for comes whole, the coarsest level before any finer one") {
    ChunkLoader loader(open(), {});
    const ChunkSource& source = loader.source();
    loader.want(everyLeaf(source, 3), everyLeaf(source, 0));
    const std::vector<LoadedPart> parts = takeAll(loader);
    REQUIRE(parts.size() == 64);
    std::map<std::size_t, Scene> files;
    std::uint64_t splats = 0;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const LeafLevel at = parts[i].at;
        const LodLeaf& leaf = source.leaves()[at.leaf];
        CHECK(at.level == (i < 32 ? 3 : 0));
        const LodRange& range = leaf.levels[at.level];
        if (!files.contains(range.file)) {
            files[range.file] = loadScene(writtenSplit() + "/" + source.meta().files[range.file]);
        }
        REQUIRE(parts[i].splats == range.splats.count);
        REQUIRE(parts[i].scene.size() == range.splats.count);
        splats += range.splats.count;
        const std::span expected(&files[range.file].positions[range.splats.first], range.splats.count);
        CHECK(std::ranges::equal(parts[i].scene.positions, expected));
        CHECK(std::ranges::all_of(expected, [&](const glm::vec3& p) {
            return glm::clamp(p, leaf.low - 0.01f, leaf.high + 0.01f) == p;
        }));
        CHECK(parts[i].scene.isGaussian3d());
    }
    CHECK(loader.takeLines().empty());
    CHECK(files.size() > 4);
    const LoaderWork work = loader.tryWork().value();
    CHECK(work.splats == splats);
    CHECK(work.seconds > 0.0);
}

TEST_CASE("the same wishes give the same parts in the same order, on any number of threads") {
    const auto orderOn = [](int threads) {
        const auto kept_files = static_cast<std::size_t>(threads) - 1;
        ChunkLoader loader(open(), {.threads = threads, .kept_files = kept_files});
        loader.want(everyLeaf(loader.source(), 3), {{5, 1}, {31, 0}, {7, 1}, {6, 2}});
        return placesOf(takeAll(loader));
    };
    const std::vector<LeafLevel> order = orderOn(1);
    CHECK(order.size() == 36);
    CHECK(orderOn(3) == order);
}

TEST_CASE("wishes that are given up are not loaded, and what waits is bounded") {
    ChunkLoader loader(open(), {.waiting_splats = 1});  // no second batch before the first is taken
    const std::vector<LeafLevel> all = everyLeaf(loader.source(), 0);
    loader.want({}, all);
    REQUIRE(loader.waitForNews(kPatience));
    loader.want({}, {{31, 2}});
    const std::vector<LoadedPart> parts = takeAll(loader);
    CHECK(parts.size() <= 9);  // the batch that was already there
    CHECK(placesOf(parts).back() == LeafLevel{31, 2});
    // Parts that are waiting to be taken are not loaded again.
    loader.want({}, {{30, 2}});
    REQUIRE(loader.waitForNews(kPatience));
    loader.want({}, {{30, 2}, {29, 2}});
    CHECK(placesOf(takeAll(loader)) == std::vector<LeafLevel>{{30, 2}, {29, 2}});
    loader.want({}, all);  // nor does leaving with open requests take time
}

TEST_CASE_FIXTURE(InFolder, "of a file that is broken or missing one line says so, and the others come") {
    const auto check = [&](const std::string& source, const std::vector<LeafLevel>& coarsest,
                           const std::vector<LeafLevel>& finer, const std::vector<LeafLevel>& come,
                           const std::string& line) {
        ChunkLoader loader(open(source), {});
        REQUIRE(loader.source().leaves().size() == 4);  // with the environment
        loader.want(coarsest, finer);
        CHECK(placesOf(takeAll(loader)) == come);
        checkSays(loader.takeLines(), line);
        CHECK(these(loader.takeLines().empty(), loader.brokenFiles().value(), loader.isDone()) ==
              these(true, std::vector<bool>{false, true, false, false}, true));
    };
    // Ranges beyond the end of a chunk break only that chunk.
    const std::string longer =
        replaced(makeLodMeta(), R"("file":1,"offset":0,"count":8)", R"("file":1,"offset":0,"count":9)");
    check(writeStreamed(folder, "scene", longer), {{2, 0}, {0, 1}}, {}, {{0, 1}},
          "a leaf names splat 8 of filenames[1] (b/meta.json), which has 8");
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    std::filesystem::remove(source + "/b/q.webp");
    check(source, {{3, 0}, {0, 1}, {1, 1}, {2, 0}}, {{0, 0}, {1, 0}},
          {{3, 0}, {0, 1}, {1, 1}, {0, 0}, {1, 0}}, "b/q.webp: no such file");
}

#ifdef BINOSPLAT_WEB_TESTS
TEST_CASE_FIXTURE(InFolder, "a server that goes away is waited for: one line, and the rest when it is back") {
    const WebPages files = filesOf(writtenSplit());
    std::atomic<bool> is_down = false;
    const WebServer server([&](const WebRequest& request) {
        return is_down ? answer("503 Service Unavailable") : answerFrom(files, request);
    });
    WebSettings web = webSettings(folder);
    web.fetch.attempts = 1;
    LoaderSettings settings;
    settings.first_pause = settings.most_pause = std::chrono::milliseconds(1);
    ChunkLoader loader(open(server.at("/lod-meta.json"), web), settings);
    loader.want(everyLeaf(loader.source(), 3), {});
    CHECK(takeAll(loader).size() == 32);
    is_down = true;
    const std::vector<LeafLevel> finest = everyLeaf(loader.source(), 0);
    loader.want({}, finest);
    std::vector<std::string> lines;
    while (lines.empty()) {
        REQUIRE(loader.waitForNews(kPatience));
        lines = loader.takeLines();
    }
    CHECK(contains(lines[0], "503"));
    is_down = false;
    std::set<std::uint32_t> leaves;
    while (leaves.size() < finest.size()) {
        (void)loader.waitForNews(kPatience);
        for (const LoadedPart& part : loader.take()) { leaves.insert(part.at.leaf); }
        for (const std::string& line : loader.takeLines()) { lines.push_back(line); }
    }
    CHECK(lines.size() == 1);
    CHECK(loader.isDone());
    // Each file once, except those that failed.
    CHECK(std::ranges::count(server.asked(), "/3_0.sog") == 1);
}
#endif

}  // SUITE(chunk_loader)
