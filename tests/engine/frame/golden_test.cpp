// Pictures that must not change, in golden/: the twin's of a few scenes, and the last pair of a walk.
#include "engine/picture/image_io.h"
#include "engine/stream/moving_scene.h"
#include "tests/engine/files/ply_files.h"
#include "tests/engine/frame/frame_runs.h"
#include "tests/engine/stream/moving_frames.h"

SUITE(golden) {

#ifdef BINOSPLAT_HAS_PNG

constexpr double kLeastDb = 50.0;  // 8 bits alone leave 59
// For a walk: a tile whose price differs slightly in float32 is rendered a frame earlier or later.
constexpr double kLeastWalkDb = 45.0;

// Reads the file; with BINOSPLAT_WRITE_GOLDENS=1, it is written first.
Image readGolden(const std::string& name, const Image& made) {
    const std::string stem = BINOSPLAT_SOURCE_DIR "/tests/golden/" + name;
    const char* write = std::getenv("BINOSPLAT_WRITE_GOLDENS");
    if (write != nullptr && std::string(write) == "1") { writePicture(stem, PictureKind::kDisplay, made); }
    return readPicture(stem + ".png");
}

// Longer walks diverge: if float32 prices one of the 70 tiles differently, the pictures differ from then on.
constexpr int kFrames = 6;
constexpr double kBudget = 0.2;

// A head that moves by 3 mm per frame, sways and looks around.
std::array<Eye, 2> eyesAt(const Eye& start, int frame) {
    Eye eye = turned(start, 0.003 * frame);
    const glm::dvec3 step(0.003 * frame, 0.004 * std::sin(0.5 * frame), 0.001 * frame);
    eye.world_from_camera.position += start.world_from_camera.orientation * step;
    eye.world_from_camera.orientation =
        eye.world_from_camera.orientation * glm::angleAxis(0.01 * std::sin(0.3 * frame), glm::dvec3(1, 0, 0));
    return stereoPair(eye, 0.063);
}

// Left and right side by side.
Image besideEachOther(const std::array<Image, 2>& pair) {
    const auto [width, height] = std::pair(pair[0].size_px.x, pair[0].size_px.y);
    Image both{{2 * width, height}, 4, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (const Image& image : pair) {
            const float* row = &image.values[std::size_t{4} * width * y];
            both.values.insert(both.values.end(), row, row + std::size_t{4} * width);
        }
    }
    return both;
}

TEST_CASE("the golden pictures are what the twin renders") {
    for (const auto& [name, splats] : {std::pair("fence", 0u), std::pair("atelier", 20000u)}) {
        const ViewedScene view = viewBuiltin("builtin:" + std::string(name), {192, 192}, splats);
        const Image twin = toImage(reference::render(view.scene, view.eye, {}));
        CAPTURE(name);
        CHECK(compare(readGolden(name, twin), twin).psnrDb() >= kLeastDb);
    }
}

// history_passes_test.cpp and others compare each pass with its twin; the file holds what all the twins made
// together.
TEST_CASE_FIXTURE(Gpu, "the last pair of a walk past a scene that moves is what it was") {
    const Folder folder;
    // The sliding objects move on by 8 cm every second frame.
    writeFilm(folder.file("film"), kFrames / 2 + 1, [](int at) { return shakenAtelier(4 * at, 1000); });
    MovingScene moving(context(), SceneSeries(folder.file("film")), {.rate_hz = 45.0, .memory_bytes = 1});
    KeptFrame frame(context(), moving.scene());
    FrameSettings settings = makeSettings(Mode::kTemporal);
    settings.stereo.budget = kBudget;
    View view = *builtinView("atelier");
    view.fov_x_deg = 50.0;  // the sliding objects change a third of the tiles
    const Eye start = eyeOf(view, {112, 80});
    for (int i = 0; i <= kFrames; ++i) {
        moving.setTime(i / 90.0);
        moving.settle({});
        frame.render(eyesAt(start, i), settings);
    }
    const Image device = besideEachOther(picturesOf(frame));
    CHECK(compare(readGolden("walk", device), device).psnrDb() >= kLeastWalkDb);
}

#endif

}  // SUITE(golden)
