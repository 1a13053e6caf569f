// Facts about the program as its user meets it: exit codes, one line per error, and nothing left behind.
#include "engine/picture/join.h"
#include "tests/app/program_script.h"

SUITE(cli) {

const fs::path kSource = BINOSPLAT_SOURCE_DIR;

SCRIPT(cli, "app/cli") { runProgramScript(); }

TEST_CASE_FIXTURE(AtWork, "render writes its files and nothing else") {
    const std::string float_extension = extensionOf(PictureKind::kFloat),
                      display_extension = extensionOf(PictureKind::kDisplay);
    for (const std::string mode : {"mono", "two-pass", "shared", "reproject", "paper", "predicted"}) {
        const std::string command =
            fmt::format("render builtin:one-splat --size 40x24 --out a/{0} --mode {0}", mode);
        CHECK(work.go(command, "BINOSPLAT_VALIDATION=1").errors.empty());
        const fs::path folder = work.path / "a" / mode;
        using Names = std::vector<std::string>;
        for (const std::string& name : mode == "mono" ? Names{"mono"} : Names{"left", "right"}) {
            const Image picture = readPicture(folder / (name + float_extension)),
                        display = readPicture(folder / (name + display_extension));
            CHECK(these(picture.size_px, display.channels) == these(glm::uvec2(40, 24), 3));
            // The middle of the disc, opacity 0.8 and colour (0.9, 0.6, 0.3), or beside it.
            for (const Image& seen : {picture, display}) {
                CHECK(seen.values[(12 * 40 + 20) * static_cast<std::size_t>(seen.channels)] ==
                      doctest::Approx(0.72).epsilon(0.05));
            }
        }
        CHECK(fs::exists(folder / ("roi" + display_extension)) == (mode != "mono"));
        const Image depth = readPicture(folder / ("dominant_depth" + float_extension));
        CHECK(these(depth.channels, depth.size_px) == these(1, glm::uvec2(40, 24)));
        const auto report = nlohmann::json::parse(textIn(folder / "report.json"));
        for (const char* key :
             {"device", "options", "gpu_ms", "gpu_total_ms", "counters", "peak_gpu_bytes", "left_out"}) {
            CHECK(report.contains(key));
        }
        CHECK(these(report["options"]["mode"], report["options"]["size"], report["options"]["gap-px"]) ==
              these(mode, "40x24", 2));
        CHECK(report["counters"].contains("tiles_patched") ==
              (mode == "reproject" || mode == "paper" || mode == "predicted"));
        CHECK(report["gpu_ms"].size() >= 7);
        if (mode == "reproject") { CHECK(report["counters"]["tiles_patched"] == 0); }
        for (const std::string& name : work.files()) { CHECK_FALSE(contains(name, "/.")); }
    }
    const auto eye = [&](const char* name) {
        return readPicture(work.path / "a" / "shared" / (name + display_extension));
    };
    for (const std::string layout : {"sbs", "tb"}) {
        work.go("render builtin:one-splat --size 40x24 --mode shared --out both --layout " + layout);
        const Image both = readPicture(work.path / "both" / ("stereo" + display_extension));
        CHECK(both.size_px == (layout == "sbs" ? glm::uvec2(80, 24) : glm::uvec2(40, 48)));
        CHECK(both.values ==
              (layout == "sbs" ? besideOneAnother : aboveOneAnother)(eye("left"), eye("right")).values);
    }
    CHECK_FALSE(fs::exists(work.path / "both" / ("left" + display_extension)));
}

TEST_CASE_FIXTURE(AtWork, "every kernel, in each variant of every shader, is built and listed" * nightly()) {
    work.go("kernels --out k");
    const auto listed = nlohmann::json::parse(work.bytesOf("k/kernels.json"));
    CHECK_FALSE(listed.at("device").get<std::string>().empty());
    std::set<std::string> shaders, files;
    std::set<std::pair<std::string, std::string>> variants;
    for (const auto& kernel : listed.at("kernels")) {
        shaders.insert(kernel.at("shader").get<std::string>());
        variants.emplace(kernel.at("shader").get<std::string>(), kernel.at("constants").dump());
        CHECK(kernel.at("statistics").is_object());
    }
    CHECK(variants.size() == listed.at("kernels").size());
    for (const auto& entry : fs::recursive_directory_iterator(kSource / "shaders")) {
        if (entry.path().extension() == ".comp") { files.insert(entry.path().stem().string()); }
    }
    CHECK(shaders == files);
}

}  // SUITE(cli)
