// The Khronos example program hello_xr, unchanged, on the simulated runtime: run with a script, its frames and pictures read back.
#pragma once

#include "tests/xr/simulated/api/simulated_fixture.h"
#include "tests/xr/simulated/installed.h"
#include "xr/simulated/compose/picture_file.h"

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace binosplat::test {

using Json = nlohmann::json;

inline bool haveHelloXr() { return isInstalled("hello_xr", "libopenxr-utils"); }

class HelloXr : public Headset {
public:
    int exit_status = -1;  // 124: it did not end within its time
    std::string output;
    std::vector<Json> frames;   // of the log
    std::vector<Json> between;  // its lines that are no frames

    // It ends when its session ends or when a key is pressed: its input is a pipe that stays open and silent.
    explicit HelloXr(const std::string& script, const std::string& options = "") : Headset(script) {
        const std::string pipe = (folder / "keys").string(), log = (folder / "output").string();
        const std::string command = "mkfifo " + pipe + " && " BINOSPLAT_STRANGERS_ENVIRONMENT "timeout 60 hello_xr -g Vulkan2 " + options +
                                    " 0<>" + pipe + " > " + log + " 2>&1";
        const int status = std::system(command.c_str());
        exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
        output = readFile(log);
        std::ifstream lines(written / "frames.jsonl");
        for (std::string line; std::getline(lines, line);) {
            Json json = Json::parse(line);
            (json.contains("frame") ? frames : between).push_back(std::move(json));
        }
    }

    [[nodiscard]] std::filesystem::path pictureFile(std::size_t frame) const {
        char name[32];
        std::snprintf(name, sizeof name, "frame_%06zu.png", frame);
        return written / name;
    }
    // One eye's half of a frame's picture.
    [[nodiscard]] simulated::RgbPicture eye(std::size_t frame, simulated::Side side) const {
        const simulated::RgbPicture both = simulated::readPng(pictureFile(frame));
        simulated::RgbPicture half{{both.size_px.x / 2, both.size_px.y}, {}};
        const std::size_t row_bytes = std::size_t{3} * half.size_px.x;
        for (std::size_t y = 0; y < half.size_px.y; ++y) {
            const auto row = both.bytes.begin() + static_cast<std::ptrdiff_t>((2 * y + side) * row_bytes);
            half.bytes.insert(half.bytes.end(), row, row + static_cast<std::ptrdiff_t>(row_bytes));
        }
        return half;
    }

    [[nodiscard]] static std::string readFile(const std::filesystem::path& path) {
        std::ifstream stream(path, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
};

}  // namespace binosplat::test
