// Facts about the simulated runtime's log of frames.
#include "tests/script.h"
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
    record.display_time_ns = 9'007'199'254'740'993;  // not representable as a double
    record.stage_from_head = {glm::dquat(0.1, 0.2, 0.3, 0.4), {0.1, 1.0 / 3.0, std::nextafter(1.0, 2.0)}};
    record.events = {"\xff\xfe"};  // not UTF-8
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

TEST_CASE_FIXTURE(InFolder, "lines are there before the log is closed") {
    const std::filesystem::path path = folder.path / "log";
    {
        FrameLog log(path);
        for (int i = 0; i < 2; ++i) { log.write("a line"); }
        CHECK(folder.bytesOf("log") == "a line\na line\n");
    }
    CHECK_THROWS_AS(FrameLog(path / "none" / "a.jsonl"), std::runtime_error);
    CHECK_THROWS_WITH_AS(FrameLog(path).write(""), (path.string() + ": cannot be made (File exists)").c_str(),
                         std::runtime_error);
    CHECK(std::filesystem::file_size(path) > 0);
}

SCRIPT(simulated_log, "xr/simulated/log/simulated_log") {
    const Folder folder;
    const auto begin = [&](const std::string& words, const std::string&) -> Outcome {
        FrameChoice frames;
        if (words != "all" && words != "none") {
            std::istringstream(words) >> frames.first >> frames.last >> frames.every;
        }
        try {
            removeOldOutput(folder.path, words != "none", frames);
            return {0, "", ""};
        } catch (const std::runtime_error& error) { return {1, "", error.what() + std::string("\n")}; }
    };
    ScriptHost host{begin, folder.path};
    host.names = {{"FOLDER", folder.path.string()}, {"FOLDER_NAME", folder.path.filename().string()}};
#ifndef _WIN32  // on Windows, links need a privilege
    host.features = {"posix"};
#endif
    host.verbs["touch"] = [&](const std::string& names) {
        for (const std::string& name : wordsIn(names)) { folder.write(name, "x"); }
    };
    host.verbs["log"] = [&](const std::string& pictures) {
        std::string lines;
        for (const std::string& picture : wordsIn(pictures)) {
            lines += frameLine(picture == "-" ? "" : picture);
        }
        folder.write(kLogName, lines);
    };
    host.verbs["append"] = [&](const std::string& text) {
        std::ofstream(folder.path / kLogName, std::ios::app) << unescaped(text);
    };
    host.verbs["begun"] = [&](const std::string& kind) {
        const std::string refused =
                              makeBetweenLine({"XR_ERROR_TIME_INVALID", "", 0, true, "READY", {}}) + "\n",
                          states = makeBetweenLine({"", "", 0, true, "IDLE", {"state IDLE"}}) + "\n";
        folder.write(kLogName, kind == "refused" ? refused : kind == "states" ? states : "");
    };
    host.verbs["remove"] = [&](const std::string& name) { CHECK(fs::remove(folder.path / name)); };
    host.verbs["nowhere"] = [&](const std::string&) { removeOldOutput(folder.path / "nowhere", true, {}); };
    runScript(host);
}

}  // SUITE(simulated_log)
