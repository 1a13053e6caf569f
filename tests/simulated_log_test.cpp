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

TEST_CASE("aFrameIsOneLine") { CHECK(frameLine(someRecord()).find('\n') == std::string::npos); }

TEST_CASE("numbersInTheLogReadBackAsTheyWere") {
    const Json json = Json::parse(frameLine(someRecord()));
    CHECK(json["frame"] == 7);
    CHECK(json["blend_mode"] == "ADDITIVE");
    CHECK(json["display_time_ns"].get<std::int64_t>() == 9'007'199'254'740'993);
    CHECK(json["head"]["position"][1].get<double>() == 1.0 / 3.0);
    CHECK(json["head"]["position"][2].get<double>() == std::nextafter(1.0, 2.0));
    CHECK(json["eyes"][0]["fov"]["left"].get<double>() == -0.7);
}

TEST_CASE("quaternionsInTheLogAreXyzw") {
    const Json json = Json::parse(frameLine(someRecord()));
    CHECK(json["head"]["orientation"] == Json::array({0.2, 0.3, 0.4, 0.1}));
}

TEST_CASE("everyLayerIsLogged") {
    const Json json = Json::parse(frameLine(someRecord()));
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

TEST_CASE("framesWithoutLayersHaveEmptyLists") {
    const Json json = Json::parse(frameLine(FrameRecord{}));
    CHECK(json["layers"].is_array());
    CHECK(json["layers"].empty());
    CHECK(json["should_render"] == true);
}

TEST_CASE("namesThatAreNoUtf8DoNotStopTheLog") {
    FrameRecord record;
    record.events = {"\xff\xfe"};
    CHECK(Json::parse(frameLine(record))["events"].size() == 1);
}

TEST_CASE("linesAreThereBeforeTheLogIsClosed") {
    const std::filesystem::path path = std::filesystem::temp_directory_path() / ("binosplat_log_" + std::to_string(::getpid()) + ".jsonl");
    FrameLog log(path);
    log.write(someRecord());
    log.write(someRecord());
    CHECK(std::filesystem::file_size(path) == 2 * (frameLine(someRecord()).size() + 1));
    std::filesystem::remove(path);
    CHECK_THROWS_AS(FrameLog(path / "none" / "a.jsonl"), std::runtime_error);
}

TEST_CASE("aFolderIsEmptiedOfAnEarlierRunsPicturesAndOfNothingElse") {
    namespace fs = std::filesystem;
    const fs::path folder = fs::temp_directory_path() / ("binosplat_old_output_" + std::to_string(::getpid()));
    const auto fill = [&](const std::string& log) {
        fs::remove_all(folder);
        fs::create_directories(folder / "frame_000009.png");
        for (const char* name : {"frame_000000.png", "frame_1234567.png", ".frame_000001.unfinished.png", "frame_12.png",
                                 "frame_00000a.png", "frame_000000.jpg", "my_frame_000000.png", "notes.txt"}) {
            std::ofstream(folder / name) << "x";
        }
        std::ofstream(folder / "elsewhere") << "x";
        fs::create_symlink("elsewhere", folder / "frame_000002.png");
        std::ofstream(folder / "frames.jsonl") << log;
        removeOldOutput(folder);
        std::set<std::string> left;
        for (const auto& entry : fs::directory_iterator(folder)) { left.insert(entry.path().filename().string()); }
        return left;
    };
    FrameRecord first = someRecord();
    first.frame = 0;
    const std::set<std::string> all = fill("somebody else's log\n");
    CHECK(all.size() == 12);
    std::set<std::string> kept = all;
    for (const char* ours : {"frame_000000.png", "frame_1234567.png", ".frame_000001.unfinished.png"}) { kept.erase(ours); }
    CHECK(fill(frameLine(first) + "\n") == kept);
    // A log that goes elsewhere is not this folder's.
    fs::remove(folder / "frames.jsonl");
    std::ofstream(folder / "log") << frameLine(first) << "\n";
    fs::create_symlink("log", folder / "frames.jsonl");
    std::ofstream(folder / "frame_000000.png") << "x";
    removeOldOutput(folder);
    CHECK(fs::exists(folder / "frame_000000.png"));
    removeOldOutput(folder / "nowhere");
    fs::remove_all(folder);
}
