// Frames of a moving scene, read ahead in the order in which they will be needed, within a limit of memory.
#include "engine/stream/series_loader.h"

#include "tests/engine/stream/moving_frames.h"

SUITE(series_loader) {

constexpr std::size_t kScenes = 12;

Scene shifted(std::size_t scene) {
    Scene made = makeBuiltin("builtin:slanted-wall");
    for (glm::vec3& p : made.positions) { p.x += 0.1f * static_cast<float>(scene); }
    return made;
}

std::vector<std::size_t> from(std::size_t first) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < kScenes; ++i) { order.push_back((first + i) % kScenes); }
    return order;
}

template <typename Is>
void waitUntil(const Is& is) {
    while (!is()) { std::this_thread::yield(); }
}

void want(SeriesLoader& loader, const std::vector<std::size_t>& scenes) {
    waitUntil([&] { return loader.tryWant(scenes); });
}

struct Film {
    const SceneTraits traits = traitsOf(shifted(0));
    const std::uint64_t bytes = bytesIn(makeSceneFrame(shifted(0), traits));
    std::mutex mutex;
    std::vector<std::size_t> read;  // which scenes, in this order
    const std::function<Scene(std::size_t)> reader = [&](std::size_t scene) {
        const std::lock_guard lock(mutex);
        read.push_back(scene);
        return shifted(scene);
    };

    [[nodiscard]] bool shows(const SeriesLoader::Held& held, std::size_t scene) const {
        return std::ranges::equal(held->splats.front().bytes(),
                                  makeSceneFrame(shifted(scene), traits).front().bytes());
    }
};

// Until the next frames are there.
void readFrom(SeriesLoader& loader, std::size_t first, std::size_t count) {
    want(loader, from(first));
    for (std::size_t i = 0; i < count; ++i) {
        waitUntil([&] { return loader.tryGet((first + i) % kScenes) != nullptr; });
    }
}

TEST_CASE_FIXTURE(Film, "with room for all every frame is read once, in order, and stays") {
    SeriesLoader loader(reader, kScenes, traits, {});
    readFrom(loader, 4, kScenes);
    for (std::size_t scene = 0; scene < kScenes; ++scene) { CHECK(shows(loader.get(scene), scene)); }
    want(loader, from(7));
    CHECK(loader.get(6) == loader.tryGet(6));
    const std::lock_guard lock(mutex);
    CHECK(read == from(4));
    CHECK(loader.takeLines(Waits::kBriefly).empty());
}

TEST_CASE_FIXTURE(Film, "a frame that cannot be read is told once, whatever it is, and the others come") {
    SeriesLoader loader(
        [&](std::size_t scene) {
            if (scene == 1) { fail("the first trouble"); }
            if (scene == 2) { throw std::bad_alloc(); }
            if (scene == 3) { throw std::length_error("the third trouble"); }
            return shifted(scene);
        },
        kScenes, traits, {});
    want(loader, from(0));
    for (std::size_t scene = 1; scene < 4; ++scene) {
        waitUntil([&] { return loader.isSurelyBroken(scene); });
    }
    CHECK(loader.get(11) != nullptr);
    CHECK(loader.takeLines(Waits::kBriefly) ==
          std::vector<std::string>{"the first trouble",
                                   "a frame of the moving scene does not fit into memory",
                                   "the third trouble"});
    CHECK(loader.takeLines(Waits::kBriefly).empty());
    CHECK_THROWS_WITH_AS((void)loader.get(3), "the third trouble", Error);
}

TEST_CASE_FIXTURE(Film, "within a limit the next ones are there, and what is needed last makes room") {
    SeriesLoader loader(reader, kScenes, traits, {.most_bytes = 5 * bytes, .threads = 2});
    for (const std::size_t first : {0u, 1u, 2u, 9u, 3u}) {
        readFrom(loader, first, 4);
        CHECK(loader.bytesKept() <= 5 * bytes);
    }
    {
        const std::lock_guard lock(mutex);
        CHECK(read.size() < 24);
    }
    // A limit too small for anything: the next ones are read all the same.
    SeriesLoader small(shifted, kScenes, traits, {.most_bytes = 1, .threads = 1});
    want(small, from(0));
    for (std::size_t scene = 0; scene < kScenes; ++scene) {
        readFrom(small, scene, 1);
        CHECK(small.bytesKept() <= SeriesLoader::kLeastKept * bytes);
    }
}

TEST_CASE_FIXTURE(Film, "a frame stays as long as it is held, whatever else is needed, and then makes room") {
    SeriesLoader loader(reader, kScenes, traits, {.most_bytes = 1, .threads = 1});
    const auto readOthers = [&] {
        for (const std::size_t first : {4u, 8u}) { readFrom(loader, first, SeriesLoader::kLeastKept); }
    };
    const auto countReads = [&] {
        const std::lock_guard lock(mutex);
        return std::ranges::count(read, 0u);
    };
    SeriesLoader::Held held = loader.get(0);
    readOthers();
    CHECK(loader.get(0) == held);
    CHECK(shows(held, 0));
    CHECK(countReads() == 1);
    held.reset();
    readOthers();
    CHECK(loader.bytesKept() <= SeriesLoader::kLeastKept * bytes);
    CHECK(loader.get(0) != nullptr);
    CHECK(countReads() == 2);
}

}  // SUITE(series_loader)
