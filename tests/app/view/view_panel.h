// Where the viewer's panel hangs, and hands that click on it.
#pragma once

#include "engine/geometry.h"
#include "tests/app/view/view_runs.h"

namespace binosplat::test {

// Where the panel hangs, as the runtime was told, in STAGE and OpenXR's axes.
struct Panel {
    glm::dvec3 middle;
    glm::dquat orientation;
    glm::dvec2 size_m;
};

inline Panel panelOf(const ViewRun& run, std::size_t frame) {
    const nlohmann::json quad = run.layers(frame, "quad").at(0);
    const auto p = quad.at("pose").at("position").get<std::array<double, 3>>();
    const auto q = quad.at("pose").at("orientation").get<std::array<double, 4>>();
    const auto size = quad.at("size").get<std::array<double, 2>>();
    return {{p[0], p[1] + 1.6, p[2]}, {q[3], q[0], q[1], q[2]}, {size[0], size[1]}};
}

// A line that puts the right hand 30 cm before a place of the panel, pointing straight at it.
inline std::string pointAt(const Panel& panel, const glm::dvec2& share, double time_s, const std::string& hand = "right") {
    const glm::dvec3 on_panel((share.x - 0.5) * panel.size_m.x, (0.5 - share.y) * panel.size_m.y, 0.3);
    const glm::dvec3 at = panel.middle + panel.orientation * on_panel;
    const glm::dquat& q = panel.orientation;
    return fmt::format("controller {} {:.6f} position {:.6f} {:.6f} {:.6f} rotation {:.6f} {:.6f} {:.6f} {:.6f}\n", hand, time_s, at.x,
                       at.y, at.z, q.x, q.y, q.z, q.w);
}

// The right hand points at a place and clicks there once: within 0.15 s, or so many times as long, for frames that may be late.
inline std::string clickAt(const Panel& panel, const glm::dvec2& place, double time_s, double slower = 1.0) {
    return pointAt(panel, place, time_s) + pointAt(panel, place, time_s + 0.15 * slower) +
           fmt::format("press right trigger {} {}\n", time_s + 0.05 * slower, time_s + 0.1 * slower);
}

// Points at one place after the other, a fifth of a second each, and clicks there with the right hand's `input`.
inline std::string clickOn(const Panel& panel, const std::vector<glm::dvec2>& places, const std::string& input = "trigger") {
    std::string script;
    double time_s = 0.2;
    for (const glm::dvec2& place : places) {
        script += pointAt(panel, place, time_s) + pointAt(panel, place, time_s + 0.15);
        script += fmt::format("press right {} {} {}\n", input, time_s + 0.05, time_s + 0.1);
        time_s += 0.2;
    }
    return script + fmt::format("at {} exit\n", time_s);
}

// What *Save* wrote of the scene: the numbers of a key.
inline nlohmann::json savedNumbers(const ViewRun& run, const std::string& key) {
    const std::string& output = run.outcome.output;
    const std::size_t at = output.rfind("saved as ");
    REQUIRE(at != std::string::npos);
    std::ifstream file(output.substr(at + 9, output.find('\n', at) - at - 9));
    const std::string saved(std::istreambuf_iterator<char>(file), {});
    const std::size_t begin = saved.find(key + " = ");
    INFO(key << " in " << saved);
    REQUIRE(begin != std::string::npos);
    return nlohmann::json::parse(saved.substr(begin + key.size() + 3, saved.find('\n', begin) - begin - key.size() - 3));
}

}  // namespace binosplat::test
