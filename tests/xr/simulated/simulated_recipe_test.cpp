// docs/test_your_openxr_program.md as a newcomer follows it: the folder of the simulated runtime is built
// alone and installed, the page's script runs a program that was not written for it, and its frame log is
// read and compared; see simulated_recipe_test.txt.
#include "tests/script.h"
#include "tests/xr/simulated/installed.h"
#include "xr/simulated/compose/picture_file.h"

SUITE(simulated_recipe) {

// The same place each time, so that a compiler cache recognizes it.
const fs::path kWork = fs::path(BINOSPLAT_OUTPUT_DIR) / "simulated_alone";

// Builds and installs a copy of the folder, once for all cases. Each target is built from one file that reads
// the headers once: half the work.
bool install() {
    for (const char* before : {"source", "installed"}) { fs::remove_all(kWork / before); }
    fs::create_directories(kWork);
    fs::copy(BINOSPLAT_SOURCE_DIR "/xr/simulated", kWork / "source", fs::copy_options::recursive);
    const std::string command =
        "cd " + kWork.string() +
        " && ( launcher=$(command -v ccache); cmake -S source -B build -G Ninja -DCMAKE_BUILD_TYPE=Debug "
        "-DCMAKE_CXX_FLAGS_DEBUG=-g0 -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0 "
        "-DCMAKE_CXX_COMPILER_LAUNCHER=$launcher && cmake --build build && "
        "cmake --install build --prefix installed ) > log 2>&1";
    CHECK_MESSAGE(std::system(command.c_str()) == 0, textIn(kWork / "log"));
    return true;
}

SCRIPT(simulated_recipe, "xr/simulated/simulated_recipe") {
    if (!isInstalled("hello_xr", "libopenxr-utils") || !isInstalled("python3", "python3")) { return; }
    static const bool is_installed = install();
    REQUIRE(is_installed);
    const std::string page = BINOSPLAT_SOURCE_DIR "/docs/test_your_openxr_program.md";
    ScriptHost host{{}, kWork};
    host.names = {{"WORK", kWork.string()}, {"PAGE", page}};
    // block FILE LINE appends the page's block that contains this line.
    host.verbs["block"] = [&](const std::string& words) {
        const std::string text = textIn(page);
        const std::size_t space = words.find(' '), place = text.find(words.substr(space + 1));
        REQUIRE(place != std::string::npos);
        const std::size_t begin = text.find('\n', text.rfind("```", place)) + 1;
        std::ofstream(kWork / words.substr(0, space), std::ios::app)
            << text.substr(begin, text.find("```", place) - begin);
    };
    // picture FILE RED: 10 x 10 pixels, the first of which has this red; the rest is 100.
    host.verbs["picture"] = [&](const std::string& words) {
        std::vector<std::uint8_t> bytes(std::size_t{3} * 10 * 10, 100);
        bytes[0] = static_cast<std::uint8_t>(std::stoi(wordsIn(words).at(1)));
        simulated::writePng(kWork / wordsIn(words)[0], {{10, 10}, bytes});
    };
    runScript(host);
}

}  // SUITE(simulated_recipe)
