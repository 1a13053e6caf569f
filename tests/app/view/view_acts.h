// A wearer of the simulated headset who does one thing after another.
#pragma once

#include "app/view/scenes/viewpoints.h"
#include "tests/app/view/panel/panel_sketch.h"
#include "tests/app/view/view_runs.h"

namespace binosplat::test {

// Where the viewer's panel hangs, in STAGE and OpenXR's axes: its middle, in front of a head that looks along
// -z, as docs/simulated_script.md describes.
inline Pose panelBefore(const glm::dvec3& head = {0.0, 1.6, 0.0}) {
    const glm::dvec3 to_head(0.45, 0.1, 0.9), out = glm::normalize(to_head);
    const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0.0, 1.0, 0.0), out));
    return {glm::quat_cast(glm::dmat3(right, glm::cross(out, right), out)), head - to_head};
}
inline Pose panelOf(const ViewRun& run, std::size_t frame) { return stagePose(run.panels(frame).at(0)); }
inline const glm::dvec2 kPanelMetres(0.468, 0.585);

// Clear of all widgets on the pages View and Method.
inline const glm::dvec2 kBeside(0.9, 0.95);

// Poses of hands: one looks at a place, the other points at one on the panel from 30 cm before it.
inline std::string lookingAt(const glm::dvec3& at, const glm::dvec3& look) {
    return fmt::format("position {} {} {} look {} {} {}", at.x, at.y, at.z, look.x, look.y, look.z);
}
inline std::string pointingAt(const Pose& panel, const glm::dvec2& share) {
    const glm::dvec3 at =
        transform(panel, {(share.x - 0.5) * kPanelMetres.x, (0.5 - share.y) * kPanelMetres.y, 0.3});
    const glm::dquat& q = panel.orientation;
    return fmt::format("position {:.6f} {:.6f} {:.6f} rotation {:.6f} {:.6f} {:.6f} {:.6f}", at.x, at.y, at.z,
                       q.x, q.y, q.z, q.w);
}
// Pointing at the floor.
inline const std::string kLeftDown = "position -0.2 1.2 -0.35 turn 0 -80",
                         kRightDown = "position 0.2 1.2 -0.35 turn 0 -80";

// Builds a script, act by act. The left hand points at the floor.
class Acts {
public:
    explicit Acts(const std::string& begin, const glm::dvec3& head = {0.0, 1.6, 0.0})
        : panel(panelBefore(head)),
          text_(begin),
          poses_{{"head", fmt::format("position {} {} {} turn 0 0", head.x, head.y, head.z)},
                 {"controller left", kLeftDown},
                 {"controller right", "position 0.2 1.2 -0.35 turn 0 0"}} {
        for (const auto& [who, pose] : poses_) { text_ += fmt::format("{} 0 {}\n", who, pose); }
    }

    double now_s = 0.2;  // the session has the input
    Pose panel;

    Acts& wait(double seconds) {
        now_s += seconds;
        return *this;
    }
    // Nothing else happens for this long; returns the time at which it begins.
    double look(double seconds = 0.1) {
        const double begin_s = now_s;
        now_s += seconds;
        return begin_s;
    }
    Acts& at(const std::string& event) {
        text_ += fmt::format("at {:.3f} {}\n", now_s, event);
        return *this;
    }
    // Of "head", "controller left" or "controller right".
    Acts& move(const std::string& who, const std::string& pose, double seconds = 0.02) {
        text_ +=
            fmt::format("{0} {1:.3f} {2}\n{0} {3:.3f} {4}\n", who, now_s, poses_[who], now_s + seconds, pose);
        poses_[who] = pose;
        return wait(seconds + 0.001);
    }
    Acts& head(const std::string& pose, double time_s = 0.02) { return move("head", pose, time_s); }
    Acts& left(const std::string& to, double time_s = 0.02) { return move("controller left", to, time_s); }
    Acts& right(const std::string& to, double time_s = 0.02) { return move("controller right", to, time_s); }
    // These three go on while time passes. Inputs are named as "right trigger" or "left thumbstick".
    Acts& hold(const std::string& input, double seconds) {
        text_ += fmt::format("press {} {:.3f} {:.3f}\n", input, now_s, now_s + seconds);
        return *this;
    }
    Acts& push(const std::string& stick, const glm::dvec2& to, double seconds) {
        for (const auto& [time_s, place] :
             {std::pair(0.0, glm::dvec2(0.0)), std::pair(0.01, to), std::pair(seconds, to),
              std::pair(seconds + 0.01, glm::dvec2(0.0))}) {
            text_ += fmt::format("axis {} {:.3f} {} {}\n", stick, now_s + time_s, place.x, place.y);
        }
        return *this;
    }
    Acts& pull(const std::string& input, const std::vector<std::pair<double, double>>& values) {
        for (const auto& [time_s, value] : values) {
            text_ += fmt::format("axis {} {:.3f} {}\n", input, now_s + time_s, value);
        }
        return *this;
    }
    Acts& press(const std::string& input, double seconds = 0.05) {
        return hold(input, seconds).wait(2.0 * seconds);
    }
    // Points the right hand at a place on the panel.
    Acts& point(const glm::dvec2& share) { return right(pointingAt(panel, share)).wait(0.03); }
    Acts& click(const glm::dvec2& share, const std::string& input = "right trigger") {
        return point(share).press(input);
    }

    // The whole script, with the wearer leaving now.
    [[nodiscard]] std::string script() const { return text_ + fmt::format("at {:.3f} exit\n", now_s); }
    operator std::string() const { return script(); }

private:
    std::string text_;
    std::map<std::string, std::string> poses_;
};

// Compares both eyes of a frame with what `binosplat render` makes of the fence from the head's logged pose.
// The wearer stood at `start` in the scene, looking along its z, when the head was at (0, 1.6, 0).
inline void checkAgreesWithRender(const Workplace& work, const ViewRun& run, std::size_t frame,
                                  const glm::dvec3& start, const std::string& arguments) {
    CAPTURE(frame);
    const Pose head = poseOf(run.frames.at(frame).at("head"));
    const glm::dvec3 eye = start + inScene(head.position - glm::dvec3(0.0, 1.6, 0.0)),
                     look = eye + inScene(head.orientation * glm::dvec3(0, 0, -1)),
                     up = inScene(head.orientation * glm::dvec3(0, 1, 0));
    work.go("render builtin:fence --order distance --out expected " + arguments + viewedFrom(eye, look, up));
    for (const int side : {kLeft, kRight}) {
        CAPTURE(side);
        const Image expected =
            readPicture(work.path / "expected" / (side == kLeft ? "left.png" : "right.png"));
        CHECK(compare(run.eye(frame, side), expected).psnrDb() > 50.0);
        // It must not agree for the other eye.
        CHECK(compare(run.eye(frame, 1 - side), expected).psnrDb() < 30.0);
    }
}

// Few splats, for tests that are content with any picture.
inline const std::string kWall = "builtin:slanted-wall --load-first --hide-hands",
                         kOneSplat = "builtin:one-splat --load-first --hide-hands";

// Where the wearer was when *Keep this one* was clicked, in the axes of the only scene with kept places.
inline std::vector<View> keptPlaces(const Workplace& work) {
    std::vector<View> kept;
    for (const auto& file : fs::directory_iterator(work.base / "config/binosplat/scenes")) {
        if (!file.path().string().ends_with(".viewpoints.json")) { continue; }
        for (const Viewpoint& viewpoint : readViewpoints(file)) { kept.push_back(viewpoint.view); }
    }
    return kept;
}

}  // namespace binosplat::test
