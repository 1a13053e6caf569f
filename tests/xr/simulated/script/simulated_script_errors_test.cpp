// Facts about scripts with mistakes: each is named with its file and line, and nothing crashes.
#include "tests/xr/simulated/folder.h"
#include "xr/simulated/script/script.h"

#include <initializer_list>

SUITE(simulated_script_errors) {

using namespace simulated;

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

// Scripts, and a part of what is said of each.
void refuseAll(std::initializer_list<std::pair<std::string, std::string>> mistakes) {
    for (const auto& [text, part] : mistakes) { refuses(text, part); }
}

struct ScriptFolder : Folder {
    [[nodiscard]] std::string messageOf(const std::string& text) const {
        return simulated_script_errors_suite::messageOf(text, (path / "a.script").string());
    }
    void refuses(const std::string& text, const std::string& part) const {
        simulated_script_errors_suite::refuses(text, part, (path / "a.script").string());
    }
    // A file with this text, as the script's line names it.
    void refusesFile(const std::string& line, const std::string& file, const std::string& text, const std::string& part) const {
        write(file, text);
        refuses(line + " " + file, part);
    }
    void refusesHeadset(const std::string& text, const std::string& part) const { refusesFile("headset", "h.toml", text, part); }
};

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    return text.replace(text.find(what), what.size(), with);
}

std::string walkScript() { return textIn(BINOSPLAT_SOURCE_DIR "/configs/simulated/walk.script"); }

// How many of such texts are refused, each with its file's name.
template <class Texts>
std::size_t countRefused(const Texts& texts) {
    std::size_t refused = 0;
    for (const std::string& text : texts) {
        const std::string message = messageOf(text);
        if (message == "accepted") { continue; }
        ++refused;
        if (!message.starts_with("a.script:")) { FAIL_CHECK(message); }
    }
    return refused;
}

TEST_CASE("what stands on no line, or too little or too much of it, is said with the line") {
    refuseAll({{"rate 90\n\n# so\nhed 0 position 0 0 0", "a.script:4: hed is not a command, must be one of: aim, at, axis"},
               {"Rate 90", "a.script:1: Rate is not a command"},
               {std::string("ra\0te 90", 8), "ra?te is not a command"},
               {std::string(5000, 'x'), "xxx... is not a command"},
               {"headset \"a b.toml", "a.script:1: a quote is not closed"},
               {"rate", "a.script:1: the rate in frames per second is missing, must be a number from 1 to 1000"},
               {"\nsize 100", "a.script:2: the height in pixels is missing"},
               {"head 0 position 1 2", "position z is missing"},
               {"head 0 look 1 2", "position z is missing"},
               {"head 0 rotation 0 0 1", "rotation w is missing"},
               {"eye left angles -40 40 40", "the angle down in degrees is missing"},
               {"axis left thumbstick 0 1", "the axis upwards is missing"},
               {"at 1 slow-images", "the number of slow images is missing"},
               {"inset", "half of the inset's angle in degrees is missing, must be a number from 1 to 85"},
               {"inset 20 context 10", "the height in pixels is missing"},
               {"gaze 0 10", "a.script:1: the turn upwards in degrees is missing"},
               {"at 1 gpu-load 70", "the load's unit is missing, must be %, ms or ms-per-megapixel"},
               {"rate 90 100", "a.script:1: unexpected 100 at the end of the line"},
               {"inset 20 10", "unexpected 10 at the end of the line"},
               {"head 0 position 0 0 0 sideways", "unexpected sideways at the end of the line"},
               {"frames none at all", "unexpected at at the end of the line"}});
}

TEST_CASE("numbers that are none, out of range, or make no view, rotation or look are refused") {
    for (const char* word : {"nan", "inf", "-inf", "1e999", "12x", "0x10", "1,5", "--1", "+-1", "1.2.3"}) {
        refuses(std::string("ipd ") + word, std::string("the eye distance in metres is ") + word + ", must be a number from 0 to 1");
    }
    refuseAll({{"head nan position 0 0 0", "the time in seconds is nan"},
               {"rate 0", "must be a number from 1 to 1000"},
               {"rate 1001", "must be a number from 1 to 1000"},
               {"at 1 rate 0", "the rate in frames per second is 0, must be a number from 1 to 1000"},
               {"size 0 100", "the width in pixels is 0, must be a whole number from 1 to 16384"},
               {"size 100 16385", "the height in pixels is 16385"},
               {"size 99999999999999999999 100", "the width in pixels is 99999999999999999999"},
               {"size 10.5 100", "the width in pixels is 10.5"},
               {"size -1 100", "the width in pixels is -1"},
               {"ipd -0.01", "the eye distance in metres is -0.01"},
               {"head 1e7 position 0 0 0", "the time in seconds is 1e7"},
               {"head 0 position 1e6 0 0", "position x is 1e6"},
               {"axis left trigger 0 1.01", "the value is 1.01, must be a number from 0 to 1"},
               {"axis left thumbstick 0 0 -1.5", "the axis upwards is -1.5"},
               {"room-colour 0 0 2", "the room's colour is 2, must be a number from 0 to 1"},
               {"no-headset-for 0", "the number of calls is 0, must be a whole number from 1"},
               {"frames every 0", "how many frames apart is 0"},
               {"images 0", "a.script:1: the number of images is 0, must be a whole number from 1 to 16"},
               {"irregular 91", "how much periods differ, in percent is 91, must be a number from 0 to 90"},
               {"at 1 gpu-load -1 ms", "the load is -1, must be a number from 0 to 100000"},
               {"inset 0.5", "half of the inset's angle in degrees is 0.5, must be a number from 1 to 85"},
               {"inset 20 size 0 10", "the width in pixels is 0, must be a whole number from 1 to 16384"},
               {"gaze 0 91 0", "a.script:1: the turn to the left in degrees is 91, must be a number from -90 to 90"},
               {"eye left angles -90 40 40 -40", "the angle to the left in degrees is -90, must be a number from -85 to 85"},
               {"eye left angles 40 40 40 -40", "the angles are 40 to the left and 40 to the right, left must be less"},
               {"eye left angles -40 40 -40 40", "the angles are -40 up and 40 down, down must be less"},
               {"eye left cant 46", "the turn outwards in degrees is 46"},
               {"at 1 eye right angles -40 40 86 -40", "a.script:1: the angle up in degrees is 86"},
               {"head 0 rotation 0 0 0 0", "a.script:1: the rotation's length is 0, must be 1"},
               {"controller left 0 rotation 0 1e-9 0 0", "the rotation's length is 1e-09"},
               {"head 0 position 1 2 3 look 1 2 3", "a.script:1: the point to look at is where it looks from"}});
}

TEST_CASE("times must increase") {
    refuseAll({{"head 1 position 0 0 0\nhead 0.5 position 0 0 0", "a.script:2: the time is 0.5, must be after the key before, at 1"},
               {"head 1 position 0 0 0\nhead 1 position 0 0 0", "a.script:2: the time is 1, must be after"},
               {"controller left 1 turn 0 0\ncontroller right 0 turn 0 0\ncontroller left 0 turn 0 0", "a.script:3: the time is 0"},
               {"axis left trigger 1 0\naxis left trigger 1 1", "a.script:2: the time is 1"},
               {"gaze 1 0 0\ngaze 1 5 5", "a.script:2: the time is 1, must be after the key before, at 1"},
               {"at 2 exit\nat 1 lose-session", "a.script:2: the time is 1, must not be before the `at` before, at 2"},
               {"at 2 should-render off\nat 2 should-render on", "a.script:2: the time is 2, must be after the one of the same change"},
               {"at 1 gaze off\nat 1 gaze on", "a.script:2: the time is 1, must be after the one of the same change before"},
               {"at 1 gpu-load 5 %\nat 1 gpu-load 6 %", "a.script:2: the time is 1, must be after the one of the same change"},
               {"press left a 2 2", "it lasts from 2 to 2, must end after it begins"}});
}

TEST_CASE("choices are listed") {
    refuseAll({{"eye middle cant 5", "the side is middle, must be left or right"},
               {"eye left", "what is set is missing, must be angles or cant"},
               {"at 1 should-render maybe", "whether to render is maybe, must be on or off"},
               {"at 1 head maybe", "whether it is tracked is maybe, must be on, off or turn-only"},
               {"at 1 gaze poor", "a.script:1: whether the gaze is tracked is poor, must be on, off or degraded"},
               {"eye-tracking maybe", "a.script:1: whether eyes are tracked is maybe, must be on, off or refused"},
               {"blend-modes see-through", "a blend mode is see-through, must be opaque, additive or alpha-blend"},
               {"blend-modes opaque opaque", "a blend mode stands there twice, must be named once"},
               {"refuse-depth all", "what is refused is all, must be images or layers"},
               {"visibility-mask perhaps", "whether there is a mask is perhaps, must be on, off or broken"},
               {"images 3 backwards", "the order is backwards, must be in-turn, reversed or shuffled"},
               {"period long", "the stated period is long, must be steady or stretched"},
               {"state-changes never", "when states change is never, must be at-begin or at-end"},
               {"local", "the pose is missing"},
               {"head 0", "the pose is missing, must be position X Y Z"},
               {"at 1 dance", "what happens is dance, must be should-render, visible, focused, slow-images"},
               {"press left nose 0 1", "nose is not an input, must be one of: trigger, squeeze"},
               {"axis left a 0 1",
                "a has no axis, must be trigger, squeeze, select, pinch_ext, aim_activate_ext, grasp_ext, thumbstick or trackpad"},
               {"frames", "the frames are missing, must be all, none, every N, or from A to B"},
               {"frames from 5 to 4", "the last frame is 4, must be a whole number from 5"},
               {"frames from 5", "the last frame is missing, must be from A to B"},
               {"\nextension XR_KHR_visibilty_mask off",
                "a.script:2: XR_KHR_visibilty_mask is no extension of this runtime, must be one of: XR_KHR_vulkan_enable2, "},
               {"extension KHR_visibility_mask off", "KHR_visibility_mask is no extension of this runtime"},
               {"extension XR_KHR_visibility_mask on", "what to do with it is on, must be off"}});
}

TEST_CASE("settings stand once") {
    refuseAll({{"rate 90\nsize 1 1\nrate 90", "a.script:3: rate is set again, first on line 1, must be set once"},
               {"eye left cant 1\neye left cant 2", "eye left cant is set again"},
               {"eye-tracking on\neye-tracking on", "a.script:2: eye-tracking is set again, first on line 1"},
               {"images 3\nimages 2", "a.script:2: images is set again, first on line 1"},
               {"inset 20\ninset 10", "a.script:2: inset is set again, first on line 1"},
               {"profile valve/index_controller\nprofile valve/index_controller", "profile is set again"},
               {"extension XR_KHR_visibility_mask off\nextension XR_KHR_visibility_mask off", "XR_KHR_visibility_mask is off already"},
               {"eye left cant 1\neye right cant 2\neye left angles -1 1 1 -1", "accepted"}});
}

TEST_CASE("inputs that the controllers lack are named with their line") {
    // Any of those that it has in turn may have them.
    const std::string simple_first = "profile khr/simple_controller\nat 1 profile valve/index_controller\n";
    refuseAll(
        {{"profile valve/index\n", "a.script:1: valve/index is not a profile of controllers, must be one of: oculus/touch_controller, "},
         {"at 1 profile valve/index\n", "a.script:1: valve/index is not a profile of controllers"},
         {"profile htc/vive_pro\n", "htc/vive_pro is not a profile of controllers"},
         {"press left a 0 1\nprofile oculus/touch_controller\n",
          "a.script:1: the left hand of oculus/touch_controller has no a, must be one of: trigger, squeeze, thumbstick, x, y, menu, "
          "thumbrest"},
         {"profile khr/simple_controller\npress right select 0 1\naxis right trigger 0 1\n",
          "a.script:3: the right hand of khr/simple_controller has no trigger, must be one of: menu, select"},
         {simple_first + "press left x 0 1\n", "a.script:3: the left hand of khr/simple_controller has no x"},
         {simple_first + "press left a 0 1\npress left select 0 1\n", "accepted"},
         {"profile valve/index_controller\npress left a 0 1\naxis right trackpad 0 1 1\n", "accepted"},
         {"press left a 0 1\npress left menu 0 1\n", "accepted"}});
}

TEST_CASE_FIXTURE(ScriptFolder, "files that cannot be read are said with the line that names them") {
    refuses("\nheadset none.toml", "a.script:2: ");
    refuses("\nheadset none.toml", "none.toml: cannot be read (No such file or directory), must be a TOML file of a headset");
    refuses("head-motion none.csv", "none.csv: cannot be read (No such file or directory), must be a CSV file of head motion");
    refuses("headset .", "cannot be read (not a regular file)");
#ifndef _WIN32
    refuses("head-motion /dev/zero", "/dev/zero: cannot be read (not a regular file)");
#endif
    const std::size_t mebibyte = std::size_t{1} << 20;
    refusesFile("head-motion", "long.csv", std::string(16 * mebibyte + 1, '#'), "cannot be read (longer than 16 MiB)");
    refusesHeadset(std::string(4 * mebibyte + 1, '#'), "cannot be read (longer than 4 MiB)");
    refusesHeadset("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n", "h.toml: cannot be read (a Git LFS pointer, ");
    CHECK_THROWS_AS((void)Script::load(path / "h.toml"), ScriptError);
    const std::filesystem::path none = path / "none.script";
    CHECK_THROWS_WITH_AS((void)Script::load(none),
                         (none.string() + ": cannot be read (No such file or directory), must be a script").c_str(), ScriptError);
    CHECK_THROWS_AS((void)Script::load("/dev/zero"), ScriptError);
}

TEST_CASE_FIXTURE(ScriptFolder, "headset files with mistakes are refused with their own line, and stand before what changes them") {
    refusesHeadset("name = \"n", "h.toml:1: ");
    refusesHeadset(replaced(kHeadsetToml, "size = \"100x100\"\n", ""), "size is missing, must be given");
    refusesHeadset(replaced(kHeadsetToml, "100x100", "100*100"), "h.toml:3: size is 100*100, must be WxH with 1 to 16384 per side");
    refusesHeadset(replaced(kHeadsetToml, "100x100", "100x0"), "h.toml:3: size is 100x0");
    refusesHeadset(replaced(kHeadsetToml, "0.06", "nan"), "h.toml:5: eye_distance_m is nan, must be a number from 0 to 1");
    refusesHeadset(replaced(kHeadsetToml, "left = -40", "left = 50"), "h.toml:6: left.left must be less than left.right");
    refusesHeadset(replaced(kHeadsetToml, "up = 40", "up = \"high\""), "h.toml:9: left.up is high, must be a number from -85 to 85");
    refusesHeadset(replaced(kHeadsetToml, "[right]", "[middle]"), "middle is not a key of a headset");
    refusesHeadset(replaced(kHeadsetToml, "canting_deg", "kanting"), "h.toml:4: kanting is not a key of a headset, must be name, source");
    for (const auto& [more, part] :
         {std::pair<std::string, const char*>("\xc3\xa9 = 1\n", ":16: a letter that is neither ASCII nor in quotes nor in a comment"),
          {"a = 2\"\xc3\xa9\"\n", ":16: quotes within a word, must be around it"},
          {"a = \"\"\"b\"\"\"\n", ":16: a text over several lines, must be on one"},
          {"a = " + std::string(65, '.') + "\n", ":16: a key of more than 64 parts"},
          {"[inset]\nhalf_angle_deg = 90\n", ":17: inset.half_angle_deg is 90, must be a number from 1 to 85"},
          {"[inset]\nsize = \"60x50\"\n", "inset.half_angle_deg is missing, must be given"},
          {"[inset]\nhalf_angle_deg = 9\nsize = \"60\"\n", ":18: inset.size is 60, must be WxH"},
          {"[inset]\nhalf_angle = 9\n", "inset.half_angle is not a key of a headset"}}) {
        refusesHeadset(kHeadsetToml + more, part);
    }
    refusesHeadset(kHeadsetToml, "accepted");
    refuses("ipd 0.06\nheadset h.toml", "a.script:2: headset sets ipd, too, must stand before it");
    refuses("inset 20\nheadset h.toml", "a.script:2: headset sets inset, too, must stand before it");
    refuses("headset h.toml\nipd 0.06", "accepted");
}

TEST_CASE_FIXTURE(ScriptFolder, "recordings with mistakes are refused with their own line") {
    for (const auto& [text, part] : {std::pair("", "m.csv: holds no poses"),
                                     {"time,x,y,z,qx,qy,qz,qw\n", "m.csv: holds no poses"},
                                     {"0,0,0,0,0,0,1\n", "m.csv:1: 7 columns, must be 8"},
                                     {"0,0,0,0,0,0,0,1\n0,0,0,0,0,0,0,1\n", "m.csv:2: time is 0, must be after the pose before"},
                                     {"0,0,0,0,0,0,0,0\n", "m.csv:1: the orientation's length is 0, must be 1"},
                                     {"0,nan,0,0,0,0,0,1\n", "m.csv:1: x is nan, must be a finite number"},
                                     {"0,0,0,0,0,0,,1\n", "m.csv:1: qz is empty"},
                                     {"5e12,0,0,0,0,0,0,1\n", "m.csv:1: time is 5e12, must be seconds"}}) {
        refusesFile("head-motion", "m.csv", text, part);
    }
    write("m.csv", "0,0,0,0,0,0,0,1\n1,0,0,0,0,0,0,1\n");
    refuses("head-motion m.csv skip 2", "a.script:1: the seconds to skip are 2, must be at most 1, the recording's length");
    refuses("head-motion m.csv axes opengl", "the axes is opengl, must be openxr or unity");
    refuses("head-motion m.csv\nhead 0 turn 0 0\nhead 1 turn 0 0", "a.script:3: the head has a recorded motion");
    refuses("head 0 turn 0 0\nhead 1 turn 0 0\nhead-motion m.csv", "a.script:3: the head has keys on more than one line");
}

TEST_CASE("a script cut off anywhere, or with any byte changed, is a script or an error") {
    const std::string walk = walkScript(),
                      text = walk +
                             "headset \"none such.toml\"\nvisibility-mask on\naim left turn 5 5\nat 5 eye left angles -1 1 1 -1\n"
                             "at 6 controller left off\n";
    REQUIRE(text.size() > 900);
    std::vector<std::string> cut, changed;
    for (std::size_t length = 0; length <= text.size(); ++length) { cut.push_back(text.substr(0, length)); }
    for (std::size_t i = 0; i < walk.size(); ++i) {
        for (const char byte : {'\0', '\n', '"', '#', '-', '9', '\xff'}) {
            changed.push_back(walk);
            changed.back()[i] = byte;
        }
    }
    // Cut at the ends of lines it is a shorter script, within most words it is none.
    const std::size_t refused = countRefused(cut);
    CHECK(cut.size() - refused > 20);
    CHECK(refused > 200);
    CHECK(countRefused(changed) > 1000);
}

}  // SUITE(simulated_script_errors)
