// Commands for what the runtime offers, how it behaves and what it writes.
#include "xr/simulated/api/profiles.h"
#include "xr/simulated/extensions.h"
#include "xr/simulated/script/script_parser.h"

#include <algorithm>
#include <array>

namespace simulated {

void Parser::parseImages(Words& words) {
    script_.images = static_cast<std::uint32_t>(words.takeCount("the number of images", 1, 16));
    if (words.isAtEnd()) { return; }
    constexpr std::array kOrders{Script::ImageOrder::kInTurn, Script::ImageOrder::kReversed,
                                 Script::ImageOrder::kShuffled};
    script_.image_order = kOrders.at(words.takeChoice("the order", {"in-turn", "reversed", "shuffled"}));
}

void Parser::parseStateChanges(Words& words) {
    script_.changes_state_at_begin = words.takeChoice("when states change", {"at-begin", "at-end"}) == 0;
}

void Parser::parseExtension(Words& words) {
    const std::string name = words.takeText("the extension's name");
    if (std::ranges::none_of(kExtensions,
                             [&](const Extension& extension) { return extension.name == name; })) {
        std::string known;
        for (const Extension& extension : kExtensions) {
            known += (known.empty() ? "" : ", ") + std::string(extension.name);
        }
        words.fail("{} is not an extension of this runtime, must be one of: {}", shown(name), known);
    }
    (void)words.takeChoice("what to do with it", {"off"});
    if (!script_.extensions_off.insert(name).second) {
        words.fail("{} is off already, must be named once", shown(name));
    }
}

std::string Parser::takeProfileName(Words& words) {
    std::string name = words.takeText("the controllers' profile");
    if (findHandProfile(name) == nullptr) {
        words.fail("{} is not a profile of controllers, must be one of: {}", shown(name), listHandProfiles());
    }
    return name;
}

void Parser::parseProfile(Words& words) { script_.profile = takeProfileName(words); }

void Parser::parsePlugged(Words& words) {
    script_.plugged = words.takeOnOff("whether the headset is plugged in");
}

void Parser::parseVulkanAdditions(Words& words) {
    script_.adds_vulkan_features = words.takeOnOff("whether the runtime asks for Vulkan features of its own");
}

void Parser::parseNoHeadset(Words& words) {
    const auto calls = static_cast<std::uint32_t>(words.takeCount("the number of calls", 1, 1000000));
    const bool after_loss = words.takeIf("after-loss");
    requireFirst(words, after_loss ? "no-headset-for ... after-loss" : "no-headset-for");
    (after_loss ? script_.calls_after_loss : script_.calls_without_headset) = calls;
}

void Parser::parseRefusedDepth(Words& words) {
    const bool images = words.takeChoice("what is refused", {"images", "layers"}) == 0;
    script_.depth = images ? Script::Depth::kNoImages : Script::Depth::kNoLayers;
}

void Parser::parseFrames(Words& words) {
    constexpr std::uint64_t kMost = 1'000'000'000;
    if (words.takeIf("none")) {
        script_.writes_pictures = false;
        return;
    }
    if (words.takeIf("all")) { return; }
    bool is_given = false;
    if (words.takeIf("from")) {
        script_.frames.first = words.takeCount("the first frame", 0, kMost);
        if (!words.takeIf("to")) { words.fail("the last frame is missing, must be from A to B"); }
        script_.frames.last = words.takeCount("the last frame", script_.frames.first, kMost);
        is_given = true;
    }
    if (words.takeIf("every")) {
        script_.frames.every = words.takeCount("how many frames apart", 1, kMost);
        is_given = true;
    }
    if (!is_given) {
        words.fail("the frames are missing, must be all, none, every N, or from A to B [every N]");
    }
}

}  // namespace simulated
