// Parses the command for timed changes and events: `at T ...`.
#include "xr/simulated/script/script_parser.h"

#include <algorithm>

namespace simulated {

namespace {

// "70 %", "8 ms" or "3 ms-per-megapixel".
GpuLoad parseLoad(Words& words) {
    const double amount = words.takeNumber("the load", 0.0, 1e5);
    switch (words.takeChoice("the load's unit", {"%", "ms", "ms-per-megapixel"})) {
        case 0:
            return {GpuLoad::Unit::kShareOfPeriod, amount / 100.0};
        case 1:
            return {GpuLoad::Unit::kMs, amount};
        default:
            return {GpuLoad::Unit::kMsPerMegapixel, amount};
    }
}

void addRecentring(Script& script, double time_s) {
    script.recentres_s.push_back(time_s);
    // The program is told in advance.
    const double told_s = time_s - ScriptEvent::kNoticeSeconds;
    script.events.insert(std::ranges::upper_bound(script.events, told_s, {}, &ScriptEvent::time_s),
                         {told_s, ScriptEvent::Kind::kRecentre, 1});
}

}  // namespace

void Parser::parseAt(Words& words) {
    const double time_s = words.takeTime();
    if (last_at_s_ && time_s < *last_at_s_) {
        words.fail("the time is {}, must not be before the `at` before, at {}", time_s, *last_at_s_);
    }
    last_at_s_ = time_s;
    const auto addEvent = [&](ScriptEvent::Kind kind, std::uint32_t count = 1) {
        script_.events.push_back({time_s, kind, count});
    };
    switch (words.takeChoice(
        "what happens",
        {"should-render", "visible", "focused", "slow-images", "lose-session", "lose-instance", "exit", "eye",
         "controller", "worn", "head", "recentre", "present", "rate", "gpu-load", "profile", "gaze"})) {
        case 0:
            return addStep(words, script_.should_render, time_s, words.takeOnOff("whether to render"));
        case 1:
            return addStep(words, script_.visible, time_s, words.takeOnOff("whether it is visible"));
        case 2:
            return addStep(words, script_.focused, time_s, words.takeOnOff("whether it has the focus"));
        case 3:
            return addEvent(ScriptEvent::Kind::kSlowImages, static_cast<std::uint32_t>(words.takeCount(
                                                                "the number of slow images", 1, 1000000)));
        case 4:
            return addEvent(ScriptEvent::Kind::kLoseSession);
        case 5:
            return addEvent(ScriptEvent::Kind::kLoseInstance);
        case 6:
            return addEvent(ScriptEvent::Kind::kExit);
        case 7: {
            const Side side = words.takeSide();
            (void)words.takeChoice("what changes", {"angles"});
            return addStep(words, script_.fovs[side], time_s, words.takeAngles());
        }
        case 8: {
            const Side side = words.takeSide();
            return addStep(words, script_.hands[side].tracked, time_s,
                           words.takeOnOff("whether it is tracked"));
        }
        case 9:
            return addStep(words, script_.worn, time_s, words.takeOnOff("whether it is worn"));
        case 10: {
            const std::size_t known = words.takeChoice("whether it is tracked", {"on", "off", "turn-only"});
            addStep(words, script_.head_turn_known, time_s, known != 1);
            return addStep(words, script_.head_place_known, time_s, known == 0);
        }
        case 11:
            return addRecentring(script_, time_s);
        case 12:
            return addStep(words, script_.present, time_s,
                           words.takeOnOff("whether somebody wears the headset"));
        case 13:
            script_.events.push_back(
                {time_s, ScriptEvent::Kind::kRate, 1, words.takeNumber(kRateMeaning, kLeastRate, kMostRate)});
            return;
        case 14:
            return addStep(words, script_.gpu_load, time_s, parseLoad(words));
        case 15:
            return addStep(words, script_.later_profiles, time_s, takeProfileName(words));
        default:
            return parseGazeTracking(words, time_s);
    }
}

}  // namespace simulated
