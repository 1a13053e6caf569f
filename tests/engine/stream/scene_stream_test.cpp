// Streamed scenes on the device: something to see at once, all that the eyes ask for in the end, and never more than there is room for.
#include "engine/stream/scene_stream.h"

#include "engine/frame/stereo_frame.h"
#include "engine/picture/metrics.h"
#include "engine/scene/procedural.h"
#include "tests/engine/gpu/gpu_fixture.h"
#include "tests/engine/scene/streamed_scenes.h"
#include "tests/engine/stream/split_scene.h"
#ifdef BINOSPLAT_WEB_TESTS
#include "tests/engine/web/web_runs.h"
#endif

#include <set>
#include <thread>

TEST_SUITE_BEGIN("scene_stream");

namespace scene_stream_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr std::uint64_t kSplats = 40'000;

// In 64 leaves of four levels.
std::string writeAtelier(const Folder& folder) {
    splitScene(makeBuiltin("builtin:atelier", kSplats), folder.file("split"), {.leaf_splats = 1000, .levels = 4, .chunk_splats = 8000});
    return folder.file("split");
}

std::array<Eye, 2> atelierEyes(double yaw_rad = 0.0) {
    const View view = *builtinView("atelier");
    Eye middle{lookAt(view.eye, view.look, view.up), intrinsicsFromFovX(glm::radians(view.fov_x_deg), {256, 256}), {256, 256}};
    middle.world_from_camera.orientation = glm::angleAxis(yaw_rad, glm::dvec3(0.0, 1.0, 0.0)) * middle.world_from_camera.orientation;
    return stereoPair(middle, 0.063);
}

std::unique_ptr<SceneStream> streamOf(const Context& context, const std::string& source, const StreamSettings& settings = {}) {
    return std::make_unique<SceneStream>(context, std::make_unique<ChunkSource>(source, WebSettings()), settings);
}

Image pictureOf(const Context& context, const GpuScene& scene, std::span<const Eye> eyes) {
    StereoFrame frame(context, scene);
    FrameSettings settings;
    settings.mode = Mode::kShared;
    (void)frame.render(eyes, settings);
    return frame.readPicture(kLeft);
}

// Frames until nothing changes any more.
template <typename PerFrame>
void showUntilSettled(SceneStream& stream, StereoFrame& frame, std::span<const Eye> eyes, const PerFrame& per_frame) {
    FrameSettings settings;
    settings.mode = Mode::kShared;
    for (int frames = 0; frames < 100'000; ++frames) {
        stream.update(eyes, 0.05);
        const FrameResult result = frame.render(eyes, settings);
        per_frame(frames, result);
        if (stream.isSettled()) { return; }
        std::this_thread::yield();
    }
    FAIL("the stream does not settle");
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "with room for all of it a view shows what the whole scene shows") {
    const Folder folder;
    const std::string source = writeAtelier(folder);
    const auto stream = streamOf(context(), source);
    const std::array<Eye, 2> eyes = atelierEyes();
    stream->settle(eyes);
    CHECK(stream->share() == 1.0);
    const GpuScene whole(context(), loadScene(source));
    const Image streamed = pictureOf(context(), stream->scene(), eyes), full = pictureOf(context(), whole, eyes);
    CHECK(compare(streamed, full).psnrDb() > 38.0);
    CHECK(stream->counters().splats_read > kSplats / 4);
    CHECK(stream->counters().splats_read == stream->counters().splats_resident);
    CHECK(stream->takeLines().empty());
}

TEST_CASE_FIXTURE(Gpu, "budgets are kept, more splats are nearer to the whole, and the same calls give the same picture") {
    const Folder folder;
    const std::string source = writeAtelier(folder);
    const std::array<Eye, 2> eyes = atelierEyes();
    const GpuScene whole(context(), loadScene(source));
    const Image full = pictureOf(context(), whole, eyes);
    double before_db = 0.0;
    for (const std::uint64_t budget : {kSplats / 8 + 64, kSplats / 4, kSplats / 2}) {
        CAPTURE(budget);
        StreamSettings settings;
        settings.splat_budget = budget;
        settings.look_ahead_rad = 0.1;
        const auto stream = streamOf(context(), source, settings);
        stream->settle(eyes);
        CHECK(stream->counters().splats_resident <= budget);
        const Image picture = pictureOf(context(), stream->scene(), eyes);
        const double psnr_db = compare(picture, full).psnrDb();
        CHECK(psnr_db > before_db);
        before_db = psnr_db;
        settings.loader.threads = 1;
        settings.loader.kept_files = 0;
        const auto again = streamOf(context(), source, settings);
        again->settle(eyes);
        CHECK(pictureOf(context(), again->scene(), eyes).values == picture.values);
    }
    CHECK(before_db > 20.0);
}

TEST_CASE_FIXTURE(Gpu,
                  "frames go on while levels come: the coarsest of all first, then what the eyes ask for, as if it had been waited for") {
    const Folder folder;
    const std::string source = writeAtelier(folder);
    StreamSettings settings;
    settings.splat_budget = kSplats / 2;
    const auto stream = streamOf(context(), source, settings), waited = streamOf(context(), source, settings);
    StereoFrame frame(context(), stream->scene());
    const std::array<Eye, 2> eyes = atelierEyes();
    bool coarse_is_whole = false;
    showUntilSettled(*stream, frame, eyes, [&](int, const FrameResult& result) {
        const StreamCounters counters = stream->counters();
        if (counters.chunks_resident > 64) { CHECK((coarse_is_whole || counters.splats_resident >= kSplats / 8)); }
        coarse_is_whole = coarse_is_whole || counters.chunks_resident >= 64;
        CHECK(result.counters.splats_read <= kSplats);
        CHECK(counters.frames_waited_for_loading == 0);
    });
    waited->settle(eyes);
    CHECK(stream->counters().splats_read == waited->counters().splats_resident);
    CHECK(stream->counters().chunks_resident == 64);
    CHECK(compare(pictureOf(context(), stream->scene(), eyes), pictureOf(context(), waited->scene(), eyes)).psnrDb() > 60.0);
    // All round and back: nothing is left over.
    for (const double yaw : {1.5, 3.0, 4.5, 0.0}) {
        showUntilSettled(*stream, frame, atelierEyes(yaw),
                         [&](int, const FrameResult& result) { CHECK(result.counters.splats_read <= 2 * kSplats); });
        CHECK(stream->counters().splats_read <= kSplats / 2);
        CHECK(stream->counters().chunks_resident == 64);
    }
}

TEST_CASE_FIXTURE(Gpu, "less memory than the finest level takes holds coarser ones") {
    const Folder folder;
    const std::string source = writeAtelier(folder);
    StreamSettings settings;
    settings.memory_bytes = kSplats * 160;  // pages of the finest level are not full
    const auto stream = streamOf(context(), source, settings);
    const std::array<Eye, 2> eyes = atelierEyes();
    stream->settle(eyes);
    CHECK(stream->scene().bytes() <= settings.memory_bytes);
    CHECK(stream->counters().chunks_resident == 64);
    const std::uint64_t coarse = stream->counters().splats_resident;
    CHECK(coarse < kSplats);
    CHECK(coarse > kSplats / 8);
}

TEST_CASE_FIXTURE(Gpu, "where a chunk is missing the coarser level stays, and one line says so") {
    const Folder folder;
    const std::string source = writeStreamed(folder, "scene", makeLodMeta());
    std::filesystem::remove(source + "/a/q.webp");
    const auto stream = streamOf(context(), source);
    const std::array<Eye, 2> eyes = atelierEyes();
    stream->settle(eyes);
    const std::vector<std::string> lines = stream->takeLines();
    REQUIRE(lines.size() == 1);
    CHECK(contains(lines[0], "a/q.webp: no such file"));
    CHECK(stream->counters().splats_resident == 8 + 8 + 8);  // c, b and the environment
    StereoFrame frame(context(), stream->scene());
    showUntilSettled(*stream, frame, eyes, [](int, const FrameResult&) {});
    CHECK(stream->counters().splats_resident == 8 + 8 + 8);
}

#ifdef BINOSPLAT_WEB_TESTS
namespace {

std::map<std::string, std::string> filesAt(const std::string& folder) {
    std::map<std::string, std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        std::ifstream file(entry.path(), std::ios::binary);
        files["/" + entry.path().filename().string()] = {std::istreambuf_iterator<char>(file), {}};
    }
    return files;
}

std::unique_ptr<SceneStream> streamOf(const Context& context, const std::string& address, const WebSettings& web) {
    StreamSettings settings;
    settings.loader.first_pause = settings.loader.most_pause = std::chrono::milliseconds(1);
    return std::make_unique<SceneStream>(context, std::make_unique<ChunkSource>(address, web), settings);
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "a scene at an address shows what its folder shows, and again when its server is gone") {
    const Folder folder;
    const std::string source = writeAtelier(folder);
    const std::array<Eye, 2> eyes = atelierEyes();
    const auto local = streamOf(context(), source);
    local->settle(eyes);
    const Image expected = pictureOf(context(), local->scene(), eyes);
    WebServer server(filesAt(source));
    const WebSettings web = webSettings(folder);
    for (const bool is_gone : {false, true}) {
        CAPTURE(is_gone);
        const std::size_t asked = server.asked().size();
        if (is_gone) { server.stop(); }
        const auto stream = streamOf(context(), server.at("/lod-meta.json"), web);
        stream->settle(eyes);
        CHECK(stream->counters().splats_resident == local->counters().splats_resident);
        CHECK(pictureOf(context(), stream->scene(), eyes).values == expected.values);
        CHECK(stream->counters().frames_waited_for_loading == 0);
        CHECK((server.asked().size() == asked) == is_gone);
    }
}

TEST_CASE_FIXTURE(Gpu, "whatever a server does to a chunk, the coarser level stays until it comes, and one line says what is wrong") {
    const Folder folder;
    splitScene(makeBuiltin("builtin:atelier", 8'000), folder.file("split"), {.leaf_splats = 500, .levels = 3, .chunk_splats = 2000});
    const std::string source = folder.file("split");
    const std::map<std::string, std::string> files = filesAt(source);
    const std::array<Eye, 2> eyes = atelierEyes();
    const auto local = streamOf(context(), source);
    local->settle(eyes);
    const std::uint64_t all = local->counters().splats_resident;
    const Image expected = pictureOf(context(), local->scene(), eyes);

    struct Fault {
        const char* name;
        bool comes;  // in the end
        std::function<WebAnswer(const std::string& body)> answer;
        bool once = true;
        const char* line = "";
    };
    using Then = WebAnswer::Then;
    const auto half = [](const std::string& body) { return body.substr(0, body.size() / 2); };
    const std::vector<Fault> faults{
        {"busy", true, [](const std::string&) { return answer("429 Too Many Requests", "Retry-After: 0\r\n"); }},
        {"broken", true, [](const std::string&) { return answer("500 Internal Server Error"); }},
        {"cuts off", true,
         [&](const std::string& body) {
             return WebAnswer{fmt::format("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n\r\n{}", body.size(), half(body)), Then::kClose};
         }},
        {"falls silent", true,
         [&](const std::string& body) {
             return WebAnswer{fmt::format("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n\r\n{}", body.size(), half(body)), Then::kHang};
         }},
        {"says more than there is", true,
         [](const std::string& body) {
             return WebAnswer{fmt::format("HTTP/1.1 200 OK\r\nContent-Length: {}\r\n\r\n{}", body.size() + 10, body), Then::kClose};
         }},
        {"not there", false, [](const std::string&) { return answer("404 Not Found"); }, false, "404"},
        {"says less than there is", false, [&](const std::string& body) { return answer("200 OK", "", half(body)); }, false, ".sog"},
        {"another file", false, [](const std::string&) { return answer("200 OK", "", "<html>hello</html>"); }, false, ".sog"},
        {"broken for good", false, [](const std::string&) { return answer("500 Internal Server Error"); }, false, "500"},
    };
    for (const Fault& fault : faults) {
        CAPTURE(std::string(fault.name));
        std::atomic<int> hits = 0;
        const WebServer server([&](const WebRequest& request) {
            const auto found = files.find(request.path);
            if (found == files.end()) { return answer("404 Not Found"); }
            if (request.path == "/0_1.sog" && (hits++ == 0 || !fault.once)) { return fault.answer(found->second); }
            return answer("200 OK", "", found->second);
        });
        const Folder own;  // with a cache of its own
        WebSettings web = webSettings(own);
        web.fetch.attempts = fault.once ? 4 : 1;
        web.fetch.patience = std::chrono::milliseconds(500);
        const auto stream = streamOf(context(), server.at("/lod-meta.json"), web);
        stream->settle(eyes);
        CHECK(hits > 0);
        const std::vector<std::string> lines = stream->takeLines();
        const Image shown = pictureOf(context(), stream->scene(), eyes);
        if (fault.comes) {
            CHECK(lines.empty());
            CHECK(stream->counters().splats_resident == all);
            CHECK(shown.values == expected.values);
            continue;
        }
        CAPTURE(fmt::format("{}", fmt::join(lines, "\n")));
        REQUIRE(lines.size() == 1);
        CHECK(contains(lines[0], fault.line));
        // Of those leaves the next coarser level, so that there is no hole.
        CHECK(stream->counters().splats_resident < all);
        CHECK(stream->counters().splats_resident > all / 2);
        CHECK(compare(shown, expected).psnrDb() > 25.0);
    }
}
#endif

}  // namespace scene_stream_test
