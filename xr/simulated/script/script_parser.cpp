// From a script's text to the script, line by line.
#include "xr/simulated/script/script_parser.h"
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/script/script_files.h"
#include "xr/simulated/script/script_profile.h"

#include <algorithm>

namespace simulated {

Parser::Parser(const std::string& name) : name_(name), folder_(std::filesystem::path(name).parent_path()) {}

Script Parser::parse(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) { text.remove_prefix(3); }
    for (line_ = 1; !text.empty(); ++line_) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        Words words(text.substr(0, length), fmt::format("{}:{}", name_, line_));
        text.remove_prefix(std::min(length + 1, text.size()));
        if (words.isAtEnd()) { continue; }
        parseLine(words);
        words.requireEnd();
    }
    finishPoses();
    if (!script_.profile.empty()) { checkInputs(script_, *findHandProfile(script_.profile)); }
    return std::move(script_);
}

void Parser::parseLine(Words& words) {
    constexpr bool kOnce = true;
    static const std::map<std::string, Command, std::less<>> kCommands{
        {"at", {&Parser::parseAt}},
        {"aim", {&Parser::parseAim}},
        {"axis", {&Parser::parseAxis}},
        {"blend-modes", {&Parser::parseBlendModes, kOnce}},
        {"controller", {&Parser::parseController}},
        {"extension", {&Parser::parseExtension}},
        {"eye", {&Parser::parseEye}},
        {"eye-tracking", {&Parser::parseEyeTracking, kOnce}},
        {"frames", {&Parser::parseFrames, kOnce}},
        {"gaze", {&Parser::parseGaze}},
        {"head", {&Parser::parseHead}},
        {"head-motion", {&Parser::parseHeadMotionLine, kOnce}},
        {"headset", {&Parser::parseHeadsetLine}},
        {"images", {&Parser::parseImages, kOnce}},
        {"inset", {&Parser::parseInset, kOnce}},
        {"ipd", {&Parser::parseIpd, kOnce}},
        {"irregular", {&Parser::parseIrregular, kOnce}},
        {"local", {&Parser::parseLocal, kOnce}},
        {"no-headset-for", {&Parser::parseNoHeadset}},
        {"period", {&Parser::parsePeriod, kOnce}},
        {"plugged", {&Parser::parsePlugged, kOnce}},
        {"press", {&Parser::parsePress}},
        {"profile", {&Parser::parseProfile, kOnce}},
        {"rate", {&Parser::parseRate, kOnce}},
        {"refuse-depth", {&Parser::parseRefusedDepth, kOnce}},
        {"passthrough", {&Parser::parsePassthrough, kOnce}},
        {"room-colour", {&Parser::parseRoomColour, kOnce}},
        {"size", {&Parser::parseSize, kOnce}},
        {"stage", {&Parser::parseStage, kOnce}},
        {"state-changes", {&Parser::parseStateChanges, kOnce}},
        {"touch", {&Parser::parseTouch}},
        {"visibility-mask", {&Parser::parseMask, kOnce}},
        {"vulkan-additions", {&Parser::parseVulkanAdditions, kOnce}}};
    const std::string command = words.takeText("the command");
    const auto found = kCommands.find(command);
    if (found == kCommands.end()) {
        std::string known;
        for (const auto& [word, named] : kCommands) { known += (known.empty() ? "" : ", ") + word; }
        words.fail("{} is not a command, must be one of: {}", shown(command), known);
    }
    // Settings may occur only once: it would not be obvious which of two wins.
    const auto& [parse, stands_once] = found->second;
    if (stands_once) { requireFirst(words, command); }
    (this->*parse)(words);
}

void Parser::requireFirst(const Words& words, const std::string& what) {
    const auto [earlier, is_first] = seen_.emplace(what, line_);
    if (!is_first) {
        words.fail("{} is set again, first on line {}, must be set once", what, earlier->second);
    }
}

Script Script::parse(std::string_view text, const std::string& name) { return Parser(name).parse(text); }

Script Script::load(const std::filesystem::path& path) {
    return parse(readText(path, "", "a script"), path.string());
}

}  // namespace simulated
