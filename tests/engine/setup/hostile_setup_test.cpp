// Broken settings, headsets, cameras and head motion: each is read, or refused in one line.
#include "engine/setup/camera_file.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/headset.h"
#include "engine/setup/settings.h"
#include "engine/setup/values.h"
#include "tests/engine/files/hostile_files.h"
#include "tests/run_program.h"
#include "xr/simulated/files/toml_guard.h"

SUITE(hostile_setup) {

// Texts of one kind, with `changes` times each kind of damage.
void breakTexts(const std::string& name, const std::vector<std::string>& texts, int changes,
                const std::function<void(const std::string& path)>& read,
                const std::vector<std::string>& more = {}) {
    std::vector<Target> targets;
    for (const std::string& text : texts) {
        targets.push_back({.name = name,
                           .good = text,
                           .changes = changes,
                           .numbers = text.size(),
                           .lines = text.size(),
                           .must_be_whole = false,
                           .more = more});
    }
    attack(Folder(), targets, 1, 8, 512, [&](const std::string& path, const Target&) { read(path); });
}

std::string textOf(const std::string& path) { return textIn(BINOSPLAT_SOURCE_DIR "/" + path); }

// All values of a file through all readers of values.
void readEverything(const std::string& path) {
    for (const SettingsTable& table : readSettingsFile(path)) {
        for (const auto& [key, setting] : table.settings) {
            const Setting& value = setting;
            for (const std::function<void()>& read : std::initializer_list<std::function<void()>>{
                     [&] { (void)readNumber(value, -1e6, 1e6); }, [&] { (void)readPositive(value); },
                     [&] { (void)readCount(value, 0, 1000); }, [&] { (void)readVector(value); },
                     [&] { (void)readSize(value); }, [&] { (void)readFlag(value); },
                     [&] {
                         (void)readChoice(value, {"mono", "paper"});
                     }}) {
                CHECK(errorOf(read).find('\n') == std::string::npos);
            }
        }
    }
}

void readCameras(const std::string& path) {
    for (const FileCamera& camera : readCameraFile(path, glm::dvec3(0.0))) {
        CHECK(camera.eye.size_px.x >= 1);
    }
}

void breakAll(int changes) {
    // Every key of the file gets a value: what is commented out cannot be damaged.
    std::string every_key = textOf("configs/default.toml").substr(0, 1500);
    for (std::size_t at = every_key.find("[camera]");
         (at = every_key.find("\n# ", at)) != std::string::npos;) {
        every_key.erase(at + 1, 2);
    }
    breakTexts("settings",
               {every_key.substr(0, every_key.rfind('\n') + 1),
                "[bench]\nscenes = [\"a\", \"b\"]\nrepeats = 3\n[[methods]]\nname = 'x'\nbudget = [0.1, "
                "2e-1]\n[[views]]\nfov_x = 90\n"},
               changes, readEverything);
    breakTexts("headsets", {textOf("configs/headsets/quest3.toml"), textOf("configs/headsets/index.toml")},
               changes, [](const std::string& path) { (void)readHeadset(path); });
    const std::string deep = std::string(1'000'000, '[') + std::string(1'000'000, ']');
    breakTexts(
        "cameras", {R"([{"id": 0, "img_name": "a", "width": 640, "height": 480, "position": [1, 2, -3.5],
 "rotation": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "fx": 500, "fy": 501.5, "cx": 320, "cy": 240},
{"img_name": "b", "width": 64, "height": 48, "position": [0, 0, 1e-3], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]], "fx": 50, "fy": 50}])"},
        changes, readCameras, {std::string(1'000'000, '['), "[" + deep + "]", R"([{"width":)" + deep + "}]"});
    for (const MotionAxes axes : {MotionAxes::kOpenXr, MotionAxes::kUnity}) {
        const auto read = [&](const std::string& path) {
            const HeadMotion motion = readHeadMotion(path, axes);
            const Pose pose = motion.poseAt(0.5 * motion.duration_s());
            CHECK(std::isfinite(pose.position.x + pose.position.y + pose.position.z));
        };
        breakTexts("head motion",
                   {"time_ms,x,y,z,qx,qy,qz,qw\n0,0.1,1.5,-0.25,0,0,0,1\n# a remark\n"
                    "16.5,0.11,1.5,-0.25,0,0.0998,0,0.995\n33,0.12,1.5,-0.25,0,0.1,0,0.995\n"},
                   changes, read);
    }
}

TEST_CASE("broken settings, headsets, cameras and head motion are read or refused") { breakAll(50); }

TEST_CASE("and so are more of them" * nightly()) { breakAll(1000); }

TEST_CASE("settings as deep as a file can be, or in strange letters, are read or refused") {
    std::string tables, dotted = "a";
    for (int i = 0; i < 100'000; ++i) { tables += "{a="; }
    for (int i = 0; i < 300'000; ++i) { dotted += ".a"; }
    std::vector<std::string> texts{"a = " + std::string(100'000, '['), "a = " + tables,
                                   "a = \"\"\"\nb\n\"\"\"\n",          "\"a\\nb\" = 1\n[c]\n[c.d]\n",
                                   "[\"a\\nb\"]\nc = {d = 1}\n",       "when = 1979-05-27\n"};
    const auto around = [&](const std::string& letter, std::initializer_list<const char*> with) {
        for (const char* text : with) { texts.push_back(fmt::format(fmt::runtime(text), letter, letter)); }
    };
    around(dotted, {"{} = 1\n", "[{}]\nb = 1\n", "[[{}]]\nb = 1\n"});
    for (const char* letter : {"\u00a1", "\u03e2", "\u0499", "\u2000", "\u3000", "\ufeff", "\xff", "\xc3"}) {
        around(letter, {"a = {}\n", "{} = 1\n", "a = 1 {}\n", "a = [1, {}]\n", "a = \"{}\"\n", "# {}\n",
                        "{}a = 1\n", "a = '{}'{}\n"});
    }
    // Quotes that toml++ does not take for quotes: more of a word that is already wrong.
    for (const char* letter : {"\u00e9", "\ufbd0", "\ufef7"}) {
        around(letter, {"a = 2\"{}\"\n", "a = -2[\"{}\"]\n", "a = [--2[\"{}\"]]\n", "a = 2=\"{}\"\n",
                        "a = [\nb=\"{}\"]\n", "a = [-{{\"{}\"\n", "a = 2]\"{}\"\n", "a = [[\"x\"]-\"{}\"]\n",
                        "a = 2 [\"{}\"]\n", "a = \"\\\n\"{}\"\n"});
    }
    breakTexts("settings", {"a = 1\n"}, 0, readEverything, texts);
}

TEST_CASE_FIXTURE(AtWork, "letters outside of ASCII are read in quotes and comments alone") {
    const auto read = [&](const std::string& text) {
        work.write("letters.toml", text);
        (void)readSettingsFile(work.path / "letters.toml");
    };
    CHECK_NOTHROW(read("\xef\xbb\xbfname = \"\u00c4 \\\" \u03e2\" # \u03e2\nother = '\u03e2'\n"));
    // Wherever TOML allows quotes around a text or a key.
    CHECK_FALSE(
        files::findUnreadableToml("a = [\"\u00e9\", [\n'\u00e9', 1 , \"\u00e9\"]]\nb = {c = \"\u00e9\", "
                                  "d.e=[\"\u00e9\"], f = '\u00e9'}\n"
                                  "[\"\u00e9\"]\n[[g]]\n\"\u00e9\" = 1\n"));
    for (const auto& [text, message] :
         {std::pair("a = 1\nb = \u00e9\n", "letters.toml:2: a letter that is neither ASCII"),
          {"a = 1\n\nb = '''x'''\n", "letters.toml:3: a text over several lines"},
          {"a = 1\nb = 2\"\u00e9\"\n", "letters.toml:2: quotes within a word"}}) {
        CHECK_THROWS_WITH_AS(read(text), doctest::Contains(message), Error);
    }
}

}  // SUITE(hostile_setup)
