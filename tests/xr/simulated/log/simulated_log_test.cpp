// Facts about the simulated runtime's log of frames.
#include "xr/simulated/compose/old_output.h"
#include "xr/simulated/log/frame_log.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

TEST_SUITE_BEGIN("simulated_log");

namespace simulated_log_test {

using namespace simulated;
using Json = nlohmann::json;

namespace {

FrameRecord someRecord() {
    FrameRecord record;
    record.frame = 7;
    record.display_time_ns = 9'007'199'254'740'993;  // not a double
    record.period_ns = 11'111'111;
    record.session_state = "FOCUSED";
    record.blend_mode = "ADDITIVE";
    record.stage_from_head = {glm::dquat(0.1, 0.2, 0.3, 0.4), {0.1, 1.0 / 3.0, std::nextafter(1.0, 2.0)}};
    record.eyes[kLeft].fov = {-0.7, 0.6, 0.5, -0.4};
    LoggedView view;
    view.swapchain = 3;
    view.format = "VK_FORMAT_R8G8B8A8_SRGB";
    view.width = 640;
    view.height = 480;
    view.pose = Pose{};
    view.depth = LoggedDepth{"VK_FORMAT_D32_SFLOAT", 0.0, 1.0, INFINITY, 0.1};
    record.layers.push_back({"projection", {"blend_texture_source_alpha"}, "LOCAL", {}, {view, view}, {}, {}, ""});
    record.layers.push_back({"quad", {}, "STAGE", {}, {LoggedView{}}, Pose{}, glm::dvec2(1.5, 0.5), "left"});
    record.events = {"state VISIBLE", "slow-images 3"};
    return record;
}

}  // namespace

TEST_CASE("a frame is one line") { CHECK(makeFrameLine(someRecord()).find('\n') == std::string::npos); }

TEST_CASE("numbers in the log read back as they were") {
    const Json json = Json::parse(makeFrameLine(someRecord()));
    CHECK(json["frame"] == 7);
    CHECK(json["blend_mode"] == "ADDITIVE");
    CHECK(json["display_time_ns"].get<std::int64_t>() == 9'007'199'254'740'993);
    CHECK(json["head"]["position"][1].get<double>() == 1.0 / 3.0);
    CHECK(json["head"]["position"][2].get<double>() == std::nextafter(1.0, 2.0));
    CHECK(json["eyes"][0]["fov"]["left"].get<double>() == -0.7);
}

TEST_CASE("quaternions in the log are x, y, z, w") {
    const Json json = Json::parse(makeFrameLine(someRecord()));
    CHECK(json["head"]["orientation"] == Json::array({0.2, 0.3, 0.4, 0.1}));
}

TEST_CASE("every layer is logged") {
    const Json json = Json::parse(makeFrameLine(someRecord()));
    REQUIRE(json["layers"].size() == 2);
    const Json &projection = json["layers"][0], &quad = json["layers"][1];
    CHECK(projection["type"] == "projection");
    CHECK(projection["flags"] == Json::array({"blend_texture_source_alpha"}));
    CHECK(projection["views"].size() == 2);
    CHECK(projection["views"][1]["rect"] == Json::array({0, 0, 640, 480}));
    CHECK(projection["views"][0]["depth"]["far"] == 0.1);
    CHECK(projection["views"][0]["depth"]["near"].is_null());  // infinite
    CHECK_FALSE(projection.contains("size"));
    CHECK(quad["size"] == Json::array({1.5, 0.5}));
    CHECK(quad["eye_visibility"] == "left");
    CHECK_FALSE(quad["views"][0].contains("pose"));
    CHECK(json["events"] == Json::array({"state VISIBLE", "slow-images 3"}));
}

TEST_CASE("frames without layers have empty lists") {
    const Json json = Json::parse(makeFrameLine(FrameRecord{}));
    CHECK(json["layers"].is_array());
    CHECK(json["layers"].empty());
    CHECK(json["should_render"] == true);
}

TEST_CASE("what happens between frames has a line without a number") {
    const Json states = Json::parse(makeBetweenLine({"", "", 7, true, "EXITING", {"state IDLE", "state EXITING"}}));
    CHECK(states == Json{{"session_state", "EXITING"}, {"display_time_ns", 7}, {"events", {"state IDLE", "state EXITING"}}});
    const Json refused = Json::parse(makeBetweenLine({"XR_ERROR_TIME_INVALID", "the time is 0", 9, true, "FOCUSED", {}}));
    CHECK_FALSE(refused.contains("frame"));
    CHECK(refused["refused"] == "XR_ERROR_TIME_INVALID");
    CHECK(refused["reason"] == "the time is 0");
    CHECK(refused["should_render"] == true);
    CHECK(refused["events"].empty());
}

TEST_CASE("names that are no UTF-8 do not stop the log") {
    FrameRecord record;
    record.events = {"\xff\xfe"};
    CHECK(Json::parse(makeFrameLine(record))["events"].size() == 1);
}

TEST_CASE("a frame that has a picture names it") {
    FrameRecord record = someRecord();
    CHECK_FALSE(Json::parse(makeFrameLine(record)).contains("picture"));
    record.picture = namePicture(12);
    CHECK(Json::parse(makeFrameLine(record))["picture"] == "frame_000012.png");
    CHECK(namePicture(1234567) == "frame_1234567.png");
}

TEST_CASE("lines are there before the log is closed") {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / ("binosplat_log_" + std::to_string(::getpid()) + ".jsonl");
    {
        FrameLog log(path);
        log.write(makeFrameLine(someRecord()));
        log.write(makeFrameLine(someRecord()));
        CHECK(std::filesystem::file_size(path) == 2 * (makeFrameLine(someRecord()).size() + 1));
    }
    CHECK_THROWS_AS(FrameLog(path / "none" / "a.jsonl"), std::runtime_error);
    CHECK_THROWS_WITH_AS(FrameLog(path).write(""), (path.string() + ": cannot be made (File exists)").c_str(), std::runtime_error);
    CHECK(std::filesystem::file_size(path) > 0);
    std::filesystem::remove(path);
}

namespace {

namespace fs = std::filesystem;

// A folder that an earlier run wrote to, among others.
struct UsedFolder {
    fs::path path = fs::temp_directory_path() / ("binosplat_old_output_" + std::to_string(::getpid()));

    explicit UsedFolder(const std::set<std::string>& names) {
        fs::create_directories(path);
        for (const std::string& name : names) { std::ofstream(path / name) << "x"; }
    }
    ~UsedFolder() { fs::remove_all(path); }
    UsedFolder(const UsedFolder&) = delete;
    UsedFolder& operator=(const UsedFolder&) = delete;

    void log(const std::vector<std::string>& pictures) const {
        FrameRecord record = someRecord();
        record.frame = 0;
        std::ofstream stream(path / kLogName);
        for (const std::string& picture : pictures) {
            record.picture = picture;
            stream << makeFrameLine(record) << "\n";
        }
    }
    [[nodiscard]] std::set<std::string> names() const {
        std::set<std::string> names;
        for (const auto& entry : fs::directory_iterator(path)) { names.insert(entry.path().filename().string()); }
        return names;
    }
    void checkRefuses(const std::string& name, const FrameChoice& frames = {}) const {
        const std::set<std::string> before = names();
        CHECK_THROWS_WITH_AS(removeOldOutput(path, true, frames),
                             ((path / name).string() + ": not what an earlier run left here, must be moved elsewhere").c_str(),
                             std::runtime_error);
        CHECK(names() == before);
    }
};

}  // namespace

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
    SUBCASE("a log") {
        const UsedFolder folder({"frame_000000.png"});
        std::ofstream(folder.path / kLogName) << "somebody else's log\n";
        folder.checkRefuses(kLogName);
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
    SUBCASE("an unfinished picture") {
        const UsedFolder folder({".frame_000001.unfinished.png"});
        folder.checkRefuses(".frame_000001.unfinished.png");
    }
    SUBCASE("but a log may begin with a frame that was refused, or with a session's states") {
        for (const std::string& line : {makeBetweenLine({"XR_ERROR_TIME_INVALID", "", 0, true, "READY", {}}),
                                        makeBetweenLine({"", "", 0, true, "IDLE", {"state IDLE"}})}) {
            const UsedFolder folder({});
            std::ofstream(folder.path / kLogName) << line << "\n";
            removeOldOutput(folder.path, true, {});
            CHECK(folder.names().empty());
        }
    }
    SUBCASE("but an empty log is that of a run without frames") {
        const UsedFolder folder({kLogName});
        fs::resize_file(folder.path / kLogName, 0);
        removeOldOutput(folder.path, true, {});
        CHECK(folder.names().empty());
    }
}

}  // namespace simulated_log_test
