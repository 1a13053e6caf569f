// docs/test_your_openxr_program.md as a newcomer follows it: the folder of the simulated runtime is built
// alone and installed, the page's script runs a program that was not written for it, and its frame log is
// read and compared.
#include <sys/wait.h>

#include "tests/xr/simulated/installed.h"
#include "xr/simulated/compose/picture_file.h"

SUITE(simulated_recipe) {

// The same place each time, so that a compiler cache recognizes it.
const fs::path kWork = fs::path(BINOSPLAT_OUTPUT_DIR) / "simulated_alone";

struct Run {
    int exit_code = -1;
    std::string output;
};

Run shell(const std::string& command) {
    const fs::path log = kWork / "log";
    const int status = std::system(("( " + command + " ) > " + log.string() + " 2>&1").c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, textIn(log)};
}

bool haveTools() {
    return binosplat::test::isInstalled("hello_xr", "libopenxr-utils") &&
           binosplat::test::isInstalled("python3", "python3");
}

std::string pageText() { return textIn(BINOSPLAT_SOURCE_DIR "/docs/test_your_openxr_program.md"); }

// The block of the page that contains a line.
std::string blockWith(const std::string& line) {
    const std::string page = pageText();
    const std::size_t place = page.find(line);
    REQUIRE(place != std::string::npos);
    const std::size_t begin = page.find('\n', page.rfind("```", place)) + 1;
    return page.substr(begin, page.find("```", place) - begin);
}

// A copy of the folder, built and installed once for all cases: the manifest's path.
const fs::path& installedManifest() {
    static const fs::path manifest = [] {
        fs::create_directories(kWork);
        fs::remove_all(kWork / "source");
        fs::remove_all(kWork / "installed");
        fs::copy(std::string(BINOSPLAT_SOURCE_DIR) + "/xr/simulated", kWork / "source",
                 fs::copy_options::recursive);
        // Builds each target from one file that reads the headers once: half the work.
        const std::string cache =
            std::system("command -v ccache > /dev/null") == 0 ? " -DCMAKE_CXX_COMPILER_LAUNCHER=ccache" : "";
        const std::string work = kWork.string();
        const Run run = shell("cmake -S " + work + "/source -B " + work +
                              "/build -G Ninja -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-g0 "
                              "-DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=0" +
                              cache + " && cmake --build " + work + "/build && cmake --install " + work +
                              "/build --prefix " + work + "/installed");
        CHECK_MESSAGE(run.exit_code == 0, run.output);
        return kWork / "installed/share/openxr/1/simulated_openxr_runtime.json";
    }();
    return manifest;
}

// hello_xr ends at the first key, so its input stays open and silent.
Run runHello(const std::string& name, const std::string& script) {
    std::ofstream(kWork / (name + ".script")) << script;
    fs::remove_all(kWork / name);
    const std::string keys = (kWork / "keys").string();
    return shell("rm -f " + keys + " && mkfifo " + keys +
                 " && env -u SIMULATED_OPENXR_SCRIPT -u SIMULATED_OPENXR_OUT XR_RUNTIME_JSON=" +
                 installedManifest().string() + " SIMULATED_OPENXR_SCRIPT=" +
                 (kWork / (name + ".script")).string() + " SIMULATED_OPENXR_OUT=" + (kWork / name).string() +
                 " SIMULATED_OPENXR_EXPLAIN=1 timeout 60 hello_xr -g Vulkan2 0<>" + keys);
}

Run compareRuns(const std::string& expected, const std::string& actual, const std::string& options = "") {
    return shell((kWork / "installed/bin/compare_frame_logs").string() + " " + (kWork / expected).string() +
                 " " + (kWork / actual).string() + " " + options);
}

bool contains(const Run& run, const char* part) { return run.output.find(part) != std::string::npos; }

TEST_CASE("the folder builds alone and installs a library that its manifest finds, where the page says" *
          nightly()) {
    REQUIRE(fs::exists(installedManifest()));
    for (const char* file : {"lib/libsimulated_openxr_runtime.so",
                             "share/openxr/1/simulated_openxr_runtime.json", "bin/compare_frame_logs"}) {
        CHECK_MESSAGE(pageText().find(std::string(1, '`') + file + '`') != std::string::npos, file);
        CHECK_MESSAGE(fs::exists(kWork / "installed" / file), file);
    }
    const auto manifest = nlohmann::json::parse(std::ifstream(installedManifest()));
    CHECK(manifest["runtime"]["name"] == "Simulated OpenXR runtime");
    const fs::path library =
        installedManifest().parent_path() / manifest["runtime"]["library_path"].get<std::string>();
    CHECK(fs::exists(library));
    CHECK(fs::exists(kWork / "installed/share/doc/simulated_openxr_runtime/LICENSE"));
    // Apart from what every Debian has, it needs only libpng.
    const Run needs = shell("ldd " + library.string());
    CHECK(contains(needs, "libpng"));
    for (const char* other : {"OpenImageIO", "fmt", "vulkan", "openxr", "not found"}) {
        CHECK_MESSAGE(!contains(needs, other), needs.output);
    }
}

TEST_CASE("a foreign program runs by the page's script, and by its recipes for CTest and pytest" *
          nightly()) {
    if (!haveTools()) { return; }
    REQUIRE(fs::exists(installedManifest()));
    const std::string script = blockWith("press right trigger 0.5 0.7");
    const Run first = runHello("expected", script);
    CHECK_MESSAGE(first.exit_code == 0, first.output);
    CHECK(contains(first, "XR_SESSION_STATE_IDLE->XR_SESSION_STATE_EXITING"));
    const std::vector<std::string> lines = linesIn(textIn(kWork / "expected/frames.jsonl"));
    REQUIRE(lines.size() > 100);
    const auto frame = nlohmann::json::parse(lines[90]);
    CHECK(these(frame["session_state"], frame["layers"].at(0)["type"], frame["picture"]) ==
          these("FOCUSED", "projection", "frame_000090.png"));
    CHECK(frame["head"]["position"][0].get<double>() == doctest::Approx(0.5));
    // Two of the pictures, and one that was not wanted.
    for (const auto& [picture, is_there] : {std::pair("30", true), {"31", false}, {"90", true}}) {
        CHECK(fs::exists(kWork / "expected" / (std::string("frame_0000") + picture + ".png")) == is_there);
    }
    // A home with the installed runtime, and hello_xr as the program to be tested.
    fs::remove_all(kWork / "home");
    fs::create_directories(kWork / "home/project/expected");
    fs::create_directory_symlink(kWork / "installed", kWork / "home/simulated-openxr");
    std::ofstream(kWork / "installed/bin/my_program")
        << "#!/bin/sh\nexec hello_xr -g Vulkan2 0<>" << (kWork / "keys").string() << "\n";
    fs::permissions(kWork / "installed/bin/my_program", fs::perms::owner_all);
    fs::copy(kWork / "expected", kWork / "home/project/expected/walk", fs::copy_options::recursive);
    std::ofstream(kWork / "home/project/walk.script") << script;
    std::ofstream(kWork / "home/project/CMakeLists.txt")
        << "cmake_minimum_required(VERSION 3.25)\nproject(tested NONE)\nenable_testing()\n"
        << blockWith("add_test(NAME walk COMMAND my_program)");
    std::ofstream(kWork / "home/test_it.py")
        << blockWith("def test_the_program_renders_when_it_is_in_focus")
        << "\nimport tempfile\nwith tempfile.TemporaryDirectory() as folder:\n"
           "    test_the_program_renders_when_it_is_in_focus(pathlib.Path(folder))\n";
    const std::string home = (kWork / "home").string();
    const std::string environment = "export HOME=" + home + " PATH=" + (kWork / "installed/bin").string() +
                                    ":$PATH; unset SIMULATED_OPENXR_SCRIPT SIMULATED_OPENXR_OUT; cd " + home +
                                    "; ";
    const Run tests =
        shell(environment +
              "cmake -S project -B build && ctest --test-dir build --output-on-failure --no-tests=error");
    CHECK_MESSAGE(tests.exit_code == 0, tests.output);
    CHECK(contains(tests, "100% tests passed, 0 tests failed out of 2"));
    const Run python = shell(environment + "python3 test_it.py");
    CHECK_MESSAGE(python.exit_code == 0, python.output);
}

TEST_CASE("the tool that compares logs says what differs, within what it was told" * nightly()) {
    if (!haveTools()) { return; }
    REQUIRE(fs::exists(installedManifest()));
    const auto write = [](const std::string& name, const std::string& lines, std::uint8_t red) {
        fs::remove_all(kWork / name);
        fs::create_directories(kWork / name);
        std::ofstream(kWork / name / "frames.jsonl") << lines;
        std::vector<std::uint8_t> bytes(std::size_t{3} * 10 * 10, 100);
        bytes[0] = red;
        simulated::writePng(kWork / name / "frame_000000.png", {{10, 10}, bytes});
    };
    struct Case {
        std::string actual, options;
        int exit_code;
        std::string said;  // or a part of it
    };
    const std::string no_frame = "b/frames.jsonl:2: not a frame, must be an object of JSON";
    const std::string expected =
        "{\"frame\": 0, \"x\": [1, 2.5], \"events\": [\"exit\"]}\n{\"refused\": \"XR_ERROR_TIME_INVALID\"}\n";
    const std::string other =
        "{\"frame\": 0, \"x\": [1, 2.6], \"events\": []}\n{\"refused\": \"XR_ERROR_POSE_INVALID\"}\n";
    const std::string forgiving = "--ignore events --ignore x --ignore refused --pictures ";
    write("a", expected, 100);
    for (const Case& one :
         {Case{other, "", 1,
               "frame 0: x[1] is 2.6, expected 2.5\nframe 0: events has 0 entries, expected 1\n"
               "line 2: refused is \"XR_ERROR_POSE_INVALID\", expected \"XR_ERROR_TIME_INVALID\"\n"},
          {other, "--tolerance 0.2 --ignore events --ignore refused", 0, ""},
          {other, "--ignore events --ignore x --ignore refused", 0, ""},
          {other, forgiving + "10", 0, ""},
          {other, forgiving + "9 --share 0.01", 0, ""},
          {other, forgiving + "9", 1,
           "frame_000000.png is off by more than 9 in 1 of 100 pixels (PSNR 52.9 dB)"},
          {expected + "{\"frame\": 1}\n", "", 1, "3 lines, expected 2"},
          {"nonsense\n", "", 2, "b/frames.jsonl:1: not a line of JSON"},
          {"{}\n7\n", "", 2, no_frame},
          {"{}\n[{}]\n", "", 2, no_frame},
          {"{}\nnull\n", "", 2, no_frame},
          {"{}\n\"x\"\n", "", 2, no_frame}}) {
        INFO("one.actual ", one.actual, ", one.options ", one.options);
        write("b", one.actual, 110);
        const Run run = compareRuns("a", "b", one.options);
        CHECK(run.exit_code == one.exit_code);
        CHECK_MESSAGE(contains(run, one.said.c_str()), run.output);
    }
    write("b", expected, 100);
    fs::remove(kWork / "b/frame_000000.png");
    CHECK(contains(compareRuns("a", "b", "--pictures 1"), "frame_000000.png is missing"));
    CHECK(compareRuns("a", "nowhere").exit_code == 2);
    // A picture that ends within its signature, within its header, before its pixels and within them.
    write("d", expected, 100);
    CHECK(compareRuns("a", "d", "--pictures 0").exit_code == 0);
    const fs::path picture = kWork / "d/frame_000000.png";
    const std::uintmax_t behind_pixels = 16;
    for (const std::uintmax_t size : {std::uintmax_t{0}, std::uintmax_t{7}, std::uintmax_t{20},
                                      std::uintmax_t{33}, fs::file_size(picture) - behind_pixels - 1}) {
        write("d", "{}\n", 100);
        fs::resize_file(picture, size);
        const Run run = compareRuns("a", "d", "--pictures 0");
        CAPTURE(size);
        CHECK(run.exit_code == 2);
        CHECK_MESSAGE(run.output.starts_with("compare_frame_logs: " + picture.string() + ": "), run.output);
    }
}

}  // SUITE(simulated_recipe)
