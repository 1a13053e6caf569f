// Commands for the headset: its display, its eyes and the room around it.
#include "xr/simulated/script/script_files.h"
#include "xr/simulated/script/script_parser.h"

#include <glm/trigonometric.hpp>

#include <algorithm>

namespace simulated {

namespace {

namespace fs = std::filesystem;

glm::uvec2 takeSize(Words& words) {
    const auto width = static_cast<std::uint32_t>(words.takeCount("the width in pixels", 1, 16384));
    return {width, static_cast<std::uint32_t>(words.takeCount("the height in pixels", 1, 16384))};
}

std::optional<glm::uvec2> sizeOf(const std::optional<std::array<std::uint32_t, 2>>& size_px) {
    if (!size_px) { return std::nullopt; }
    return glm::uvec2((*size_px)[0], (*size_px)[1]);
}

}  // namespace

void Parser::parseRate(Words& words) {
    script_.rate_hz = words.takeNumber(kRateMeaning, kLeastRate, kMostRate);
    script_.rate_is_fixed = words.takeIf("fixed");
}

void Parser::parseIrregular(Words& words) {
    script_.irregularity = 0.01 * words.takeNumber("how much periods differ, in percent", 0.0, 90.0);
}

void Parser::parsePeriod(Words& words) {
    script_.stretches_period = words.takeChoice("the stated period", {"steady", "stretched"}) == 1;
}

void Parser::parseSize(Words& words) { script_.size_px = takeSize(words); }

void Parser::parseIpd(Words& words) {
    script_.eye_distance_m = words.takeNumber("the eye distance in metres", 0.0, 1.0);
}

void Parser::parseEye(Words& words) {
    const Side side = words.takeSide();
    const std::string eye = side == kLeft ? "eye left " : "eye right ";
    if (words.takeChoice("what is set", {"angles", "cant"}) == 0) {
        requireFirst(words, eye + "angles");
        script_.fovs[side].setInitial(words.takeAngles());
    } else {
        requireFirst(words, eye + "cant");
        script_.cant_rad[side] = glm::radians(words.takeNumber("the turn outwards in degrees", -45.0, 45.0));
    }
}

void Parser::parseHeadsetLine(Words& words) {
    for (const char* set_by_it :
         {"size", "ipd", "eye left angles", "eye left cant", "eye right angles", "eye right cant", "inset"}) {
        if (seen_.contains(set_by_it)) {
            words.fail("headset sets {}, too, must stand before it", set_by_it);
        }
    }
    requireFirst(words, "headset");
    const fs::path path = folder_ / words.takeText("the headset's file");
    const files::HeadsetFile headset =
        readHeadset(readText(path, words.place() + ": ", "a TOML file of a headset"), path.string());
    script_.system_name = headset.name;
    script_.size_px = {headset.size_px[0], headset.size_px[1]};
    script_.eye_distance_m = headset.eye_distance_m;
    script_.cant_rad = {headset.canting_rad, headset.canting_rad};
    if (headset.inset) {
        script_.inset = {headset.inset->half_angle_rad, sizeOf(headset.inset->size_px),
                         sizeOf(headset.inset->context_size_px), std::nullopt};
    }
    for (const Side side : kSides) {
        const auto& [left_rad, right_rad, up_rad, down_rad] = headset.angles[side];
        script_.fovs[side].setInitial({left_rad, right_rad, up_rad, down_rad});
        script_.lens_centres_rad[side] = {headset.lens_centres_rad[side][0],
                                          headset.lens_centres_rad[side][1]};
    }
}

void Parser::parseInset(Words& words) {
    script_.inset.half_angle_rad =
        glm::radians(words.takeNumber("half of the inset's angle in degrees", 1.0, 85.0));
    if (words.takeIf("size")) { script_.inset.size_px = takeSize(words); }
    if (words.takeIf("context")) { script_.inset.context_px = takeSize(words); }
    if (words.takeIf("moving")) { script_.inset.moving_px = takeSize(words); }
}

void Parser::parseBlendModes(Words& words) {
    script_.blend_modes.clear();
    do {
        const auto mode = static_cast<Script::BlendMode>(
            words.takeChoice("a blend mode", {"opaque", "additive", "alpha-blend"}));
        if (std::ranges::find(script_.blend_modes, mode) != script_.blend_modes.end()) {
            words.fail("a blend mode stands there twice, must be named once");
        }
        script_.blend_modes.push_back(mode);
    } while (!words.isAtEnd());
}

void Parser::parsePassthrough(Words& words) {
    script_.passthrough = words.takeChoice("whether the room is passed through", {"on", "off"}) == 0;
}

void Parser::parseRoomColour(Words& words) {
    for (int c = 0; c < 3; ++c) { script_.room_colour[c] = words.takeNumber("the room's colour", 0.0, 1.0); }
}

void Parser::parseMask(Words& words) {
    const std::size_t choice = words.takeChoice("whether there is a mask", {"on", "off", "broken"});
    script_.visibility_mask = choice == 0;
    script_.visibility_mask_is_broken = choice == 2;
}

void Parser::parseLocal(Words& words) { script_.stage_from_local = parsePose(words, {}); }

void Parser::parseStage(Words& words) { script_.has_stage = words.takeOnOff("whether there is a STAGE"); }

}  // namespace simulated
