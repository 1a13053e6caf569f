// A picture of the controls for each family of controllers, drawn out of the bindings that the program suggests, and the fact that those of
// docs/controls are these. With BINOSPLAT_WRITE_GOLDENS in the environment they are written there first.
#include "xr/bindings.h"
#include "xr/simulated/api/profiles.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <iterator>
#include <map>
#include <string>
#include <vector>

using namespace binosplat::xr;

namespace {

const std::filesystem::path kFolder = std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "docs" / "controls";

// Controllers whose inputs are used alike.
struct Family {
    const ProfileBindings* bindings;
    std::vector<std::string> profiles;
};

bool isSame(const char* a, const char* b) { return std::string(a == nullptr ? "" : a) == (b == nullptr ? "" : b); }

std::vector<Family> allFamilies() {
    std::vector<Family> families;
    for (const ProfileBindings& profile : allProfileBindings()) {
        const auto alike = [&](const Family& family) {
            const ProfileBindings& other = *family.bindings;
            return isSame(profile.trigger, other.trigger) && isSame(profile.squeeze, other.squeeze) && isSame(profile.stick, other.stick) &&
                   isSame(profile.stick_click, other.stick_click) && isSame(profile.menu[0], other.menu[0]) &&
                   isSame(profile.menu[1], other.menu[1]);
        };
        auto found = std::ranges::find_if(families, alike);
        if (found == families.end()) { found = families.insert(families.end(), Family{&profile, {}}); }
        found->profiles.emplace_back(profile.path);
    }
    return families;
}

std::string fileOf(const Family& family) {
    const std::string& first = family.profiles.front();
    return first.substr(first.find('/') + 1) + ".svg";
}

// What people call an input, by its binding path. A new one needs a name here.
std::string wordFor(const char* input) {
    static const std::map<std::string, std::string> kWords{{"input/select/click", "select"},
                                                           {"input/trigger/value", "trigger"},
                                                           {"input/squeeze/value", "squeeze"},
                                                           {"input/squeeze/click", "squeeze"},
                                                           {"input/squeeze/force", "squeeze, by force"},
                                                           {"input/thumbstick", "stick"},
                                                           {"input/trackpad", "pad, pressed"},
                                                           {"input/menu/click", "menu"},
                                                           {"input/y/click", "Y"},
                                                           {"input/b/click", "B"},
                                                           {"input/select/value", "pinch"},
                                                           {"input/aim_activate_ext/value", "pinch"},
                                                           {"input/grasp_ext/value", "fist"}};
    const auto found = kWords.find(input);
    REQUIRE_MESSAGE(found != kWords.end(), input << " has no name");
    return found->second;
}

constexpr int kWidth = 1180, kHeight = 300, kHandX[]{470, 710}, kTextX[]{380, 800};
constexpr const char* kShape = "stroke=\"#444\" stroke-width=\"2\"";

// A label at its side's margin, and a line from there to a part of the controller.
std::string label(std::size_t side, int y, int part_x, int part_y, const std::string& text) {
    const int outwards = side == 0 ? -1 : 1, x = kTextX[side];
    return fmt::format(
        "  <path d=\"M{} {} L{} {}\" stroke=\"#888\" fill=\"none\"/>\n"
        "  <text x=\"{}\" y=\"{}\" text-anchor=\"{}\">{}</text>\n",
        x - 4 * outwards, y - 5, kHandX[side] + part_x, part_y, x, y, side == 0 ? "end" : "start", text);
}

// Parts lie mirrored on the two sides; x grows towards the middle between them.
std::string drawSide(const ProfileBindings& bindings, std::size_t side) {
    const int inwards = side == 0 ? 1 : -1, x = kHandX[side];
    const bool is_hand = bindings.haptic == nullptr;
    std::string svg;
    if (is_hand) {
        svg += fmt::format("  <rect x=\"{}\" y=\"120\" width=\"64\" height=\"76\" rx=\"24\" fill=\"#e8eaee\" {}/>\n", x - 32, kShape);
        for (int finger = 0; finger < 4; ++finger) {
            svg += fmt::format("  <rect x=\"{}\" y=\"{}\" width=\"13\" height=\"{}\" rx=\"6\" fill=\"#e8eaee\" {}/>\n",
                               x - 31 + 16 * finger, finger == 1 || finger == 2 ? 62 : 74, finger == 1 || finger == 2 ? 66 : 54, kShape);
        }
        svg += fmt::format("  <rect x=\"{}\" y=\"112\" width=\"40\" height=\"14\" rx=\"7\" fill=\"#d89f9f\" {}/>\n", x + inwards * 32 - 20,
                           kShape);
    } else {
        svg += fmt::format("  <rect x=\"{}\" y=\"60\" width=\"68\" height=\"150\" rx=\"30\" fill=\"#e8eaee\" {}/>\n", x - 34, kShape);
    }
    svg +=
        fmt::format("  <text x=\"{}\" y=\"30\" text-anchor=\"middle\" font-weight=\"bold\">{}</text>\n", x, side == 0 ? "left" : "right");
    if (bindings.trigger != nullptr) {
        if (!is_hand) {
            svg += fmt::format("  <rect x=\"{}\" y=\"46\" width=\"36\" height=\"16\" rx=\"6\" fill=\"#d89f9f\" {}/>\n", x - 18, kShape);
        }
        svg += label(side, is_hand ? 92 : 58, is_hand ? inwards * 32 : -inwards * 18, is_hand ? 112 : 54,
                     wordFor(bindings.trigger) + ": click; away from the panel, teleport");
    }
    if (bindings.stick != nullptr) {
        const bool is_pad = bindings.stick_click != nullptr;
        svg +=
            fmt::format("  <circle cx=\"{}\" cy=\"{}\" r=\"{}\" fill=\"#9fb6d8\" {}/>\n", x, is_pad ? 130 : 94, is_pad ? 24 : 13, kShape);
        svg += label(side, is_pad ? 134 : 98, 0, is_pad ? 124 : 94,
                     wordFor(bindings.stick) + (side == 0 ? ": walk, or teleport" : ": turn by 30 degrees, rise and sink"));
    }
    if (const char* menu = bindings.menu[side]) {
        const bool is_above = bindings.stick_click != nullptr;  // of the pad
        const int y = is_above ? 88 : 122;
        svg += fmt::format("  <circle cx=\"{}\" cy=\"{}\" r=\"7\" fill=\"#d8c79f\" {}/>\n", x - inwards * 12, y, kShape);
        svg += label(side, is_above ? 98 : 134, -inwards * 12, y, wordFor(menu) + ": the panel goes or comes");
    }
    if (bindings.squeeze != nullptr) {
        if (!is_hand) {
            svg += fmt::format("  <rect x=\"{}\" y=\"146\" width=\"18\" height=\"40\" rx=\"6\" fill=\"#a9d89f\" {}/>\n",
                               x - inwards * 32 - 9, kShape);
        }
        svg += label(side, 174, -inwards * (is_hand ? 26 : 32), 166, wordFor(bindings.squeeze) + ": hold the scene, or the panel");
    }
    return svg;
}

std::string draw(const Family& family) {
    std::string names;
    for (const std::string& profile : family.profiles) { names += (names.empty() ? "" : ", ") + profile; }
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" font-family=\"sans-serif\" font-size=\"15\" fill=\"#222\">\n"
        "  <rect width=\"{0}\" height=\"{1}\" fill=\"#fff\"/>\n",
        kWidth, kHeight);
    for (const std::size_t side : {0, 1}) { svg += drawSide(*family.bindings, side); }
    if (family.bindings->squeeze != nullptr) {
        svg += fmt::format("  <text x=\"{}\" y=\"246\" text-anchor=\"middle\">both: the scene follows the hands, turns and grows</text>\n",
                           kWidth / 2);
    }
    return svg + fmt::format("  <text x=\"{}\" y=\"282\" text-anchor=\"middle\" font-size=\"12\" fill=\"#666\">{}</text>\n</svg>\n",
                             kWidth / 2, names);
}

std::string textOf(const std::filesystem::path& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace

TEST_CASE("each family of controllers has a picture, as its bindings are now") {
    const bool writes = std::getenv("BINOSPLAT_WRITE_GOLDENS") != nullptr;
    std::vector<std::string> names;
    for (const Family& family : allFamilies()) {
        names.push_back(fileOf(family));
        if (writes) { std::ofstream(kFolder / names.back()) << draw(family); }
        CAPTURE(names.back());
        CHECK((textOf(kFolder / names.back()) == draw(family)));
    }
    CHECK(names.size() >= 6);
    // None is left of a family that is no more, and docs/headset.md shows them all.
    const std::string page = textOf(kFolder.parent_path() / "headset.md");
    for (const auto& entry : std::filesystem::directory_iterator(kFolder)) {
        CAPTURE(entry.path().filename().string());
        CHECK(std::ranges::find(names, entry.path().filename().string()) != names.end());
        CHECK(page.find("controls/" + entry.path().filename().string()) != std::string::npos);
    }
}

TEST_CASE("every input and output that is bound is one of its controller") {
    for (const ProfileBindings& bindings : allProfileBindings()) {
        CAPTURE(bindings.path);
        const simulated::Profile* const profile = simulated::findHandProfile(bindings.path);
        REQUIRE(profile != nullptr);
        CHECK((bindings.extension == nullptr) == (profile->since == simulated::Since::k1_0));
        if (bindings.extension != nullptr) { CHECK(profile->extension == bindings.extension); }
        for (const std::size_t side : {0, 1}) {
            for (const char* what : {"input/aim/pose", "input/grip/pose", bindings.trigger, bindings.squeeze, bindings.stick,
                                     bindings.stick_click, bindings.menu[side], bindings.haptic}) {
                if (what == nullptr) { continue; }
                const std::string path = fmt::format("/user/hand/{}/{}", side == 0 ? "left" : "right", what);
                CHECK_MESSAGE(simulated::allowsBinding(*profile, path, {}), path);
            }
        }
    }
}
