// Broken settings, headsets, cameras and head motion: each is read or refused in one line.
#include "engine/setup/camera_file.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/headset.h"
#include "engine/setup/settings.h"
#include "engine/setup/values.h"
#include "tests/hostile.h"
#include "xr/simulated/files/toml_guard.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

TEST_SUITE_BEGIN("hostile_setup");

namespace hostile_setup_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

struct TextAttempts {
    std::string name;
    std::filesystem::path folder = std::filesystem::temp_directory_path() / fmt::format("binosplat_hostile_test_{}", ::getpid());
    std::function<void(const std::string& path)> read;
    Tally tally;

    TextAttempts(std::string what, std::function<void(const std::string& path)> reader) : name(std::move(what)), read(std::move(reader)) {
        std::filesystem::create_directories(folder);
    }
    ~TextAttempts() {
        MESSAGE(fmt::format("{}: {} broken files, {} read, {} refused", name, tally.inputs, tally.read, tally.refused));
        CHECK(tally.refused > tally.inputs / 8);
        CHECK(peakMebibytes() < 512);
        std::filesystem::remove_all(folder);
    }
    TextAttempts(const TextAttempts&) = delete;
    TextAttempts& operator=(const TextAttempts&) = delete;

    void attempt(const std::string& what, const std::string& bytes) {
        const std::string path = (folder / "broken.toml").string();
        std::filesystem::remove(path);  // some file systems wait for the disk where a file is cut to nothing and written again
        std::ofstream(path, std::ios::binary) << bytes;
        tally.attempt(name + ", " + what, [&] { read(path); });
    }
    // All kinds of harm.
    void run(const std::string& good) {
        const Attempt one = [this](const std::string& what, const std::string& bytes) { attempt(what, bytes); };
        truncate(good, one);
        flipBits(good, 1000, one);
        spliceBytes(good, 1000, one);
        replaceNumbers(good, good.size(), one);
        shuffleLines(good, good.size(), one);
    }
};

std::string textOf(const std::string& path) {
    std::ifstream file(std::string(BINOSPLAT_SOURCE_DIR "/") + path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

// All values of a file through all readers of values.
void readEverything(const std::string& path) {
    for (const SettingsTable& table : readSettingsFile(path)) {
        for (const auto& [key, setting] : table.settings) {
            const auto ignoreRefusal = [](const auto& read) {
                try {
                    (void)read();
                } catch (const Error& error) { CHECK(std::string(error.what()).find('\n') == std::string::npos); }
            };
            const Setting& value = setting;
            ignoreRefusal([&] { return readNumber(value, -1e6, 1e6); });
            ignoreRefusal([&] { return readPositive(value); });
            ignoreRefusal([&] { return readCount(value, 0, 1000); });
            ignoreRefusal([&] { return readVector(value); });
            ignoreRefusal([&] { return readSize(value); });
            ignoreRefusal([&] { return readFlag(value); });
            ignoreRefusal([&] { return readChoice(value, {"mono", "paper"}); });
        }
    }
}

constexpr const char* kCameras = R"([{"id": 0, "img_name": "a", "width": 640, "height": 480, "position": [1, 2, -3.5],
 "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "fx": 500, "fy": 501.5, "cx": 320, "cy": 240},
{"img_name": "b", "width": 64, "height": 48, "position": [0, 0, 1e-3], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "fx": 50, "fy": 50}])";
constexpr const char* kMotion =
    "time_ms,x,y,z,qx,qy,qz,qw\n0,0.1,1.5,-0.25,0,0,0,1\n# a "
    "remark\n16.5,0.11,1.5,-0.25,0,0.0998,0,0.995\n33,0.12,1.5,-0.25,0,0.1,0,0.995\n";

}  // namespace

TEST_CASE("broken settings") {
    TextAttempts attempts("settings", readEverything);
    attempts.run(textOf("configs/default.toml").substr(0, 1500));
    attempts.run(
        "[bench]\nscenes = [\"a\", \"b\"]\nrepeats = 3\n[[methods]]\nname = 'x'\nbudget = [0.1, 2e-1]\n[[views]]\nfov_x = 90\nwhen = "
        "1979-05-27\n");
    attempts.attempt("deep arrays", "a = " + std::string(100'000, '['));
    attempts.attempt(
        "deep tables", "a = " + [] {
            std::string text;
            for (int i = 0; i < 100'000; ++i) { text += "{a="; }
            return text;
        }());
    for (const char* around : {"{} = 1\n", "[{}]\nb = 1\n", "[[{}]]\nb = 1\n"}) {
        std::string dotted = "a";
        for (int i = 0; i < 300'000; ++i) { dotted += ".a"; }
        attempts.attempt("deep keys", fmt::format(fmt::runtime(around), dotted));
    }
    for (const char* letter : {"\u00a1", "\u03e2", "\u0499", "\u2000", "\u3000", "\ufeff", "\xff", "\xc3"}) {
        for (const char* around :
             {"a = {}\n", "{} = 1\n", "a = 1 {}\n", "a = [1, {}]\n", "a = \"{}\"\n", "# {}\n", "{}a = 1\n", "a = '{}'{}\n"}) {
            attempts.attempt("not ASCII", fmt::format(fmt::runtime(around), letter, letter));
        }
    }
    // Quotes that toml++ does not take for quotes: more of a word that is already wrong.
    for (const char* letter : {"\u00e9", "\ufbd0", "\ufef7"}) {
        for (const char* around :
             {"a = 2\"{}\"\n", "a = -2[\"{}\"]\n", "a = [--2[\"{}\"]]\n", "a = 2=\"{}\"\n", "a = [\nb=\"{}\"]\n", "a = [-{{\"{}\"\n",
              "a = 2]\"{}\"\n", "a = [[\"x\"]-\"{}\"]\n", "a = 2 [\"{}\"]\n", "a = \"\\\n\"{}\"\n"}) {
            attempts.attempt("letters that look like quotes", fmt::format(fmt::runtime(around), letter));
        }
    }
    attempts.attempt("several lines", "a = \"\"\"\nb\n\"\"\"\n");
    attempts.attempt("a line break in a key", "\"a\\nb\" = 1\n[c]\n[c.d]\n");
    attempts.attempt("a line break in a table's name", "[\"a\\nb\"]\nc = {d = 1}\n");
}

TEST_CASE("letters outside of ASCII are read in quotes and comments and refused elsewhere, with their line") {
    TextAttempts attempts("letters", [](const std::string& path) { (void)readSettingsFile(path); });
    const auto messageOf = [&](const std::string& text) {
        const std::string path = (attempts.folder / "letters.toml").string();
        std::ofstream(path, std::ios::binary) << text;
        try {
            (void)readSettingsFile(path);
        } catch (const Error& error) { return std::string(error.what()); }
        return std::string();
    };
    CHECK(messageOf("\xef\xbb\xbfname = \"\u00c4 \\\" \u03e2\" # \u03e2\nother = '\u03e2'\n").empty());
    // Wherever TOML takes quotes for a text or a key.
    CHECK_FALSE(
        files::findUnreadableToml("a = [\"\u00e9\", [\n'\u00e9', 1 , \"\u00e9\"]]\nb = {c = \"\u00e9\", d.e=[\"\u00e9\"], f = '\u00e9'}\n"
                                  "[\"\u00e9\"]\n[[g]]\n\"\u00e9\" = 1\n"));
    CHECK(messageOf("a = 1\nb = \u00e9\n").find("letters.toml:2: a letter that is neither ASCII") != std::string::npos);
    CHECK(messageOf("a = 1\n\nb = '''x'''\n").find("letters.toml:3: a text over several lines") != std::string::npos);
    CHECK(messageOf("a = 1\nb = 2\"\u00e9\"\n").find("letters.toml:2: quotes within a word") != std::string::npos);
    attempts.attempt("not TOML", "=");
}

TEST_CASE("broken headsets") {
    TextAttempts attempts("headsets", [](const std::string& path) { (void)readHeadset(path); });
    attempts.run(textOf("configs/headsets/quest3.toml"));
    attempts.run(textOf("configs/headsets/index.toml"));
}

TEST_CASE("broken cameras") {
    TextAttempts attempts("cameras", [](const std::string& path) {
        const std::vector<FileCamera> cameras = readCameraFile(path);
        for (const FileCamera& camera : cameras) { CHECK(camera.eye.size_px.x >= 1); }
    });
    attempts.run(kCameras);
    attempts.attempt("deeply nested", std::string(1'000'000, '['));
    const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
    attempts.attempt("deeply nested and closed", "[" + deep + "]");
    attempts.attempt("deeply nested in a camera", R"([{"width":)" + deep + "}]");
}

TEST_CASE("broken head motion") {
    for (const MotionAxes axes : {MotionAxes::kOpenXr, MotionAxes::kUnity}) {
        TextAttempts attempts("head motion", [&](const std::string& path) {
            const HeadMotion motion = readHeadMotion(path, axes);
            const Pose pose = motion.poseAt(0.5 * motion.duration_s());
            CHECK(std::isfinite(pose.position.x + pose.position.y + pose.position.z));
        });
        attempts.run(kMotion);
    }
}

}  // namespace hostile_setup_test
