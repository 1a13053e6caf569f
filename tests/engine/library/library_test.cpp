// Facts about libbinosplat as other programs see it: what it exports, its pictures, and its errors.
#include "engine/picture/image_io.h"
#include "tests/engine/library/earlier_program.h"
#include "tests/engine/library/library_runs.h"
#include "tests/shared_data.h"

SUITE(library) {

TEST_CASE_FIXTURE(AtWork, "it exports bsp_* and nothing else, under a name of its own version") {
    std::istringstream symbols(work.runCommand("nm -D --defined-only '" BINOSPLAT_LIBRARY_FILE "'").output);
    int count = 0;
    for (std::string address, kind, name; symbols >> address >> kind >> name; ++count) {
        CHECK_MESSAGE(name.starts_with("bsp_"), name);
    }
    CHECK(count >= 18);
    const std::string header = work.runCommand("readelf -d '" BINOSPLAT_LIBRARY_FILE "'").output;
    CHECK(contains(header, "[libbinosplat.so.0]"));
}

TEST_CASE_FIXTURE(Opened, "its pictures are render's to the last bit, its depths those of what pixels show") {
    const bsp::Scene scene = load("builtin:fence");
    const double eye[]{0.1, -0.2, -1.0}, look[]{0.0, 0.0, 2.0}, up[]{0.0, -1.0, 0.0};
    const bsp::Views views = bsp::lookAt(eye, look, up, 0.063, 1.2, 96, 64);
    for (const std::string name : {"shared", "predicted"}) {
        go("render builtin:fence --eye 0.1,-0.2,-1 --look 0,0,2 --up 0,-1,0 --fov-x 68.7549354156988 "
           "--size 96x64 --ipd 0.063 --mode " +
           name + " --out " + name);
        bsp_frame_info frame = bsp::frame();
        frame.mode = name == "shared" ? BSP_MODE_SHARED : BSP_MODE_PREDICTED;
        frame.flags = BSP_FRAME_DEPTH;
        CHECK(renderer->render(scene, views, frame).splats_visible > 0);
        const auto file = [&](const std::string& stem) {
            return readPicture(path / name / (stem + BINOSPLAT_FLOAT_EXTENSION));
        };
        const bsp::Picture left = renderer->colour(views[0], 0), depth = renderer->depth(views[0], 0);
        CHECK(left.values == file("left").values);
        CHECK(renderer->colour(views[1], 1).values == file("right").values);
        const Image sums = file("dominant_depth");
        for (std::size_t i = 0; i < depth.values.size(); ++i) {
            REQUIRE(std::abs(depth.values[i] * left.values[4 * i + 3] - sums.values[i]) < 1e-5f);
        }
    }
}

TEST_CASE_FIXTURE(Opened, "twenty threads load, show, cancel and destroy scenes beside each other") {
    struct Shared {
        std::mutex mutex;  // a renderer may be used by one thread at a time
        bsp::Renderer renderer;
    };
    std::array<Shared, 2> renderers{Shared{{}, bsp::Renderer(*device)}, Shared{{}, bsp::Renderer(*device)}};
    std::atomic<int> shown = 0, cancelled = 0, wrong = 0;
    const auto work = [&](int number) {
        for (int round = 0; round < 3; ++round) {
            bsp::Scene scene(*device, (number + round) % 2 == 0 ? "builtin:one-splat" : "builtin:fence");
            if ((number + round) % 3 == 0) { scene.cancel(); }
            try {
                while (!scene.isThere()) { std::this_thread::yield(); }
                const bsp::Views views = scene.startViews(0.063, 1.0, 32, 24);
                Shared& shared = renderers.at(static_cast<std::size_t>(number) % 2);
                const std::lock_guard lock(shared.mutex);
                bsp_frame_info frame = bsp::frame();
                frame.mode = BSP_MODE_SHARED;
                shared.renderer.render(scene, views, frame);
                shown += shared.renderer.colour(views[0], 0).values.size() == 4 * 32 * 24 ? 1 : 0;
                const bsp::Scene gone = std::move(scene);  // while it is shown, but the renderer is idle
            } catch (const bsp::Error& error) { ++(error.code() == BSP_ERROR_CANCELLED ? cancelled : wrong); }
        }
    };
    std::vector<std::thread> threads;
    for (int number = 0; number < 20; ++number) { threads.emplace_back(work, number); }
    for (std::thread& thread : threads) { thread.join(); }
    CHECK(wrong == 0);
    CHECK(shown >= 40);
    CHECK(shown + cancelled == 60);
}

TEST_CASE_FIXTURE(Opened, "three views are a pair and one, and arrays with gaps make their file's scene") {
    const Scene made = makeBuiltin("builtin:atelier", 3000);
    const bsp::Scene of_file = load(made);
    struct Row {
        glm::vec3 position;
        std::array<float, 4> rotation;
        glm::vec2 scales;
        float opacity;
        std::array<float, 48> sh;
    };
    std::vector<Row> rows(made.size());
    const auto width = static_cast<std::size_t>(3 * shCoefficientCount(made.sh_degree));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const glm::quat& q = made.rotations[i];
        rows[i] = {made.positions[i], {q.w, q.x, q.y, q.z}, made.scales[i], made.opacities[i], {}};
        std::copy_n(made.sh.data() + i * width, width, rows[i].sh.data());
    }
    auto splats = bsp::make<bsp_splats>(BSP_TYPE_SPLATS);
    const auto at = [](const float& value) { return bsp_array{&value, sizeof(Row)}; };
    splats.count = rows.size();
    splats.positions = at(rows[0].position.x);
    splats.rotations = at(rows[0].rotation[0]);
    splats.scales = at(rows[0].scales.x);
    splats.opacities = at(rows[0].opacity);
    splats.sh = at(rows[0].sh[0]);
    splats.scale_count = 2;
    splats.sh_degree = static_cast<std::uint32_t>(made.sh_degree);
    splats.activated = 1;
    const bsp::Scene of_arrays(*device, splats);
    of_arrays.wait();
    CHECK(of_arrays.properties().splats == 3000);
    CHECK(of_arrays.properties().core_size == doctest::Approx(of_file.properties().core_size));

    const bsp::Views pair = of_file.startViews(0.063, 1.2, 64, 48);
    std::array<bsp_view, 3> views{pair[0], pair[1], pair[0]};
    views[2].width = 32, views[2].height = 24;
    bsp_frame_info frame = bsp::frame();
    frame.views = views.data();
    frame.view_count = 3;
    frame.mode = BSP_MODE_SHARED;
    std::array<std::vector<float>, 2> seen;
    for (const bool is_file : {false, true}) {
        frame.scene = (is_file ? of_file : of_arrays).get();
        renderer->render(frame);
        for (unsigned v = 0; v < 3; ++v) {
            const bsp::Picture picture = renderer->colour(views[v], v);
            seen[is_file].insert(seen[is_file].end(), picture.values.begin(), picture.values.end());
        }
    }
    // There are a logarithm and its inverse in between.
    CHECK(std::ranges::equal(seen[0], seen[1], [](float a, float b) { return std::abs(a - b) < 1e-3f; }));
    CHECK(std::ranges::max(seen[0]) > 0.5f);
}

TEST_CASE_FIXTURE(Opened, "programs of earlier and later headers run, unless they ask for what is unknown") {
    const bsp::Scene scene = load("builtin:one-splat");
    float red = 0.0f;
    const auto draw = [&](compiled_against header) {
        return draw_as_compiled(renderer->get(), scene.get(), header, &red);
    };
    CHECK(draw(AN_EARLIER_ONE) == BSP_SUCCESS);
    const float first = std::exchange(red, 1.0f);
    CHECK(first > 0.1f);
    CHECK(draw(A_LATER_ONE) == BSP_SUCCESS);
    CHECK(red == first);
    CHECK(draw(A_LATER_ONE_AND_USES_IT) == BSP_ERROR_INPUT);
    CHECK(contains(bsp_error_text(), "a later one is needed"));
}

TEST_CASE_FIXTURE(Opened, "what is wrong is a code and a line of its own thread, and the next call works") {
    const auto refused = [](const std::function<void()>& action, const std::string& part) {
        checkRefusal(action, BSP_ERROR_INPUT, part);
    };
    refused([&] { (void)load("nothing.ply"); }, "nothing.ply");
    std::thread([] { CHECK(std::string(bsp_error_text()).empty()); }).join();
    bsp::Views views = load("builtin:fence").startViews(0.063, 1.2, 64, 48);
    refused([&] { (void)renderer->colour(views[0], 0); }, "nothing is rendered yet");
    {
        const bsp::Scene scene = load("builtin:fence");
        bsp_frame_info frame = bsp::frame();
        refused([&] { renderer->render(frame); }, "there are 0 views");
        frame.budget = 2.0;
        refused([&] { renderer->render(scene, views, frame); }, "budget is 2");
        const bsp::Views unlike{views[0], scene.startViews(0.063, 1.2, 48, 48)[0]};
        refused([&] { renderer->render(scene, unlike); }, "different sizes");
        renderer->render(scene, views);
        refused([&] { (void)renderer->depth(views[0], 0); }, "BSP_FRAME_DEPTH");
        CHECK(renderer->colour(views[0], 0).values.at(3) >= 0.0f);
    }
    // The scene that was shown is gone, and its picture with it.
    refused([&] { (void)renderer->colour(views[0], 0); }, "nothing is rendered yet");
    bsp_frame_info empty = bsp::frame();
    empty.views = views.data();
    empty.view_count = 2;
    empty.background[1] = 0.5;
    renderer->render(empty);
    CHECK(renderer->colour(views[0], 0).values.at(1) == 0.5f);

    bsp::Scene atelier(*device, "builtin:atelier");
    atelier.cancel();
    checkRefusal([&] { atelier.wait(); }, BSP_ERROR_CANCELLED, "cancelled");
    auto none = bsp::make<bsp_splats>(BSP_TYPE_SPLATS);
    none.count = 1;
    none.scale_count = 4;
    refused([&] { bsp::Scene(*device, none); }, "4 scales");
    none.scale_count = 3;
    refused([&] { bsp::Scene(*device, none); }, "positions of splats are null");
}

// The output of a script in tests/, run with Debian's numpy; none if that is not installed, or cannot load a
// library under a sanitizer.
std::optional<std::string> outputOf(const Workplace& work, const std::string& script,
                                    const std::string& arguments) {
    if (BINOSPLAT_TEST_SANITIZED) { return std::nullopt; }
    if (work.runCommand("/usr/bin/python3 -c 'import numpy'").exit_code != 0) {
        CHECK_MESSAGE(std::getenv("CI") == nullptr, "python3-numpy is not installed");
        return std::nullopt;
    }
    const Outcome outcome =
        work.runCommand(fmt::format("PYTHONDONTWRITEBYTECODE=1 PYTHONPATH='{0}/engine/library' "
                                    "BINOSPLAT_LIBRARY='{1}' /usr/bin/python3 '{0}/tests/{2}' {3}",
                                    BINOSPLAT_SOURCE_DIR, BINOSPLAT_LIBRARY_FILE, script, arguments));
    CHECK_MESSAGE(outcome.exit_code == 0, outcome.errors);
    return outcome.output;
}

void checkArrays(const Workplace& work, const fs::path& ply, int frames) {
    const auto output =
        outputOf(work, "engine/library/arrays.py", fmt::format("'{}' {}", ply.string(), frames));
    CHECK(output.value_or("all right\n") == "all right\n");
}
void checkRoom(const Workplace& work, int frames) {
    writePly(makeBuiltin("builtin:atelier", 3000), (work.path / "room.ply").string());
    checkArrays(work, work.path / "room.ply", frames);
}

TEST_CASE_FIXTURE(AtWork, "Python draws arrays as their file, turned cameras, and refuses other shapes") {
    checkRoom(work, 3);
}

TEST_CASE_FIXTURE(AtWork, "a thousand frames from Python take no more memory than twenty" * nightly()) {
    checkRoom(work, 1000);
}

TEST_CASE_FIXTURE(AtWork, "playbot's arrays from Python are its file, to the bit" * needsSharedData()) {
    if (const auto data = sharedData()) { checkArrays(work, *data / "playbot/playbot_lod3_2dgs_sh2.ply", 1); }
}

TEST_CASE_FIXTURE(AtWork, "evaluate.py finds between a photograph and its camera's picture what bytes lose") {
    work.go(
        "render builtin:fence --mode mono --eye 0.1,-0.2,-1 --look 0.1,-0.2,2 --up 0,-1,0 --fov-x 90 "
        "--size 96x64 --out photos");
    work.write("cameras.json",
               R"([{"img_name": "mono.png", "width": 96, "height": 64, "fx": 48, "fy": 48,
                    "position": [0.1, -0.2, -1], "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]]}])");
    fs::remove(work.path / "photos" / ("mono" BINOSPLAT_FLOAT_EXTENSION));
    const auto output = outputOf(work, "../docs/examples/evaluate.py", "builtin:fence cameras.json photos");
    if (!output) { return; }
    REQUIRE(output->ends_with(" dB of 1 test cameras\n"));
    CHECK(std::atof(output->substr(output->find("mean ") + 5).c_str()) > 50.0);
}

}  // SUITE(library)
