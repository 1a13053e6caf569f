// Reading the gamepad.
#include "xr/gamepad.h"

namespace binosplat::xr {

Gamepad::Gamepad(const Actions& actions) : actions_(actions) {
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        const GamepadBinding& input = kGamepadBindings[i];
        const XrActionType type =
            input.is_stick ? XR_ACTION_TYPE_VECTOR2F_INPUT : XR_ACTION_TYPE_BOOLEAN_INPUT;
        inputs_[i] = actions.make(input.name, input.description, type);
    }
}

void Gamepad::bind(const Instance& instance) const {
    std::vector<XrActionSuggestedBinding> bindings;
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        bindings.push_back(
            {inputs_[i], instance.path(fmt::format("/user/gamepad/{}", kGamepadBindings[i].path).c_str())});
    }
    static_cast<void>(actions_.suggest(kGamepadProfile, bindings));
}

void Gamepad::addTo(std::array<Hand, 2>& hands) {
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
        const GamepadBinding& input = kGamepadBindings[i];
        Hand& hand = hands[static_cast<std::size_t>(input.side)];
        if (input.is_stick) {
            hand.stick = glm::clamp(hand.stick + actions_.readStick(inputs_[i], XR_NULL_PATH), -1.0, 1.0);
            continue;
        }
        const std::optional<bool> pressed = actions_.readButton(inputs_[i], XR_NULL_PATH);
        bool& deed = hand.*input.button;
        deed = holds_[i].update(pressed ? std::optional(*pressed ? 1.0 : 0.0) : std::nullopt) || deed;
    }
}

void Gamepad::forget() {
    for (Hold& hold : holds_) { hold.forget(); }
}

}  // namespace binosplat::xr
