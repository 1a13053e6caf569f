// Facts about the simulated runtime's log of frames.
#include "tests/xr/simulated/folder.h"
#include "xr/simulated/compose/old_output.h"
#include "xr/simulated/log/frame_log.h"

SUITE(simulated_log) {

using namespace simulated;
using Json = nlohmann::json;

// As an earlier run left it.
std::string frameLine(const std::string& picture) {
    FrameRecord record;
    record.picture = picture;
    return makeFrameLine(record) + "\n";
}

TEST_CASE("a frame is one line of JSON, whose numbers read back as they were") {
    FrameRecord record;
    record.display_time_ns = 9'007'199'254'740'993;  // not a double
    record.stage_from_head = {glm::dquat(0.1, 0.2, 0.3, 0.4), {0.1, 1.0 / 3.0, std::nextafter(1.0, 2.0)}};
    record.events = {"\xff\xfe"};  // no UTF-8
    const std::string line = makeFrameLine(record);
    CHECK(line.find('\n') == std::string::npos);
    const Json json = Json::parse(line);
    CHECK(json["display_time_ns"].get<std::int64_t>() == 9'007'199'254'740'993);
    CHECK(json["head"]["position"][1].get<double>() == 1.0 / 3.0);
    CHECK(json["head"]["position"][2].get<double>() == std::nextafter(1.0, 2.0));
    CHECK(json["head"]["orientation"] == Json::array({0.2, 0.3, 0.4, 0.1}));  // x, y, z, w
    CHECK(these(json["events"].size(), json["layers"]) == these(1, Json::array()));
    CHECK(namePicture(1234567) == "frame_1234567.png");
}

TEST_CASE("what happens between frames has a line without a number") {
    const Json states = Json::parse(makeBetweenLine({"", "", 7, true, "EXITING", {"state IDLE", "state EXITING"}}));
    CHECK(states == Json{{"session_state", "EXITING"}, {"display_time_ns", 7}, {"events", {"state IDLE", "state EXITING"}}});
    const Json refused = Json::parse(makeBetweenLine({"XR_ERROR_TIME_INVALID", "the time is 0", 9, true, "FOCUSED", {}}));
    CHECK_FALSE(refused.contains("frame"));
    CHECK(refused == expecting(refused, {{"refused", "XR_ERROR_TIME_INVALID"}, {"reason", "the time is 0"}, {"should_render", true}}));
    CHECK(refused["events"].empty());
}

TEST_CASE_FIXTURE(InFolder, "lines are there before the log is closed") {
    const std::filesystem::path path = folder.path / "log";
    {
        FrameLog log(path);
        for (int i = 0; i < 2; ++i) { log.write("a line"); }
        CHECK(folder.bytesOf("log") == "a line\na line\n");
    }
    CHECK_THROWS_AS(FrameLog(path / "none" / "a.jsonl"), std::runtime_error);
    CHECK_THROWS_WITH_AS(FrameLog(path).write(""), (path.string() + ": cannot be made (File exists)").c_str(), std::runtime_error);
    CHECK(std::filesystem::file_size(path) > 0);
}

// A folder that an earlier run wrote to, among others.
struct UsedFolder : Folder {
    explicit UsedFolder(const std::set<std::string>& names) {
        for (const std::string& name : names) { write(name, "x"); }
    }

    void log(const std::vector<std::string>& pictures) const {
        std::string lines;
        for (const std::string& picture : pictures) { lines += frameLine(picture); }
        write(kLogName, lines);
    }
    void checkRefuses(const std::string& name, const FrameChoice& frames = {}) const {
        const std::set<std::string> before = names();
        CHECK_THROWS_WITH_AS(removeOldOutput(path, true, frames),
                             ((path / name).string() + ": not what an earlier run left here, must be moved elsewhere").c_str(),
                             std::runtime_error);
        CHECK(names() == before);
    }
};

TEST_CASE("a folder is emptied of what an earlier run's log names and of nothing else") {
    const std::set<std::string> others{"frame_12.png",      "frame_00000a.png", "frame_000000.jpg", "my_frame_000000.png",
                                       "frame_0000007.png", "notes.txt",        "frame_000001.png", ".frame_000005.unfinished.png"};
    std::set<std::string> all = others;
    all.insert({"frame_000000.png", "frame_1234567.png", ".frame_000002.unfinished.png"});
    const UsedFolder folder(all);
    folder.log({"frame_000000.png", "", "frame_000002.png", "frame_1234567.png", "notes.txt",
                "../" + folder.path.filename().string() + "/notes.txt"});
    std::ofstream(folder.path / kLogName, std::ios::app)
        << "{\"picture\":7}\n[\"picture\":]\n[{\"picture\":1}]\n{\"picture\":\"frame_000001.p";
    // The last run had every third picture; this one has none.
    removeOldOutput(folder.path, false, {});
    CHECK(folder.names() == others);
    removeOldOutput(folder.path / "nowhere", true, {});
}

TEST_CASE("a run's files do not replace others") {
    SUBCASE("a log, or an unfinished picture") {
        const UsedFolder folder({"frame_000000.png"});
        folder.write(kLogName, "somebody else's log\n");
        folder.checkRefuses(kLogName);
        fs::remove(folder.path / kLogName);
        folder.write(".frame_000001.unfinished.png", "x");
        folder.checkRefuses(".frame_000001.unfinished.png", {1, 1, 1});
    }
#ifndef _WIN32  // where links take a privilege
    SUBCASE("a link to a log, or to nothing") {
        const UsedFolder folder({"frame_000000.png"});
        folder.log({"frame_000000.png"});
        fs::rename(folder.path / kLogName, folder.path / "log");
        for (const char* target : {"log", "nothing"}) {
            fs::create_symlink(target, folder.path / kLogName);
            folder.checkRefuses(kLogName);
            fs::remove(folder.path / kLogName);
        }
    }
#endif
    SUBCASE("pictures that no log names, as far as this run writes such ones") {
        const UsedFolder folder({"frame_000003.png"});
        folder.checkRefuses("frame_000003.png");
        // Nor does a log from before logs named pictures.
        folder.log({""});
        folder.checkRefuses("frame_000003.png");
        folder.checkRefuses("frame_000003.png", {0, 100, 3});
        removeOldOutput(folder.path, true, {0, 100, 2});
        removeOldOutput(folder.path, false, {});
        CHECK(folder.names() == std::set<std::string>{"frame_000003.png"});
    }
#ifndef _WIN32
    SUBCASE("links and folders that bear a picture's name, though the log names it") {
        const UsedFolder folder({"elsewhere"});
        fs::create_symlink("elsewhere", folder.path / "frame_000002.png");
        folder.log({"frame_000002.png", "frame_000009.png"});
        folder.checkRefuses("frame_000002.png");
        fs::remove(folder.path / "frame_000002.png");
        fs::create_directory(folder.path / "frame_000009.png");
        folder.checkRefuses("frame_000009.png");
    }
#endif
    SUBCASE("but a log may begin with a frame that was refused, or with a session's states, or be empty") {
        for (const std::string& text : {makeBetweenLine({"XR_ERROR_TIME_INVALID", "", 0, true, "READY", {}}) + "\n",
                                        makeBetweenLine({"", "", 0, true, "IDLE", {"state IDLE"}}) + "\n", std::string()}) {
            const UsedFolder folder({});
            folder.write(kLogName, text);
            removeOldOutput(folder.path, true, {});
            CHECK(folder.names().empty());
        }
    }
}

}  // SUITE(simulated_log)
