// Running `binosplat view` in the simulated headset, and reading what its wearer saw and what the runtime noted down.
#pragma once

#include "engine/picture/image_io.h"
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <fstream>
#include <string>
#include <vector>

namespace binosplat::test {

// Vulkan's and OpenXR's validation layers are on, and both must stay silent; no window opens, where a mouse might pass.
inline const std::string kValidated =
    "XDG_CONFIG_HOME=\"$PWD/../config\" DISPLAY= WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1 "
    "XR_ENABLE_API_LAYERS=XR_APILAYER_LUNARG_core_validation "
    "XR_CORE_VALIDATION_EXPORT_TYPE=text";

struct ViewRun {
    Outcome outcome;
    std::filesystem::path out;
    std::vector<nlohmann::json> frames;   // of frames.jsonl
    std::vector<nlohmann::json> between;  // its lines that are no frames

    // What the eye saw in a frame.
    [[nodiscard]] Image eye(std::size_t frame, int side) const {
        const Image both = readPicture(out / fmt::format("frame_{:06}.png", frame));
        Image half{{both.size_px.x / 2, both.size_px.y}, both.channels, {}};
        const std::size_t row = std::size_t{half.size_px.x} * static_cast<std::size_t>(half.channels);
        for (std::size_t y = 0; y < half.size_px.y; ++y) {
            const auto from = both.values.begin() + static_cast<std::ptrdiff_t>((2 * y + static_cast<std::size_t>(side)) * row);
            half.values.insert(half.values.end(), from, from + static_cast<std::ptrdiff_t>(row));
        }
        return half;
    }
    // The layers of a frame, of one type.
    [[nodiscard]] std::vector<nlohmann::json> layers(std::size_t frame, const std::string& type) const {
        std::vector<nlohmann::json> found;
        for (const auto& layer : frames.at(frame).at("layers")) {
            if (layer.at("type") == type) { found.push_back(layer); }
        }
        return found;
    }
    // What hangs in the room, by how it is drawn: the panel is the largest picture, rays are thin.
    [[nodiscard]] std::vector<nlohmann::json> panels(std::size_t frame) const {
        return quadsWhere(frame, [](const nlohmann::json& quad) { return quad.at("views").at(0).at("rect").at(3) > 256; });
    }
    [[nodiscard]] std::vector<nlohmann::json> rays(std::size_t frame) const {
        return quadsWhere(frame, [](const nlohmann::json& quad) { return quad.at("size").at(0) < 0.01; });
    }
    template <typename Condition>
    [[nodiscard]] std::vector<nlohmann::json> quadsWhere(std::size_t frame, const Condition& condition) const {
        std::vector<nlohmann::json> found;
        for (const auto& quad : layers(frame, "quad")) {
            if (condition(quad)) { found.push_back(quad); }
        }
        return found;
    }
};

// `arguments` after the scene; a script of these lines drives the headset. The run is over after `seconds` at the latest.
inline ViewRun runView(const Workplace& work, const std::string& name, const std::string& script, const std::string& arguments,
                       const std::string& environment = kValidated) {
    std::ofstream(work.path / (name + ".script")) << script;
    ViewRun run;
    run.out = work.path / name;
    run.outcome = work.run(fmt::format("view {0} --simulate {1}.script --out {1}", arguments, name), environment);
    std::ifstream log(run.out / "frames.jsonl");
    for (std::string line; std::getline(log, line);) {
        nlohmann::json json = nlohmann::json::parse(line);
        (json.contains("frame") ? run.frames : run.between).push_back(std::move(json));
    }
    return run;
}

// For the arguments: the panel opens with the page of methods.
inline std::string withMethodPage(const Workplace& work) {
    std::ofstream(work.path / "method.toml") << "[view]\npanel-page = \"method\"\n";
    return " --config method.toml";
}

// It ended well and no validation layer said a word.
inline void checkClean(const ViewRun& run) {
    INFO("stdout: " << run.outcome.output);
    INFO("stderr: " << run.outcome.errors);
    CHECK(run.outcome.exit_code == 0);
    CHECK(run.outcome.errors == "Core Validation output type: text, first time = true\n");  // the layer was there, and nothing else
    CHECK(run.outcome.output.find("VUID") == std::string::npos);
    CHECK(run.outcome.output.find("ERROR") == std::string::npos);
}

}  // namespace binosplat::test
