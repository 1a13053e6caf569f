// `binosplat compare`, run as a program. Pictures are PFM and PPM, which every build can read.
#include "engine/picture/netpbm.h"
#include "tests/app/program_script.h"
#include "tests/app/scores/lpips_weights.h"
#include "tests/engine/picture/pictures.h"

SUITE(compare) {

// Pictures of waves, also of other sizes, with one channel and with NaN, two paths, and weights for LPIPS.
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
        // One path has a frame that is off by 0.2: the changes are 0.3 and -0.1 instead of 0.1 twice.
        for (const auto& [folder, greys] : {std::pair("still", std::array{0.5f, 0.6f, 0.7f}),
                                            std::pair("flickers", std::array{0.5f, 0.8f, 0.7f})}) {
            fs::create_directory(path / folder);
            for (std::size_t frame = 0; frame < 3; ++frame) {
                for (const char* eye : {"left", "right"}) {
                    writePfm(path / folder / fmt::format("frame_00000{}_{}.pfm", frame, eye),
                             makeGrey({20, 20}, 3, greys[frame]));
                }
            }
        }
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

}  // SUITE(compare)
