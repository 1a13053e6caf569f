// Facts about LPIPS and the network below it.
#include "engine/picture/lpips.h"
#include "engine/error.h"
#include "engine/picture/image_io.h"
#include "tests/engine/picture/lpips_twin.h"
#include "tests/engine/picture/lpips_weights.h"
#include "tests/engine/picture/pictures.h"
#include "tests/shared_data.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <limits>
#include <optional>
#include <string>

TEST_SUITE_BEGIN("lpips");

namespace lpips_test {

namespace fs = std::filesystem;
using namespace binosplat;
using namespace binosplat::test;

namespace {

// A file of weights that is removed with the test.
struct WeightsFile {
    fs::path path = fs::temp_directory_path() / ("binosplat-lpips-" + std::to_string(getpid()) + ".bin");
    explicit WeightsFile(const std::vector<float>& values) { writeFloats(path, values); }
    WeightsFile(const WeightsFile&) = delete;
    WeightsFile& operator=(const WeightsFile&) = delete;
    ~WeightsFile() { fs::remove(path); }
};

std::optional<fs::path> trainedWeights() {
    const std::optional<fs::path> data = sharedData();
    if (!data) { return std::nullopt; }
    if (!fs::exists(*data / "lpips")) {
        MESSAGE("skipped: no weights at " << (*data / "lpips").string());
        return std::nullopt;
    }
    return *data / "lpips" / "squeeze_v0.1.bin";
}

Image toImage(const FeaturePlanes& planes) {
    Image image{{planes.width, planes.height}, planes.channels, {}};
    for (int y = 0; y < planes.height; ++y) {
        for (int x = 0; x < planes.width; ++x) {
            for (int channel = 0; channel < planes.channels; ++channel) {
                image.values.push_back(static_cast<float>(planes.at(channel, x, y)));
            }
        }
    }
    return image;
}

// The largest difference, as a share of the largest feature; infinite where sizes differ or no feature is above 0.
double differenceOf(const Image& features, const FeaturePlanes& twin) {
    const Image expected = toImage(twin);
    if (features.size_px != expected.size_px || features.channels != expected.channels) { return std::numeric_limits<double>::infinity(); }
    double largest = 0.0, difference = 0.0;
    for (std::size_t i = 0; i < expected.values.size(); ++i) {
        largest = std::max(largest, static_cast<double>(expected.values[i]));
        difference = std::max(difference, std::abs(static_cast<double>(features.values[i]) - static_cast<double>(expected.values[i])));
    }
    return largest > 0.0 ? difference / largest : std::numeric_limits<double>::infinity();
}

// Each stage from the twin's features before it, so that a failure names one stage; then the distance of the whole.
void checkAgainstTwin(const fs::path& file, const Image& a, const Image& b) {
    const Lpips lpips(file);
    const std::vector<float> values = readFloats(file);
    REQUIRE(values.size() == kNetworkWeights + kHeadWeights);
    const std::vector<FeaturePlanes> twin_a = featuresTwin(a, std::span(values).first(kNetworkWeights));
    const std::vector<FeaturePlanes> twin_b = featuresTwin(b, std::span(values).first(kNetworkWeights));
    REQUIRE(twin_a.size() == SqueezeNet::kStageChannels.size());
    for (std::size_t stage = 0; stage < twin_a.size(); ++stage) {
        INFO("stage " << stage << " of " << a.size_px.x << "x" << a.size_px.y);
        const Image before = stage == 0 ? scaleForNetwork(a) : toImage(twin_a[stage - 1]);
        CHECK(differenceOf(lpips.network().runStage(stage, before, 2), twin_a[stage]) < 5e-6);
    }
    const double expected = lpipsTwin(twin_a, twin_b, std::span(values).subspan(kNetworkWeights));
    CHECK(expected > 0.01);
    CHECK(lpips.measure(a, b) == doctest::Approx(expected).epsilon(2e-5));
}

std::string errorOf(const fs::path& file) {
    try {
        const Lpips lpips(file);
    } catch (const Error& error) { return error.what(); }
    return "";
}

// What is refused after `change` to good weights.
template <typename Change>
void checkRefused(const Change& change, const std::string& message) {
    std::vector<float> values = makeLpipsWeights(1);
    change(values);
    const WeightsFile file(values);
    CHECK(errorOf(file.path) == file.path.string() + ": " + message);
}

}  // namespace

TEST_CASE("everyStageIsItsTwinsForRandomWeights") {
    const WeightsFile file(makeLpipsWeights(2));
    checkAgainstTwin(file.path, makeWaves({45, 38}, 0.0), makeWaves({45, 38}, 1.3));
}

TEST_CASE("everyStageIsItsTwinsForTrainedWeights" * needsSharedData()) {
    const auto file = trainedWeights();
    if (!file) { return; }
    checkAgainstTwin(*file, makeWaves({52, 41}, 0.0), makeWaves({52, 41}, 1.3));
}

TEST_CASE("everySizeAcrossTheBoundariesOfPoolingIsItsTwins") {
    // From the least side on every remainder of 16, whose halves are odd and even at each pooling.
    const WeightsFile file(makeLpipsWeights(3));
    const Lpips lpips(file.path);
    const std::vector<float> values = readFloats(file.path);
    for (std::uint32_t side = 17; side <= 34; ++side) {
        const glm::uvec2 size_px{side, 51 - side};
        const Image picture = makeWaves(size_px, 0.3);
        const std::vector<FeaturePlanes> twin = featuresTwin(picture, std::span(values).first(kNetworkWeights));
        Image features = scaleForNetwork(picture);
        for (std::size_t stage = 0; stage < twin.size(); ++stage) {
            INFO("stage " << stage << " of " << size_px.x << "x" << size_px.y);
            features = lpips.network().runStage(stage, std::move(features), 2);
            CHECK(differenceOf(features, twin[stage]) < 2e-5);
        }
    }
}

TEST_CASE("equalPicturesAreAtDistanceZeroAndOthersAreNot") {
    const WeightsFile file(makeLpipsWeights(4));
    const Lpips lpips(file.path);
    const Image a = makeWaves({40, 33}, 0.0), b = makeWaves({40, 33}, 1.0);
    CHECK(lpips.measure(a, a) == 0.0);
    CHECK(lpips.measure(a, b) > 1e-3);
    CHECK(lpips.measure(a, b) == lpips.measure(b, a));
    CHECK(lpips.measure(a, b, 1) == lpips.measure(a, b, 3));
}

TEST_CASE("valuesAreClampedAndFurtherChannelsIgnored") {
    const WeightsFile file(makeLpipsWeights(5));
    const Lpips lpips(file.path);
    const Image white = makeFlat({17, 17}, glm::vec3(1.0f)), waves = makeWaves({17, 17}, 0.0);
    CHECK(lpips.measure(makeFlat({17, 17}, glm::vec3(7.0f), 4), white) == 0.0);
    CHECK(lpips.measure(makeFlat({17, 17}, glm::vec3(7.0f), 4), waves) == lpips.measure(white, waves));
    CHECK(lpips.measure(makeFlat({17, 17}, glm::vec3(-1.0f)), makeFlat({17, 17}, glm::vec3(0.0f), 4)) == 0.0);
}

TEST_CASE("aValueThatIsNotFiniteIsInfinitelyFar") {
    const WeightsFile file(makeLpipsWeights(5));
    const Lpips lpips(file.path);
    const Image a = makeFlat({20, 20}, glm::vec3(0.5f));
    Image b = a;
    setPixel(b, 19, 19, {0.5f, 0.5f, std::numeric_limits<float>::quiet_NaN()});
    CHECK(lpips.measure(a, b) == std::numeric_limits<double>::infinity());
    CHECK(lpips.measure(b, b) == std::numeric_limits<double>::infinity());
}

TEST_CASE("picturesThatCannotBeComparedAreRefused") {
    const WeightsFile file(makeLpipsWeights(5));
    const Lpips lpips(file.path);
    const auto measure = [&](glm::uvec2 size_a, glm::uvec2 size_b, int channels = 3) {
        return lpips.measure(makeFlat(size_a, glm::vec3(0.5f)), makeFlat(size_b, glm::vec3(0.4f), channels));
    };
    CHECK(measure({17, 17}, {17, 17}) > 0.0);
    CHECK_THROWS_WITH_AS(measure({16, 40}, {16, 40}), "LPIPS: pictures have 16x40 pixels, must have at least 17 a side", Error);
    CHECK_THROWS_WITH_AS(measure({40, 16}, {40, 16}), "LPIPS: pictures have 40x16 pixels, must have at least 17 a side", Error);
    CHECK_THROWS_WITH_AS(measure({20, 20}, {20, 21}), "cannot compare a picture of 20x20 pixels with one of 20x21", Error);
    const Image grey{{20, 20}, 1, std::vector<float>(400, 0.5f)};
    CHECK_THROWS_AS(static_cast<void>(lpips.measure(grey, grey)), Error);
    CHECK_THROWS_AS(static_cast<void>(lpips.measure(Image{}, Image{})), Error);
}

TEST_CASE("brokenWeightsAreRefusedInOneLine") {
    CHECK(errorOf("/nonexistent/w.bin") ==
          "/nonexistent/w.bin: cannot be read (No such file or directory), must be the weights of LPIPS (SqueezeNet variant, version 0.1)");
    CHECK(errorOf("/tmp") == "/tmp: cannot be read (Is a directory), must be the weights of LPIPS (SqueezeNet variant, version 0.1)");
    const std::string expected = " bytes, must have the 2898944 of the weights of LPIPS (SqueezeNet variant, version 0.1)";
    checkRefused([](std::vector<float>& values) { values.clear(); }, "has 0" + expected);
    checkRefused([](std::vector<float>& values) { values.pop_back(); }, "has 2898940" + expected);
    checkRefused([](std::vector<float>& values) { values.push_back(0.0f); }, "has 2898948" + expected);
    checkRefused([](std::vector<float>& values) { values[700] = std::numeric_limits<float>::quiet_NaN(); },
                 "value 700 is nan, must be finite");
    checkRefused([](std::vector<float>& values) { values.back() = std::numeric_limits<float>::infinity(); },
                 "value 724735 is inf, must be finite");
    checkRefused([](std::vector<float>& values) { values[kNetworkWeights] = -0.5f; },
                 "value 722496 is -0.5, must not be negative, as it belongs to a head");
}

TEST_CASE("weightsThatOverflowAreRefused") {
    const WeightsFile file(std::vector<float>(kNetworkWeights + kHeadWeights, 1e30f));
    const Lpips lpips(file.path);
    CHECK_THROWS_AS(static_cast<void>(lpips.measure(makeWaves({17, 17}, 0.0), makeWaves({17, 17}, 1.0))), Error);
}

#ifdef BINOSPLAT_HAS_PNG
TEST_CASE("teddysViewsAreAsFarApartAsAnotherProgramSays" * needsSharedData()) {
    const auto data = sharedData(), file = trainedWeights();
    if (!file) { return; }
    const Image left = readPicture(*data / "middlebury/teddy/im2.png"), right = readPicture(*data / "middlebury/teddy/im6.png");
    const Lpips lpips(*file);
    CHECK(std::abs(lpips.measure(left, right) - 0.375548) < 2e-6);
    CHECK(lpips.measure(left, left) == 0.0);
}
#endif

}  // namespace lpips_test
