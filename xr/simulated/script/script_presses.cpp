// Commands for what the hands press, touch and push.
#include "xr/simulated/script/script_inputs.h"
#include "xr/simulated/script/script_parser.h"

namespace simulated {

std::pair<Script::Hand*, std::string> Parser::takeInput(Words& words) {
    const bool is_gamepad = words.takeIf("gamepad");
    Script::Hand& hand = is_gamepad ? script_.gamepad : script_.hands[words.takeSide()];
    std::string name = words.takeText("the input"), known;
    for (const auto& [one, kind] : is_gamepad ? Inputs(kGamepadInputs) : Inputs(kInputs)) {
        if (one == name) {
            hand.input_places.try_emplace(name, words.place());
            return {&hand, std::move(name)};
        }
        known += (known.empty() ? "" : ", ") + std::string(one);
    }
    words.fail("{} is not an input, must be one of: {}", shown(name), known);
}

void Parser::addPress(Words& words, bool touch_only) {
    auto [hand, input] = takeInput(words);
    const double from_s = words.takeTime("the time at which it begins");
    const double to_s = words.takeTime("the time at which it ends");
    if (from_s >= to_s) { words.fail("it lasts from {} to {}, must end after it begins", from_s, to_s); }
    hand->presses.push_back({std::move(input), from_s, to_s, touch_only});
}

void Parser::parsePress(Words& words) { addPress(words, false); }
void Parser::parseTouch(Words& words) { addPress(words, true); }

void Parser::parseAxis(Words& words) {
    const auto [hand, input] = takeInput(words);
    const InputKind kind = *kindOfInput(input);
    if (kind == InputKind::kButton) {
        words.fail(
            "{} has no axis, must be trigger, squeeze, select, pinch_ext, aim_activate_ext, grasp_ext, "
            "thumbstick or trackpad",
            input);
    }
    const double time_s = words.takeTime();
    glm::dvec2 value(0.0);
    if (kind == InputKind::kStick) {
        value.x = words.takeNumber("the axis to the right", -1.0, 1.0);
        value.y = words.takeNumber("the axis upwards", -1.0, 1.0);
    } else {
        value.x = words.takeNumber("the value", 0.0, 1.0);
    }
    addKey(words, hand->axes[input], time_s, value);
}

}  // namespace simulated
