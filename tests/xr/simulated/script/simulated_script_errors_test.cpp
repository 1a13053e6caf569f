// Facts about scripts with mistakes: each is named with its file and line, and nothing crashes.
#include "xr/simulated/script/script.h"

#include <doctest/doctest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

TEST_SUITE_BEGIN("simulated_script_errors");

namespace simulated_script_errors_test {

using namespace simulated;

namespace {

std::string messageOf(const std::string& text, const std::string& name = "a.script") {
    try {
        (void)Script::parse(text, name);
    } catch (const ScriptError& error) { return error.what(); }
    return "accepted";
}

void refuses(const std::string& text, const std::string& part, const std::string& name = "a.script") {
    const std::string message = messageOf(text, name);
    INFO(text, " gives: ", message);
    CHECK(message.find(part) != std::string::npos);
    CHECK(message.find('\n') == std::string::npos);
}

struct Folder {
    std::filesystem::path path = std::filesystem::temp_directory_path() / ("binosplat_script_errors_" + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    void write(const std::string& name, const std::string& text) const { std::ofstream(path / name) << text; }
    void refuses(const std::string& text, const std::string& part) const {
        simulated_script_errors_test::refuses(text, part, (path / "a.script").string());
    }
};

const std::string kHeadset =
    "name = \"n\"\nsource = \"s\"\nsize = \"100x100\"\ncanting_deg = 0\neye_distance_m = 0.06\n"
    "[left]\nleft = -40\nright = 40\nup = 40\ndown = -40\n[right]\nleft = -40\nright = 40\nup = 40\ndown = -40\n";

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    return text.replace(text.find(what), what.size(), with);
}

}  // namespace

TEST_CASE("unknown commands are named with their line") {
    refuses("rate 90\n\n# so\nhed 0 position 0 0 0", "a.script:4: hed is not a command, must be one of: aim, at, axis");
    refuses("Rate 90", "a.script:1: Rate is not a command");
    refuses(std::string("ra\0te 90", 8), "ra?te is not a command");
    refuses(std::string(5000, 'x'), "xxx... is not a command");
}

TEST_CASE("missing numbers are said") {
    refuses("rate", "a.script:1: the rate in frames per second is missing, must be a number from 1 to 1000");
    refuses("\nsize 100", "a.script:2: the height in pixels is missing");
    refuses("head 0 position 1 2", "position z is missing");
    refuses("head 0 rotation 0 0 1", "rotation w is missing");
    refuses("eye left angles -40 40 40", "the angle down in degrees is missing");
    refuses("axis left thumbstick 0 1", "the axis upwards is missing");
    refuses("at 1 slow-images", "the number of slow images is missing");
}

TEST_CASE("numbers that are none are said") {
    for (const char* word : {"nan", "inf", "-inf", "1e999", "12x", "0x10", "1,5", "--1", "+-1", "1.2.3"}) {
        refuses(std::string("ipd ") + word, std::string("the eye distance in metres is ") + word + ", must be a number from 0 to 1");
    }
    refuses("head nan position 0 0 0", "the time in seconds is nan");
}

TEST_CASE("numbers out of range are refused") {
    refuses("rate 0", "must be a number from 1 to 1000");
    refuses("rate 1001", "must be a number from 1 to 1000");
    refuses("size 0 100", "the width in pixels is 0, must be a whole number from 1 to 16384");
    refuses("size 100 16385", "the height in pixels is 16385");
    refuses("size 99999999999999999999 100", "the width in pixels is 99999999999999999999");
    refuses("size 10.5 100", "the width in pixels is 10.5");
    refuses("size -1 100", "the width in pixels is -1");
    refuses("ipd -0.01", "the eye distance in metres is -0.01");
    refuses("head 1e7 position 0 0 0", "the time in seconds is 1e7");
    refuses("head 0 position 1e6 0 0", "position x is 1e6");
    refuses("axis left trigger 0 1.01", "the value is 1.01, must be a number from 0 to 1");
    refuses("axis left thumbstick 0 0 -1.5", "the axis upwards is -1.5");
}

TEST_CASE("angles must make a view") {
    refuses("eye left angles -90 40 40 -40", "the angle to the left in degrees is -90, must be a number from -85 to 85");
    refuses("eye left angles 40 40 40 -40", "the angles are 40 to the left and 40 to the right, left must be less");
    refuses("eye left angles -40 40 -40 40", "the angles are -40 up and 40 down, down must be less");
    refuses("eye left cant 46", "the turn outwards in degrees is 46");
    refuses("at 1 eye right angles -40 40 86 -40", "a.script:1: the angle up in degrees is 86");
}

TEST_CASE("a rotation of length zero is none") {
    refuses("head 0 rotation 0 0 0 0", "a.script:1: the rotation's length is 0, must be 1");
    refuses("controller left 0 rotation 0 1e-9 0 0", "the rotation's length is 1e-09");
}

TEST_CASE("times must increase") {
    refuses("head 1 position 0 0 0\nhead 0.5 position 0 0 0", "a.script:2: the time is 0.5, must be after the key before, at 1");
    refuses("head 1 position 0 0 0\nhead 1 position 0 0 0", "a.script:2: the time is 1, must be after");
    refuses("controller left 1 turn 0 0\ncontroller right 0 turn 0 0\ncontroller left 0 turn 0 0", "a.script:3: the time is 0");
    refuses("axis left trigger 1 0\naxis left trigger 1 1", "a.script:2: the time is 1");
    refuses("at 2 exit\nat 1 lose-session", "a.script:2: the time is 1, must not be before the `at` before, at 2");
    refuses("at 2 should-render off\nat 2 should-render on", "a.script:2: the time is 2, must be after the one of the same change");
    refuses("press left a 2 2", "it lasts from 2 to 2, must end after it begins");
}

TEST_CASE("choices are listed") {
    refuses("eye middle cant 5", "the side is middle, must be left or right");
    refuses("eye left", "what is set is missing, must be angles or cant");
    refuses("at 1 should-render maybe", "whether to render is maybe, must be on or off");
    refuses("at 1 head maybe", "whether it is tracked is maybe, must be on, off or turn-only");
    refuses("blend-modes see-through", "a blend mode is see-through, must be opaque, additive or alpha-blend");
    refuses("blend-modes opaque opaque", "a blend mode stands there twice, must be named once");
    refuses("room-colour 0 0 2", "the room's colour is 2, must be a number from 0 to 1");
    refuses("refuse-depth all", "what is refused is all, must be images or layers");
    refuses("visibility-mask perhaps", "whether there is a mask is perhaps, must be on, off or broken");
    refuses("local", "the pose is missing");
    refuses("no-headset-for 0", "the number of calls is 0, must be a whole number from 1");
    refuses("at 1 dance", "what happens is dance, must be should-render, visible, focused, slow-images");
    refuses("press left nose 0 1", "nose is not an input, must be one of: trigger, squeeze");
    refuses("axis left a 0 1",
            "a has no axis, must be trigger, squeeze, select, pinch_ext, aim_activate_ext, grasp_ext, thumbstick or trackpad");
    refuses("frames", "the frames are missing, must be all, none, every N, or from A to B");
    refuses("frames every 0", "how many frames apart is 0");
    refuses("frames from 5 to 4", "the last frame is 4, must be a whole number from 5");
    refuses("frames from 5", "the last frame is missing, must be from A to B");
    refuses("head 0", "the pose is missing, must be position X Y Z");
}

TEST_CASE("what is too much is refused") {
    refuses("rate 90 100", "a.script:1: unexpected 100 at the end of the line");
    refuses("head 0 position 0 0 0 sideways", "unexpected sideways at the end of the line");
    refuses("frames none at all", "unexpected at at the end of the line");
}

TEST_CASE("gazes with mistakes are refused") {
    refuses("eye-tracking maybe", "a.script:1: whether eyes are tracked is maybe, must be on, off or refused");
    refuses("eye-tracking on\neye-tracking on", "a.script:2: eye-tracking is set again, first on line 1");
    refuses("gaze 0 10", "a.script:1: the turn upwards in degrees is missing");
    refuses("gaze 0 91 0", "a.script:1: the turn to the left in degrees is 91, must be a number from -90 to 90");
    refuses("gaze 1 0 0\ngaze 1 5 5", "a.script:2: the time is 1, must be after the key before, at 1");
    refuses("at 1 gaze poor", "a.script:1: whether the gaze is tracked is poor, must be on, off or degraded");
    refuses("at 1 gaze off\nat 1 gaze on", "a.script:2: the time is 1, must be after the one of the same change before");
}

TEST_CASE("settings stand once") {
    refuses("rate 90\nsize 1 1\nrate 90", "a.script:3: rate is set again, first on line 1, must be set once");
    refuses("eye left cant 1\neye left cant 2", "eye left cant is set again");
    refuses("extension XR_KHR_visibility_mask off\nextension XR_KHR_visibility_mask off", "XR_KHR_visibility_mask is off already");
    CHECK(messageOf("eye left cant 1\neye right cant 2\neye left angles -1 1 1 -1") == "accepted");
}

TEST_CASE("extensions are those of the runtime and can only be turned off") {
    refuses("\nextension XR_KHR_visibilty_mask off",
            "a.script:2: XR_KHR_visibilty_mask is no extension of this runtime, must be one of: XR_KHR_vulkan_enable2, ");
    refuses("extension KHR_visibility_mask off", "KHR_visibility_mask is no extension of this runtime");
    refuses("extension XR_KHR_visibility_mask on", "what to do with it is on, must be off");
}

TEST_CASE("open quotes are refused") { refuses("headset \"a b.toml", "a.script:1: a quote is not closed"); }

TEST_CASE("files that cannot be read are said with the line that names them") {
    const Folder folder;
    folder.refuses("\nheadset none.toml", "a.script:2: ");
    folder.refuses("\nheadset none.toml", "none.toml: cannot be read (No such file or directory), must be a TOML file of a headset");
    folder.refuses("head-motion none.csv", "none.csv: cannot be read (No such file or directory), must be a CSV file of head motion");
    folder.refuses("headset .", "cannot be read (not a regular file)");
#ifndef _WIN32
    folder.refuses("head-motion /dev/zero", "/dev/zero: cannot be read (not a regular file)");
#endif
    folder.write("long.csv", std::string((std::size_t{16} << 20) + 1, '#'));
    folder.refuses("head-motion long.csv", "cannot be read (longer than 16 MiB)");
    folder.write("long.toml", std::string((std::size_t{4} << 20) + 1, '#'));
    folder.refuses("headset long.toml", "cannot be read (longer than 4 MiB)");
    folder.write("pointer.toml", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
    folder.refuses("headset pointer.toml", "pointer.toml: cannot be read (a Git LFS pointer, ");
    CHECK_THROWS_AS((void)Script::load(folder.path / "pointer.toml"), ScriptError);
    CHECK_THROWS_WITH_AS(
        (void)Script::load(folder.path / "none.script"),
        ((folder.path / "none.script").string() + ": cannot be read (No such file or directory), must be a script").c_str(), ScriptError);
    CHECK_THROWS_AS((void)Script::load("/dev/zero"), ScriptError);
}

TEST_CASE("insets with mistakes are refused") {
    refuses("inset", "half of the inset's angle in degrees is missing, must be a number from 1 to 85");
    refuses("inset 0.5", "half of the inset's angle in degrees is 0.5, must be a number from 1 to 85");
    refuses("inset 20 size 0 10", "the width in pixels is 0, must be a whole number from 1 to 16384");
    refuses("inset 20 context 10", "the height in pixels is missing");
    refuses("inset 20\ninset 10", "a.script:2: inset is set again, first on line 1");
    refuses("inset 20 10", "unexpected 10 at the end of the line");
}

TEST_CASE("a headset's inset is read, and its mistakes are named") {
    const Folder folder;
    const auto readWith = [&](const std::string& inset) {
        folder.write("h.toml", kHeadset + inset);
        return Script::parse("headset h.toml", (folder.path / "a.script").string());
    };
    const Script full = readWith("[inset]\nhalf_angle_deg = 15\nsize = \"60x50\"\ncontext_size = \"40x30\"\n");
    CHECK(full.inset.half_angle_rad == doctest::Approx(0.2617994));
    CHECK(full.insetSizePx() == glm::uvec2(60, 50));
    CHECK(full.contextSizePx() == glm::uvec2(40, 30));
    CHECK(readWith("[inset]\nhalf_angle_deg = 15\n").contextSizePx() == glm::uvec2(50, 50));
    CHECK(readWith("").inset.half_angle_rad == doctest::Approx(0.3490659));
    const auto refusesInset = [&](const std::string& inset, const std::string& part) {
        folder.write("h.toml", kHeadset + inset);
        folder.refuses("headset h.toml", part);
    };
    refusesInset("[inset]\nhalf_angle_deg = 90\n", "h.toml:17: inset.half_angle_deg is 90, must be a number from 1 to 85");
    refusesInset("[inset]\nsize = \"60x50\"\n", "inset.half_angle_deg is missing, must be given");
    refusesInset("[inset]\nhalf_angle_deg = 9\nsize = \"60\"\n", "h.toml:18: inset.size is 60, must be WxH");
    refusesInset("[inset]\nhalf_angle = 9\n", "inset.half_angle is not a key of a headset");
    folder.write("h.toml", kHeadset);
    folder.refuses("inset 20\nheadset h.toml", "a.script:2: headset sets inset, too, must stand before it");
}

TEST_CASE("a headset stands before what changes it") {
    const Folder folder;
    folder.write("h.toml", kHeadset);
    folder.refuses("ipd 0.06\nheadset h.toml", "a.script:2: headset sets ipd, too, must stand before it");
    folder.refuses("headset h.toml\nipd 0.06", "accepted");
}

TEST_CASE("headset files with mistakes are refused with their own line") {
    const Folder folder;
    const auto refusesHeadset = [&](const std::string& text, const std::string& part) {
        folder.write("h.toml", text);
        folder.refuses("headset h.toml", part);
    };
    refusesHeadset("name = \"n", "h.toml:1: ");
    refusesHeadset(replaced(kHeadset, "size = \"100x100\"\n", ""), "size is missing, must be given");
    refusesHeadset(replaced(kHeadset, "100x100", "100*100"), "h.toml:3: size is 100*100, must be WxH with 1 to 16384 per side");
    refusesHeadset(replaced(kHeadset, "100x100", "100x0"), "h.toml:3: size is 100x0");
    refusesHeadset(replaced(kHeadset, "0.06", "nan"), "h.toml:5: eye_distance_m is nan, must be a number from 0 to 1");
    refusesHeadset(replaced(kHeadset, "left = -40", "left = 50"), "h.toml:6: left.left must be less than left.right");
    refusesHeadset(replaced(kHeadset, "up = 40", "up = \"high\""), "h.toml:9: left.up is high, must be a number from -85 to 85");
    refusesHeadset(replaced(kHeadset, "[right]", "[middle]"), "middle is not a key of a headset");
    refusesHeadset(kHeadset + "\xc3\xa9 = 1\n", "h.toml:16: a letter that is neither ASCII nor in quotes nor in a comment");
    refusesHeadset(kHeadset + "a = 2\"\xc3\xa9\"\n", "h.toml:16: quotes within a word, must be around it");
    refusesHeadset(kHeadset + "a = \"\"\"b\"\"\"\n", "h.toml:16: a text over several lines, must be on one");
    refusesHeadset(kHeadset + "a = " + std::string(65, '.') + "\n", "h.toml:16: a key of more than 64 parts");
    refusesHeadset(replaced(kHeadset, "canting_deg", "kanting"), "h.toml:4: kanting is not a key of a headset, must be name, source");
}

TEST_CASE("recordings with mistakes are refused with their own line") {
    const Folder folder;
    const auto refusesMotion = [&](const std::string& text, const std::string& part) {
        folder.write("m.csv", text);
        folder.refuses("head-motion m.csv", part);
    };
    refusesMotion("", "m.csv: holds no poses");
    refusesMotion("time,x,y,z,qx,qy,qz,qw\n", "m.csv: holds no poses");
    refusesMotion("0,0,0,0,0,0,1\n", "m.csv:1: 7 columns, must be 8");
    refusesMotion("0,0,0,0,0,0,0,1\n0,0,0,0,0,0,0,1\n", "m.csv:2: time is 0, must be after the pose before");
    refusesMotion("0,0,0,0,0,0,0,0\n", "m.csv:1: the orientation's length is 0, must be 1");
    refusesMotion("0,nan,0,0,0,0,0,1\n", "m.csv:1: x is nan, must be a finite number");
    refusesMotion("0,0,0,0,0,0,,1\n", "m.csv:1: qz is empty");
    refusesMotion("5e12,0,0,0,0,0,0,1\n", "m.csv:1: time is 5e12, must be seconds");
    folder.write("m.csv", "0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,1\n");
    folder.refuses("head-motion m.csv skip 2", "a.script:1: the seconds to skip are 2, must be at most 1, the recording's length");
    folder.refuses("head-motion m.csv axes opengl", "the axes is opengl, must be openxr or unity");
    folder.refuses("head-motion m.csv\nhead 0 turn 0 0\nhead 1 turn 0 0", "a.script:3: the head has a recorded motion");
    folder.refuses("head 0 turn 0 0\nhead 1 turn 0 0\nhead-motion m.csv", "a.script:3: the head has keys on more than one line");
}

TEST_CASE("a script cut off anywhere is a script or an error") {
    std::ifstream stream(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/simulated/walk.script");
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    text += "headset \"none such.toml\"\nvisibility-mask on\naim left turn 5 5\nat 5 eye left angles -1 1 1 -1\nat 6 controller left off\n";
    REQUIRE(text.size() > 900);
    std::size_t accepted = 0, refused = 0;
    for (std::size_t length = 0; length <= text.size(); ++length) {
        const std::string message = messageOf(text.substr(0, length));
        ++(message == "accepted" ? accepted : refused);
        if (message != "accepted") { CHECK(message.starts_with("a.script:")); }
    }
    // Cut at the ends of lines it is a shorter script, within most words it is none.
    CHECK(accepted > 20);
    CHECK(refused > 200);
}

TEST_CASE("inputs that the controllers lack are named with their line") {
    refuses("profile valve/index\n", "a.script:1: valve/index is not a profile of controllers, must be one of: oculus/touch_controller, ");
    refuses("profile htc/vive_pro\n", "htc/vive_pro is not a profile of controllers");
    refuses("press left a 0 1\nprofile oculus/touch_controller\n",
            "a.script:1: the left hand of oculus/touch_controller has no a, must be one of: trigger, squeeze, thumbstick, x, y, menu, "
            "thumbrest");
    refuses("profile khr/simple_controller\npress right select 0 1\naxis right trigger 0 1\n",
            "a.script:3: the right hand of khr/simple_controller has no trigger, must be one of: menu, select");
    refuses("profile valve/index_controller\nprofile valve/index_controller", "profile is set again");
    CHECK(messageOf("profile valve/index_controller\npress left a 0 1\naxis right trackpad 0 1 1\n") == "accepted");
    CHECK(messageOf("press left a 0 1\npress left menu 0 1\n") == "accepted");
    refuses("at 1 profile valve/index\n", "a.script:1: valve/index is not a profile of controllers");
    // Any of those that it has in turn may have them.
    const std::string simple_first = "profile khr/simple_controller\nat 1 profile valve/index_controller\n";
    CHECK(messageOf(simple_first + "press left a 0 1\npress left select 0 1\n") == "accepted");
    refuses(simple_first + "press left x 0 1\n", "a.script:3: the left hand of khr/simple_controller has no x");
}

TEST_CASE("a head cannot look at itself") {
    refuses("head 0 position 1 2 3 look 1 2 3", "a.script:1: the point to look at is where it looks from");
    refuses("head 0 look 1 2", "position z is missing");
}

TEST_CASE("a script with any byte changed is a script or an error") {
    std::ifstream stream(std::string(BINOSPLAT_SOURCE_DIR) + "/configs/simulated/walk.script");
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    std::size_t refused = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        for (const char byte : {'\0', '\n', '"', '#', '-', '9', '\xff'}) {
            std::string changed = text;
            changed[i] = byte;
            const std::string message = messageOf(changed);
            if (message == "accepted") { continue; }
            ++refused;
            if (!message.starts_with("a.script:")) { FAIL_CHECK(message); }
        }
    }
    CHECK(refused > 1000);
}

TEST_CASE("headsets and recordings cut off anywhere are read or refused") {
    const Folder folder;
    const std::string motion = "time_ms,x,y,z,qw,qx,qy,qz\n0,1,2,3,1,0,0,0\n16.5,1e-1,-2,3,0.70710678,0,0.70710678,0\n";
    for (const auto& [command, whole] : {std::pair("headset", kHeadset), std::pair("head-motion", motion)}) {
        std::size_t refused = 0;
        for (std::size_t length = 0; length <= whole.size(); ++length) {
            folder.write("cut", whole.substr(0, length));
            const std::string message = messageOf(std::string(command) + " cut", (folder.path / "a.script").string());
            if (message == "accepted") { continue; }
            ++refused;
            if (message.find((folder.path / "cut").string()) == std::string::npos) { FAIL_CHECK(message); }
        }
        CHECK(refused > 40);
        CHECK(messageOf(std::string(command) + " cut", (folder.path / "a.script").string()) == "accepted");
    }
}

}  // namespace simulated_script_errors_test
