// `binosplat compare`, run as a program. Pictures are PFM and PPM, which every build can read.
#include "engine/picture/netpbm.h"
#include "tests/app/program_script.h"
#include "tests/app/scores/lpips_weights.h"
#include "tests/engine/picture/pictures.h"

SUITE(compare) {

// Two pictures of waves, one with a value that is not a number, one of another size, one with a single
// channel, and weights for LPIPS.
struct Pictures : Workplace {
    Pictures() {
        writePfm(path / "a.pfm", makeWaves({40, 30}, 0.0));
        writePfm(path / "b.pfm", makeWaves({40, 30}, 0.7));
        writePfm(path / "wide.pfm", makeWaves({41, 30}, 0.0));
        writePfm(path / "small.pfm", makeWaves({40, 16}, 0.0));
        writePfm(path / "grey.pfm", {{40, 30}, 1, std::vector<float>(40 * 30, 0.5f)});
        Image broken = makeWaves({40, 30}, 0.0);
        broken.values[5] = std::numeric_limits<float>::quiet_NaN();
        writePfm(path / "nan.pfm", broken);
        writePnm(path / "a.ppm", makeFlat({20, 20}, glm::vec3(0.2f, 0.4f, 0.6f)));
        writePfm(path / "a_as_floats.pfm", readPnm(path / "a.ppm"));
        writeFloats(path / "w.bin", makeLpipsWeights(7));
    }

    // In the order of the output.
    [[nodiscard]] std::vector<std::pair<std::string, double>> scores(const std::string& arguments) const {
        const Outcome outcome = go("compare " + arguments);
        CHECK(outcome.errors.empty());
        std::vector<std::pair<std::string, double>> lines;
        for (const std::string& line : linesIn(outcome.output)) {
            const std::size_t space = line.find(' ');
            lines.emplace_back(line.substr(0, space), std::stod(line.substr(space)));
        }
        return lines;
    }
};

TEST_CASE_FIXTURE(Pictures, "each score is a line with its name, and FLIP sees less from afar") {
    const auto three = scores("a.pfm b.pfm"), four = scores("a.pfm b.pfm --lpips w.bin");
    REQUIRE(three.size() == 3);
    REQUIRE(four.size() == 4);
    CHECK(std::equal(three.begin(), three.end(), four.begin()));
    const std::vector<std::tuple<std::string, double, double>> expected{
        {"psnr", 10.0, 40.0}, {"ssim", -1.0, 0.99}, {"flip", 0.01, 1.0}, {"lpips", 0.01, 1e9}};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto& [name, least, most] = expected[i];
        CHECK(these(four[i].first, four[i].second) == these(name, between(least, most)));
    }
    CHECK(scores("a.pfm b.pfm --pixels-per-degree 67.0206") == three);
    CHECK(scores("a.pfm b.pfm --pixels-per-degree 500").at(2).second < 0.8 * three[2].second);
}

SCRIPT(compare, "app/compare") {
    const Pictures pictures;
    runScript(programIn(pictures));
}

TEST_CASE("of two paths come the mean, the worst frame, and how much more one changes than the other") {
    const Pictures pictures;
    for (const char* folder : {"still", "flickers", "empty", "short"}) {
        fs::create_directory(pictures.path / folder);
    }
    const auto write = [&](const std::string& name, float grey) {
        writePfm(pictures.path / (name + ".pfm"), makeFlat({20, 20}, glm::vec3(grey)));
    };
    for (const char* eye : {"left", "right"}) {
        for (int frame = 0; frame < 3; ++frame) {
            const std::string name = fmt::format("/frame_00000{}_{}", frame, eye);
            write("still" + name, 0.5f + 0.1f * static_cast<float>(frame));
            write("flickers" + name, frame == 1 ? 0.8f : 0.5f + 0.1f * static_cast<float>(frame));
        }
    }
    // One frame of three is off by 0.2, so the changes are 0.3 and -0.1 instead of 0.1 twice.
    const auto scores = pictures.scores("flickers still");
    REQUIRE(scores.size() == 4);
    CHECK(scores[0] == std::pair(std::string("pictures"), 6.0));
    CHECK(scores[1].second == doctest::Approx(-10.0 * std::log10(0.04 / 3.0)));
    CHECK(scores[2].second == doctest::Approx(-10.0 * std::log10(0.04)));
    CHECK(scores[3].second == doctest::Approx(std::sqrt(5.0)));
    CHECK(pictures.go("compare still still").output ==
          "pictures 6\npsnr inf\npsnr_least inf\nchange 1.000000\n");
    write("short/frame_000000_left", 0.5f);
    pictures.checkRefused("compare still short", 1, "short/frame_000001_left.pfm: cannot be read");
    pictures.checkRefused("compare empty still", 1, "empty: has no frames of a path");
}

}  // SUITE(compare)
