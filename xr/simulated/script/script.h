// The state of the simulated headset: poses, angles, controllers and misbehaviour, a pure function of display
// time that is read from a text file. docs/simulated_script.md has the commands.
#pragma once

#include "xr/simulated/compose/geometry.h"
#include "xr/simulated/script/script_gaze.h"
#include "xr/simulated/script/track.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace simulated {

// One line: file:line: what is wrong, what was expected.
class ScriptError : public std::runtime_error {
public:
    explicit ScriptError(std::string message) : std::runtime_error(oneLine(std::move(message))) {}

private:
    // Quoted text comes from a file and may hold anything.
    static std::string oneLine(std::string message) {
        for (char& letter : message) {
            if (static_cast<unsigned char>(letter) < ' ') { letter = ' '; }
        }
        return message;
    }
};

// A controller at a given time.
struct ControllerState {
    bool tracked = true;  // else poses are neither valid nor tracked and all inputs rest
    Pose stage_from_grip;
    Pose stage_from_aim;
    // By the part of a binding path after /input/: "trigger/value", "thumbstick/x", "a/click",
    // "squeeze/force" ... An input that is not here rests at 0. Booleans are 0 or 1; a trigger or squeeze
    // clicks from 0.9 on and counts as touched above 0.
    std::map<std::string, double, std::less<>> inputs;

    [[nodiscard]] double input(std::string_view identifier_and_component) const;
};

// Anything with inputs; the hands by Side.
enum InputDevice : std::size_t { kLeftHand = 0, kRightHand = 1, kHead = 2, kGamepad = 3, kGaze = 4 };
inline constexpr std::size_t kDevices = 5;

struct EyeState {
    Pose stage_from_eye;
    Fov fov;
};

// All that is a function of the display time.
struct State {
    double time_s = 0.0;
    Pose stage_from_head;
    std::array<EyeState, 2> eyes;                          // by Side
    std::array<ControllerState, 2> controllers;            // by Side
    bool head_turn_known = true, head_place_known = true;  // whether the head is tracked
    // The head's buttons are at rest, unless a program's own test moves them (XR_EXT_conformance_automation).
    // A gamepad is there if such a test or the script moves it. The gaze is the aim pose of the last one.
    std::array<ControllerState, 3> others;
    bool gaze_is_good = true;  // else it is not to be relied on
    // By InputDevice.
    [[nodiscard]] ControllerState& device(std::size_t index) {
        return index < 2 ? controllers[index] : others[index - 2];
    }
    [[nodiscard]] const ControllerState& device(std::size_t index) const {
        return index < 2 ? controllers[index] : others[index - 2];
    }
    bool should_render = true;
    bool worn = true;     // else the session stops, and is IDLE until the headset is put on again
    bool visible = true;  // else the session is at most SYNCHRONIZED
    bool focused = true;  // else the session is at most VISIBLE
    bool present = true;  // whether somebody wears the headset
};

// An event that happens once, when the display time first reaches `time_s`.
struct ScriptEvent {
    enum class Kind {
        kRate,  // the display shows `value` frames per second
        // The next `count` xrWaitSwapchainImage calls with a finite timeout return XR_TIMEOUT_EXPIRED.
        kSlowImages,
        kRecentre,      // kNoticeSeconds later LOCAL's origin is where the head is then
        kLoseSession,   // LOSS_PENDING, then XR_ERROR_SESSION_LOST from every call
        kLoseInstance,  // XrEventDataInstanceLossPending, then XR_ERROR_INSTANCE_LOST
        kExit,          // STOPPING, then EXITING, as if the wearer left the program
    };
    static constexpr double kNoticeSeconds = 0.05;
    double time_s = 0.0;
    Kind kind = Kind::kExit;
    std::uint32_t count = 1;
    double value = 0.0;
};
[[nodiscard]] const char* nameOf(ScriptEvent::Kind kind);  // the script's word for it

// How long the GPU takes for a frame.
struct GpuLoad {
    enum class Unit { kShareOfPeriod, kMs, kMsPerMegapixel } unit = Unit::kMs;
    double amount = 0.0;

    [[nodiscard]] double ms(double period_ms, double megapixels) const {
        return amount * (unit == Unit::kShareOfPeriod    ? period_ms
                         : unit == Unit::kMsPerMegapixel ? megapixels
                                                         : 1.0);
    }
};

// The frames whose composed pictures are written; frames count from 0 at the first xrEndFrame.
struct FrameChoice {
    std::uint64_t first = 0;
    std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
    std::uint64_t every = 1;

    [[nodiscard]] bool contains(std::uint64_t frame) const {
        return frame >= first && frame <= last && (frame - first) % every == 0;
    }
};

// A foveated inset (XR_VARJO_quad_views): a small picture around the gaze, over a coarser one of the eye's
// whole view, the context.
struct InsetScript {
    double half_angle_rad = 20.0 * std::numbers::pi / 180.0;
    // The recommended sizes; none: as many pixels per degree as `size`, and half of `size`.
    std::optional<glm::uvec2> size_px, context_px;
    // Where the program asks for insets that follow the gaze; none: the same.
    std::optional<glm::uvec2> moving_px;
};

struct Script {
    // The headset without a script: the head at rest at (0, 1.6, 0) looking along -z, eyes 0.063 m apart with
    // 90 degree views, controllers held in front, 90 Hz, 1024 x 1024, no mask, every frame written.
    Script();

    // `name` is for messages, and files that the script names are found relative to its folder. Throws
    // ScriptError.
    static Script parse(std::string_view text, const std::string& name);
    static Script load(const std::filesystem::path& path);

    // Times are seconds of display time since the first frame; any finite time is allowed, even before 0.
    [[nodiscard]] State at(double time_s) const;
    // Events with from_s < time <= to_s, in order; pass -infinity as `from_s` for the first frame.
    [[nodiscard]] std::vector<ScriptEvent> eventsIn(double from_s, double to_s) const;
    // LOCAL's origin is the head at time 0 without tilt, or where the script says, or the head at the last
    // recentring before `time_s`. STAGE's is on the floor.
    [[nodiscard]] Pose stageFromLocal(double time_s = 0.0) const;
    // LOCAL's, brought down to the floor.
    [[nodiscard]] Pose stageFromLocalFloor(double time_s = 0.0) const;
    // The angles of an eye's inset: about the gaze, or about the lens's middle if it does not follow that or
    // it is not known reliably.
    [[nodiscard]] Fov findInset(const State& state, Side side, bool follows_gaze) const;
    [[nodiscard]] glm::uvec2 contextSizePx() const;
    [[nodiscard]] glm::uvec2 insetSizePx() const;

    [[nodiscard]] bool allowsExtension(std::string_view name) const { return !extensions_off.contains(name); }

    std::vector<std::string> notes;  // a sentence each on what was left out of files that it names
    double rate_hz = 90.0;
    bool rate_is_fixed = false;  // requests of programs are refused
    double irregularity = 0.0;   // of display times, as a share of the period
    // After a frame that missed displays, the stated period is as long as that took.
    bool stretches_period = false;
    std::uint32_t images = 3;  // of a swapchain
    enum class ImageOrder { kInTurn, kReversed, kShuffled } image_order = ImageOrder::kInTurn;
    bool changes_state_at_begin = false;  // session states change while a frame is open, not after its end
    glm::uvec2 size_px{1024, 1024};       // recommended, per eye
    double eye_distance_m = 0.063;
    std::array<double, 2> cant_rad{0.0, 0.0};
    // By Side; to the right of the eye's axis, and above it.
    std::array<glm::dvec2, 2> lens_centres_rad{glm::dvec2(0.0), glm::dvec2(0.0)};
    InsetScript inset;
    std::string system_name = "Simulated headset";  // or the headset file's name
    bool visibility_mask = false;                   // whether XR_KHR_visibility_mask gives triangles
    bool visibility_mask_is_broken = false;         // the function exists but aborts the program
    // The runtime adds a feature of its own to the application's device.
    bool adds_vulkan_features = false;
    bool has_stage = true;  // whether there is a reference space STAGE
    enum class Depth { kTaken, kNoImages, kNoLayers } depth = Depth::kTaken;
    std::uint32_t calls_without_headset = 0;  // number of xrGetSystem calls that find none
    std::uint32_t calls_after_loss = 0;       // the same, after each loss of a session
    std::optional<Pose> stage_from_local;
    std::vector<double> recentres_s;
    // in the order of OpenXR's numbers, which begin with 1
    enum class BlendMode { kOpaque, kAdditive, kAlphaBlend };
    std::vector<BlendMode> blend_modes{BlendMode::kOpaque};  // in order of preference
    // Shows where pictures do not cover it; sRGB-encoded.
    glm::dvec3 room_colour{0.5};
    bool passthrough = false;  // whether XR_FB_passthrough shows the room
    bool plugged = true;       // else there is a runtime, but no headset
    bool writes_pictures = true;
    FrameChoice frames;
    std::set<std::string, std::less<>> extensions_off;
    // "valve/index_controller": the controllers to play; none: whatever the program knows
    std::string profile;
    Steps<std::string> later_profiles;  // by time; none: still the first

    struct Hand {
        Track<Pose> stage_from_grip{Pose()};
        Pose grip_from_aim;
        Steps<bool> tracked{true};
        std::map<std::string, Track<glm::dvec2>, std::less<>> axes;  // trigger and squeeze use only x
        struct Press {
            std::string input;
            double from_s, to_s;  // from <= time < to
            bool touch_only;
        };
        std::vector<Press> presses;
        // Each input that moves, and the line that names it first.
        std::map<std::string, std::string> input_places;
        [[nodiscard]] bool isThere() const { return !input_places.empty(); }  // of a gamepad
    };
    Track<Pose> stage_from_head;
    GazeScript gaze;
    std::array<Hand, 2> hands;
    Hand gamepad;
    std::array<Steps<Fov>, 2> fovs;
    Steps<bool> should_render{true}, worn{true}, visible{true}, focused{true}, present{true},
        head_turn_known{true}, head_place_known{true};
    Steps<GpuLoad> gpu_load;
    std::vector<ScriptEvent> events;  // by time
};

}  // namespace simulated
