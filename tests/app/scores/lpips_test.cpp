// Facts about LPIPS and its network.
#include "app/scores/lpips.h"
#include "engine/picture/image_io.h"
#include "tests/app/scores/lpips_weights.h"
#include "tests/engine/picture/pictures.h"
#include "tests/run_program.h"
#include "tests/shared_data.h"

SUITE(lpips) {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(),
                kInfinity = std::numeric_limits<float>::infinity();

struct Weights : Workplace {
    const fs::path file = path / "w.bin";
    explicit Weights(const std::vector<float>& values) { writeFloats(file, values); }
};

const Lpips& randomLpips() {
    static const Lpips lpips(Weights(makeLpipsWeights(2)).file);
    return lpips;
}

TEST_CASE("the distance is that of the network's description, across the boundaries of pooling") {
    // Computed in float64 with a loop for every index. Pooling halves odd sides as well as even ones. float32
    // differs by 2e-7; one channel of the last stage that is 0.1 % too large changes the result by 1.5e-6.
    struct {
        glm::uvec2 size_px;
        double distance;
    } const known[]{{{48, 34}, 0.189837957}, {{17, 34}, 0.213502645}, {{20, 31}, 0.213926525},
                    {{22, 29}, 0.237426691}, {{24, 27}, 0.232820551}, {{26, 25}, 0.231021133},
                    {{34, 17}, 0.221909798}};
    for (const auto& one : known) {
        CHECK(randomLpips().measure(makeWaves(one.size_px, 0.0), makeWaves(one.size_px, 1.3)) ==
              doctest::Approx(one.distance).epsilon(1e-6));
    }
}

TEST_CASE("what a display shows alike is at distance zero, and a value that is not finite infinitely far") {
    const Lpips& lpips = randomLpips();
    const Image a = makeWaves({40, 33}, 0.0), b = makeWaves({40, 33}, 1.0);
    CHECK(lpips.measure(a, a) == 0.0);
    CHECK(these(lpips.measure(a, b), lpips.measure(a, b, 1)) ==
          these(lpips.measure(b, a), lpips.measure(a, b, 3)));
    const Image white = makeFlat({17, 17}, glm::vec3(1.0f)),
                brighter = makeFlat({17, 17}, glm::vec3(7.0f), 4);
    Image waves = makeWaves({17, 17}, 0.0);
    CHECK(these(lpips.measure(brighter, white), lpips.measure(brighter, waves)) ==
          these(0.0, lpips.measure(white, waves)));
    CHECK(lpips.measure(makeFlat({17, 17}, glm::vec3(-1.0f)), makeFlat({17, 17}, glm::vec3(0.0f), 4)) == 0.0);
    setPixel(waves, 16, 16, {0.5f, 0.5f, kNan});
    CHECK(lpips.measure(white, waves) == std::numeric_limits<double>::infinity());
    CHECK(lpips.measure(waves, waves) == std::numeric_limits<double>::infinity());
    for (const auto& [size_px, other_px, channels, why] :
         {std::tuple(glm::uvec2(16, 40), glm::uvec2(16, 40), 3, "must have at least 17"),
          std::tuple(glm::uvec2(20, 20), glm::uvec2(20, 21), 3, "20x20 pixels with one of 20x21"),
          std::tuple(glm::uvec2(20, 20), glm::uvec2(20, 20), 1, "channel")}) {
        const Image one = makeGrey(size_px, channels, 0.5f), other = makeGrey(other_px, channels, 0.5f);
        CHECK_MESSAGE(contains(errorOf([&] { (void)lpips.measure(one, other); }), why), why);
    }
}

TEST_CASE("broken weights are refused in one line, and so are those that overflow") {
    const auto errorOf = [](const fs::path& file) { return test::errorOf([&] { const Lpips lpips(file); }); };
    const std::string kind = "the weights of LPIPS (SqueezeNet variant, version 0.1)";
    CHECK(errorOf("/nonexistent/w.bin") ==
          "/nonexistent/w.bin: cannot be read (No such file or directory), must be " + kind);
    CHECK(errorOf("/tmp") == "/tmp: cannot be read (Is a directory), must be " + kind);
    const std::string expected = " bytes, must have the 2898944 of " + kind;
    const std::pair<void (*)(std::vector<float>&), std::string> changes[]{
        {[](std::vector<float>& values) { values.clear(); }, "has 0" + expected},
        {[](std::vector<float>& values) { values.pop_back(); }, "has 2898940" + expected},
        {[](std::vector<float>& values) { values.push_back(0.0f); }, "has 2898948" + expected},
        {[](std::vector<float>& values) { values[700] = kNan; }, "value 700 is nan, must be finite"},
        {[](std::vector<float>& values) { values.back() = kInfinity; },
         "value 724735 is inf, must be finite"},
        {[](std::vector<float>& values) { values[kNetworkWeights] = -0.5f; },
         "value 722496 is -0.5, must not be negative, as it belongs to a head"}};
    const std::vector<float> good = makeLpipsWeights(2);
    for (const auto& [change, message] : changes) {
        std::vector<float> values = good;
        change(values);
        const Weights weights(values);
        CHECK(errorOf(weights.file) == weights.file.string() + ": " + message);
    }
    const Weights weights(std::vector<float>(kNetworkWeights + kHeadWeights, 1e30f));
    CHECK_THROWS_AS((void)Lpips(weights.file).measure(makeWaves({17, 17}, 0.0), makeWaves({17, 17}, 1.0)),
                    Error);
}

#ifdef BINOSPLAT_HAS_PNG
TEST_CASE("the views of teddy are as far apart as another program says" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const fs::path weights = *data / "lpips" / "squeeze_v0.1.bin";
    if (!fs::exists(weights)) {
        MESSAGE("skipped: no " << weights.string());
        return;
    }
    const Image left = readPicture(*data / "middlebury/teddy/im2.png"),
                right = readPicture(*data / "middlebury/teddy/im6.png");
    const Lpips lpips(weights);
    CHECK(std::abs(lpips.measure(left, right) - 0.375548) < 2e-6);
    CHECK(lpips.measure(left, left) == 0.0);
}
#endif

}  // SUITE(lpips)
