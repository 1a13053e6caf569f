// Streamed scenes on the device: something is visible at once, in the end all that the eyes need, if it fits.
#include "engine/stream/scene_stream.h"

#include "tests/engine/files/streamed_scenes.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/stream/split_scene.h"
#include "tests/run_program.h"
#ifdef BINOSPLAT_WEB_TESTS
#include "tests/engine/files/web/web_runs.h"
#endif

SUITE(scene_stream) {

constexpr std::uint64_t kSplats = 40'000;

std::array<Eye, 2> atelierEyes(std::uint32_t side_px = 256, double yaw_rad = 0.0) {
    Eye middle = eyeOf(*builtinView("atelier"), glm::uvec2(side_px));
    middle.world_from_camera.orientation =
        glm::angleAxis(yaw_rad, glm::dvec3(0.0, 1.0, 0.0)) * middle.world_from_camera.orientation;
    return stereoPair(middle, 0.063);
}

// The atelier in 64 leaves of four levels, in a folder that all tests share.
std::string writtenAtelier() {
    static const Workplace place;
    const std::string folder = (place.path / "split").string();
    if (place.isEmpty()) {
        splitScene(makeBuiltin("builtin:atelier", kSplats), folder,
                   {.leaf_splats = 1000, .levels = 4, .chunk_splats = 8000});
    }
    return folder;
}

struct Streamed : Gpu {
    [[nodiscard]] std::unique_ptr<SceneStream> open(const StreamSettings& settings = {},
                                                    const std::string& from = writtenAtelier(),
                                                    const WebSettings& web = {}) const {
        return std::make_unique<SceneStream>(context(), std::make_unique<ChunkSource>(from, web), settings);
    }
    // The left eye's full render.
    template <typename AnyScene>
    [[nodiscard]] Image pictureOf(const AnyScene& scene) const {
        KeptFrame frame(context(), scene);
        frame.render(eyes, full);
        return frame.readPicture(kLeft);
    }
    // Renders until nothing changes any more.
    template <typename PerFrame>
    void showUntilSettled(SceneStream& stream, StereoFrame& frame, std::span<const Eye> seen,
                          const PerFrame& per_frame) const {
        for (int frames = 0; frames < 100'000; ++frames) {
            stream.update(seen, 0.05);
            per_frame(frame.render(seen, full));
            if (stream.isSettled()) { return; }
            std::this_thread::yield();
        }
        FAIL("the stream does not settle");
    }

    Folder folder;
    std::array<Eye, 2> eyes = atelierEyes();
    const FrameSettings full = makeSettings(Mode::kShared);
};

TEST_CASE_FIXTURE(Streamed, "with room a view shows the whole scene; within a budget, the nearer the more") {
    const Image whole = pictureOf(loadScene(writtenAtelier()));
    const auto psnrWithin = [&](std::uint64_t budget) {
        const auto stream = open({.splat_budget = budget, .look_ahead_rad = 0.1});
        stream->settle(eyes);
        CHECK(stream->counters().splats_resident <= budget);
        return compare(pictureOf(stream->scene()), whole).psnrDb();
    };
    const double few_db = psnrWithin(kSplats / 8 + 64), more_db = psnrWithin(kSplats / 4),
                 many_db = psnrWithin(kSplats / 2);
    CHECK(few_db < more_db);
    CHECK(more_db < many_db);
    CHECK(many_db > 20.0);
    const auto stream = open();
    stream->settle(eyes);
    CHECK(stream->share() == 1.0);
    CHECK(compare(pictureOf(stream->scene()), whole).psnrDb() > 38.0);
    CHECK(stream->counters().splats_read > kSplats / 4);
    CHECK(these(stream->counters().splats_read, stream->takeLines(Waits::kBriefly).empty()) ==
          these(stream->counters().splats_resident, true));
}

TEST_CASE_FIXTURE(Streamed, "frames go on while levels come: the coarsest, then what the eyes ask for") {
    const auto stream = open({.splat_budget = kSplats / 2}), waited = open({.splat_budget = kSplats / 2});
    KeptFrame frame(context(), stream->scene());
    eyes = atelierEyes(96);
    bool coarse_is_whole = false;
    showUntilSettled(*stream, frame, eyes, [&](const FrameResult& result) {
        const StreamCounters counters = stream->counters();
        CHECK((counters.chunks_resident <= 64 || coarse_is_whole || counters.splats_resident >= kSplats / 8));
        coarse_is_whole = coarse_is_whole || counters.chunks_resident >= 64;
        CHECK(result.counters.splats_read <= kSplats);
        CHECK(counters.frames_waited_for_loading == 0);
    });
    waited->settle(eyes);
    CHECK(these(stream->counters().splats_read, stream->counters().chunks_resident) ==
          these(waited->counters().splats_resident, 64));
    CHECK(compare(pictureOf(stream->scene()), pictureOf(waited->scene())).psnrDb() > 60.0);
    // All the way round and back: nothing is left over.
    for (const double yaw : {1.5, 3.0, 4.5, 0.0}) {
        showUntilSettled(*stream, frame, atelierEyes(96, yaw), [&](const FrameResult& result) {
            CHECK(result.counters.splats_read <= 2 * kSplats);
        });
        CHECK(stream->counters().splats_read <= kSplats / 2);
        CHECK(stream->counters().chunks_resident == 64);
    }
}

TEST_CASE_FIXTURE(Streamed, "less memory than the finest level takes holds coarser ones") {
    const StreamSettings little{.memory_bytes = kSplats * 160};  // pages of the finest level are not full
    const auto stream = open(little);
    stream->settle(eyes);
    CHECK(stream->scene().bytes() <= little.memory_bytes);
    CHECK(stream->counters().chunks_resident == 64);
    CHECK(stream->counters().splats_resident == between(kSplats / 8, kSplats));
}

TEST_CASE_FIXTURE(Streamed, "where a chunk is missing the coarser level stays, and one line says so") {
    const std::string broken = writeStreamed(folder, "scene", makeLodMeta());
    std::filesystem::remove(broken + "/a/q.webp");
    const auto stream = open({}, broken);
    stream->settle(eyes);
    checkSays(stream->takeLines(Waits::kBriefly), "a/q.webp: no such file");
    CHECK(stream->counters().splats_resident == 8 + 8 + 8);  // c, b and the environment
    KeptFrame frame(context(), stream->scene());
    showUntilSettled(*stream, frame, eyes, [](const FrameResult&) {});
    CHECK(stream->counters().splats_resident == 8 + 8 + 8);
}

#ifdef BINOSPLAT_WEB_TESTS
TEST_CASE_FIXTURE(Streamed,
                  "a scene on the web shows what its folder does, coarser where a chunk is missing") {
    const auto local = open();
    local->settle(eyes);
    const std::uint64_t all = local->counters().splats_resident;
    const Image expected = pictureOf(local->scene());
    const WebPages files = filesOf(writtenAtelier());
    WebServer server(files);
    for (const bool is_gone : {false, true}) {
        CAPTURE(is_gone);
        const std::size_t asked = server.asked().size();
        if (is_gone) { server.stop(); }
        const auto stream = open({}, server.at("/lod-meta.json"), webSettings(folder));
        stream->settle(eyes);
        CHECK(stream->counters().splats_resident == all);
        CHECK(pictureOf(stream->scene()).values == expected.values);
        CHECK(stream->counters().frames_waited_for_loading == 0);
        CHECK((server.asked().size() == asked) == is_gone);
    }
    const std::string& chunk = files.at("/0_1.sog");
    const std::map<std::string, WebAnswer> faults{
        {"404", answer("404 Not Found")},
        {".sog", answer("200 OK", "", chunk.substr(0, chunk.size() / 2))},
        {"500", answer("500 Internal Server Error")}};
    for (const auto& [line, fault] : faults) {
        CAPTURE(line);
        const WebServer faulty([&files, &answered = fault](const WebRequest& request) {
            return request.path == "/0_1.sog" ? answered : answerFrom(files, request);
        });
        WebSettings web = webSettings(folder);
        web.cache_folder = folder.file(fmt::format("cache {}", line));
        web.fetch.attempts = 1;
        StreamSettings impatient;
        impatient.loader.first_pause = impatient.loader.most_pause = std::chrono::milliseconds(1);
        const auto stream = open(impatient, faulty.at("/lod-meta.json"), web);
        stream->settle(eyes);
        checkSays(stream->takeLines(Waits::kBriefly), line);
        // There is no hole.
        CHECK(stream->counters().splats_resident == between(all / 2, all));
        CHECK(compare(pictureOf(stream->scene()), expected).psnrDb() > 25.0);
    }
}
#endif

}  // SUITE(scene_stream)
