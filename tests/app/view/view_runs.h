// Runs `binosplat view` in the simulated headset, and reads what its wearer saw and what the runtime logged.
#pragma once

#include "app/scores/metrics.h"
#include "engine/picture/image_io.h"
#include "engine/similarity.h"
#include "tests/engine/picture/pictures.h"
#include "tests/run_program.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace binosplat::test {

// With settings of the test's own, under Vulkan's validation layers, and without a window.
inline const std::string kAlone =
    "XDG_CONFIG_HOME=\"$PWD/../config\" DISPLAY= WAYLAND_DISPLAY= BINOSPLAT_VALIDATION=1";
// Under those of OpenXR as well; both must stay silent.
inline const std::string kValidated = kAlone +
                                      " XR_ENABLE_API_LAYERS=XR_APILAYER_LUNARG_core_validation "
                                      "XR_CORE_VALIDATION_EXPORT_TYPE=text";

// The same on a device, or in a headset, that fails as `faults` says (tests/faults).
inline std::string withFaults(const std::string& faults, const std::string& environment = kValidated) {
    return environment +
           " VK_ADD_LAYER_PATH='" BINOSPLAT_FAULT_LAYER "' VK_INSTANCE_LAYERS=VK_LAYER_BINOSPLAT_faults " +
           faults;
}
inline std::string withXrFaults(const std::string& faults, const std::string& environment = kAlone) {
    return environment +
           " XR_ENABLE_API_LAYERS=XR_APILAYER_BINOSPLAT_faults XR_API_LAYER_PATH='" BINOSPLAT_FAULT_LAYER
           "/openxr' " +
           faults;
}

// Saved pictures go into a folder of the workplace.
inline void picturesInto(const Workplace& work) {
    fs::create_directories(work.base / "config");
    std::ofstream(work.base / "config" / "user-dirs.dirs")
        << fmt::format("XDG_PICTURES_DIR=\"{}/pictures\"\n", work.path.string());
}

// A pose from the log, in OpenXR's axes.
inline Pose poseOf(const nlohmann::json& pose) {
    const auto p = pose.at("position").get<std::array<double, 3>>();
    const auto q = pose.at("orientation").get<std::array<double, 4>>();
    return {{q[3], q[0], q[1], q[2]}, {p[0], p[1], p[2]}};
}
// Where a picture hangs, in STAGE.
inline Pose stagePose(const nlohmann::json& quad) {
    return compose(poseOf(quad.at("stage_from_space")), poseOf(quad.at("pose")));
}

inline Image partOf(const Image& picture, glm::uvec2 from, glm::uvec2 to) {
    Image part{to - from, picture.channels, {}};
    for (std::uint32_t y = from.y; y < to.y; ++y) {
        const auto row = picture.values.begin() + picture.channels * std::int64_t{y} * picture.size_px.x;
        part.values.insert(part.values.end(), row + picture.channels * from.x, row + picture.channels * to.x);
    }
    return part;
}
// One side of a picture with both eyes side by side.
inline Image sideOf(const Image& both, int side) {
    const glm::uvec2 size(both.size_px.x / 2, both.size_px.y), from(static_cast<unsigned>(side) * size.x, 0);
    return partOf(both, from, from + size);
}

// Where an eye is in STAGE, and the tangents of its field of view.
struct LoggedEye : Pose {
    double left, right, up, down;
};
inline LoggedEye eyeFrom(const nlohmann::json& eye) {
    const auto tangent = [&](const char* name) { return std::tan(eye.at("fov").at(name).get<double>()); };
    return {poseOf(eye.at("pose")), tangent("left"), tangent("right"), tangent("up"), tangent("down")};
}

// The frame of a line such as "frame 12: help".
inline std::size_t frameOf(const std::string& line) {
    return std::stoul(line.substr(line.find("frame ") + 6));
}

struct ViewRun {
    Outcome outcome;
    fs::path out;
    std::vector<nlohmann::json> frames;   // from frames.jsonl
    std::vector<nlohmann::json> between;  // its lines without a frame

    [[nodiscard]] bool says(const std::string& words) const { return contains(outcome.output, words); }
    // The lines of the output that contain these words.
    [[nodiscard]] std::vector<std::string> lines(const std::string& words) const {
        std::vector<std::string> found = linesIn(outcome.output);
        std::erase_if(found, [&](const std::string& line) { return !contains(line, words); });
        return found;
    }
    // The first frame displayed this many seconds after the script began, or later.
    [[nodiscard]] std::size_t frameAt(double seconds) const {
        const auto found = std::ranges::find_if(
            frames, [&](const nlohmann::json& frame) { return secondsOf(frame) > seconds - 1e-4; });
        CAPTURE(seconds);
        REQUIRE(found != frames.end());
        return static_cast<std::size_t>(found - frames.begin());
    }
    [[nodiscard]] const nlohmann::json& at(double seconds) const { return frames.at(frameAt(seconds)); }
    // The same, among frames with pictures.
    [[nodiscard]] std::size_t pictureAt(double seconds) const {
        std::size_t frame = frameAt(seconds);
        while (frame < frames.size() && !frames[frame].contains("picture")) { ++frame; }
        REQUIRE(frame < frames.size());
        return frame;
    }
    [[nodiscard]] double endSeconds() const { return secondsOf(frames.back()); }
    static double secondsOf(const nlohmann::json& frame) {
        return 1e-9 * frame.at("display_time_ns").get<double>() - 1.0;
    }

    // What the eye saw in a frame.
    [[nodiscard]] Image eye(std::size_t frame, int side) const {
        return sideOf(readPicture(out / fmt::format("frame_{:06}.png", frame)), side);
    }
    // How similar two frames look to the left eye, in dB.
    [[nodiscard]] double likeness(std::size_t a, std::size_t b) const {
        return compare(eye(a, 0), eye(b, 0)).psnrDb();
    }
    [[nodiscard]] LoggedEye loggedEye(std::size_t frame, std::size_t side) const {
        return eyeFrom(frames.at(frame).at("eyes").at(side));
    }

    // The layers of one type in a frame.
    [[nodiscard]] std::vector<nlohmann::json> layers(std::size_t frame, const std::string& type) const {
        auto found = frames.at(frame).at("layers").get<std::vector<nlohmann::json>>();
        std::erase_if(found, [&](const nlohmann::json& layer) { return layer.at("type") != type; });
        return found;
    }
    // The scene's view for an eye.
    [[nodiscard]] nlohmann::json view(std::size_t frame, std::size_t side = 0) const {
        return layers(frame, "projection").at(0).at("views").at(side);
    }
    // The size of the part of the picture that the eye sees; the picture may be larger.
    [[nodiscard]] glm::ivec2 sizePx(std::size_t frame, std::size_t side) const {
        const nlohmann::json picture = view(frame, side), &rect = picture.at("rect");
        const LoggedEye seen = loggedEye(frame, side), drawn = eyeFrom(picture);
        const glm::dvec2 share((seen.right - seen.left) / (drawn.right - drawn.left),
                               (seen.up - seen.down) / (drawn.up - drawn.down));
        return glm::ivec2(glm::round(share * glm::dvec2(rect.at(2).get<double>(), rect.at(3).get<double>())));
    }
    [[nodiscard]] int width(std::size_t frame) const { return sizePx(frame, 0).x; }
    // Where the eyes' views are in the room.
    [[nodiscard]] glm::dvec3 viewPlace(std::size_t frame, std::size_t side) const {
        return poseOf(view(frame, side).at("pose")).position;
    }
    [[nodiscard]] std::int64_t periodNs(std::size_t frame) const {
        return frames.at(frame).at("period_ns").get<std::int64_t>();
    }
    // Things in the room, told apart by their size: the panel is the largest picture, and rays are thin.
    [[nodiscard]] std::vector<nlohmann::json> panels(std::size_t frame) const {
        return quadsWhere(
            frame, [](const nlohmann::json& quad) { return quad.at("views").at(0).at("rect").at(3) > 256; });
    }
    [[nodiscard]] std::vector<nlohmann::json> rays(std::size_t frame) const {
        return quadsWhere(frame, [](const nlohmann::json& quad) { return quad.at("size").at(0) < 0.01; });
    }
    // What moves with the head: messages, and the vignette.
    [[nodiscard]] std::vector<nlohmann::json> beforeEyes(std::size_t frame) const {
        return quadsWhere(frame, [](const nlohmann::json& quad) { return quad.at("space") == "VIEW"; });
    }
    // Those of this width in metres: hands, parts of controllers, the target of a teleport.
    [[nodiscard]] std::vector<nlohmann::json> quadsAsWide(std::size_t frame, double width_m) const {
        return quadsWhere(frame, [&](const nlohmann::json& quad) {
            return quad.at("space") != "VIEW" &&
                   std::abs(quad.at("size").at(0).get<double>() - width_m) < 1e-4;
        });
    }
    template <typename Condition>
    [[nodiscard]] std::vector<nlohmann::json> quadsWhere(std::size_t frame,
                                                         const Condition& condition) const {
        std::vector<nlohmann::json> found = layers(frame, "quad");
        std::erase_if(found, [&](const nlohmann::json& quad) { return !condition(quad); });
        return found;
    }
};

// Runs `view` with `arguments`, while a script with these lines drives the headset.
inline ViewRun runView(const Workplace& work, const std::string& name, const std::string& script,
                       const std::string& arguments, const std::string& environment = kValidated) {
    work.write(name + ".script", script);
    ViewRun run;
    run.out = work.path / name;
    run.outcome =
        work.run(fmt::format("view {0} --simulate {1}.script --out {1}", arguments, name), environment);
    for (const std::string& line : linesIn(textIn(run.out / "frames.jsonl"))) {
        nlohmann::json json = nlohmann::json::parse(line);
        (json.contains("frame") ? run.frames : run.between).push_back(std::move(json));
    }
    return run;
}

// Arguments for a place in a scene, and a direction of view.
inline std::string viewedFrom(const glm::dvec3& eye, const glm::dvec3& look, const glm::dvec3& up) {
    const auto text = [](const glm::dvec3& v) { return fmt::format("{:.9f},{:.9f},{:.9f}", v.x, v.y, v.z); };
    return fmt::format(" --eye {} --look {} --up {}", text(eye), text(look), text(up));
}
// From OpenXR's axes to the scene's.
inline glm::dvec3 inScene(const glm::dvec3& v) { return {v.x, -v.y, -v.z}; }

// An argument for a config with these lines.
inline std::string withConfig(const Workplace& work, const std::string& lines) {
    work.write("view.toml", lines);
    return " --config view.toml";
}
inline const std::string kMethodPage = "[view]\npanel-page = \"method\"\n",
                         kScenesPage = "[view]\npanel-page = \"scenes\"\n";

// A shader compiler in `folder`, which must come first in PATH: it takes unchanged shaders from the build,
// since 19 runs of the real one take seconds. For each shader, the shell lines `then` run afterwards; they
// can use its $name and its file, $last.
inline void writeCompilerOfChangedShaders(const fs::path& folder, const std::string& then = "") {
    fs::create_directory(folder);
    const fs::path compiler = folder / "glslangValidator";
    std::ofstream(compiler)
        << "#!/bin/sh\nfor word; do case $last in -o) out=$word ;; esac; last=$word; done\n"
           "name=$(basename $last .comp)\n"
           "if cmp -s $last '" BINOSPLAT_SOURCE_DIR "/shaders/'*/$name.comp; then cp '" BINOSPLAT_BUILD
           "/shaders/embedded/'$name.spv $out; else PATH=${PATH#*:} glslangValidator \"$@\"; fi\n"
           "status=$?\n" +
               then + "exit $status\n";
    fs::permissions(compiler, fs::perms::owner_all);
}

// What the viewer saved about the slanted wall.
inline fs::path wallSettings(const Workplace& work) {
    return work.base / "config/binosplat/scenes/slanted-wall.view.toml";
}
inline nlohmann::json savedOfWall(const Workplace& work, const std::string& key) {
    const std::string text = textIn(wallSettings(work));
    const std::size_t at = text.find(key + " = "), begin = at + key.size() + 3;
    REQUIRE(at != std::string::npos);
    return nlohmann::json::parse(text.substr(begin, text.find('\n', begin) - begin));
}
inline Similarity placementAtWall(const Workplace& work) {
    const auto p = savedOfWall(work, "scene-position").get<std::array<double, 3>>();
    const auto q = savedOfWall(work, "scene-orientation").get<std::array<double, 4>>();
    return {{q[0], q[1], q[2], q[3]}, {p[0], p[1], p[2]}, savedOfWall(work, "units-per-metre").get<double>()};
}

// The run succeeded and reported nothing: beside `errors`, what the layers themselves say.
inline void checkEnded(const ViewRun& run, const std::string& errors = "") {
    INFO("stdout: " << run.outcome.output);
    CHECK(these(run.outcome.exit_code, run.outcome.errors) == these(0, errors));
    CHECK(these(run.says("VUID"), run.says("ERROR")) == these(false, false));
}
// OpenXR's validation layer was loaded, too.
inline void checkClean(const ViewRun& run) {
    checkEnded(run, "Core Validation output type: text, first time = true\n");
}

// Into a folder of its own; it succeeds, with no more layers than a runtime must accept.
inline ViewRun runClean(const Workplace& work, const std::string& script, const std::string& arguments,
                        const std::string& environment = kValidated) {
    std::string name = "run";
    while (work.holds(name)) { name += '_'; }
    const ViewRun run = runView(work, name, script, arguments, environment);
    checkClean(run);
    for (const auto& frame : run.frames) { CHECK(frame.at("layers").size() <= 16); }
    return run;
}

// Something was visible in every frame.
inline void checkAlwaysShown(const ViewRun& run) {
    REQUIRE(run.frames.size() > 8);
    for (std::size_t frame = 4; frame + 4 < run.frames.size(); ++frame) {
        REQUIRE(run.layers(frame, "projection").size() == 1);
    }
}

// The run printed these in this order.
inline void checkOrder(const ViewRun& run, const std::vector<std::string>& said) {
    std::size_t from = 0;
    for (const std::string& words : said) {
        INFO(words << " in " << run.outcome.output);
        from = run.outcome.output.find(words, from);
        REQUIRE(from != std::string::npos);
        from += words.size();
    }
}

// For pictures of the same size; compares pixels at the same place.
template <typename Condition>
std::size_t countPixels(const Image& a, const Image& b, const Condition& condition) {
    std::size_t found = 0;
    for (std::size_t i = 0; i < a.pixelCount(); ++i) {
        const glm::uvec2 at(i % a.size_px.x, i / a.size_px.x);
        found += condition(colourOf(a, at.x, at.y), colourOf(b, at.x, at.y));
    }
    return found;
}

}  // namespace binosplat::test
