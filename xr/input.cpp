// Suggesting bindings, and reading the hands.
#include "xr/input.h"

#include <utility>

namespace binosplat::xr {
namespace {

constexpr XrDuration kPulseNs = 15'000'000;
constexpr float kPulseStrength = 0.4f;
constexpr const char* kHandPaths[] = {"/user/hand/left", "/user/hand/right"};

}  // namespace

Input::Input(const Session& session)
    : session_(session),
      tracking_(session),
      actions_(session),
      hands_{session.instance().path(kHandPaths[kLeft]), session.instance().path(kHandPaths[kRight])},
      aim_(actions_.make("aim", "Point at the panel", XR_ACTION_TYPE_POSE_INPUT, hands_)),
      grip_(actions_.make("grip", "Hold the scene", XR_ACTION_TYPE_POSE_INPUT, hands_)),
      trigger_(actions_.make("trigger", "Click", XR_ACTION_TYPE_FLOAT_INPUT, hands_)),
      squeeze_(actions_.make("squeeze", "Grab", XR_ACTION_TYPE_FLOAT_INPUT, hands_)),
      stick_(actions_.make("stick", "Move and turn", XR_ACTION_TYPE_VECTOR2F_INPUT, hands_)),
      stick_click_(
          actions_.make("pad", "Press the pad to move and turn", XR_ACTION_TYPE_BOOLEAN_INPUT, hands_)),
      stick_press_(actions_.make("viewpoint", "Next viewpoint, previous on the left",
                                 XR_ACTION_TYPE_BOOLEAN_INPUT, hands_)),
      menu_(actions_.make("menu", "Show or hide the panel", XR_ACTION_TYPE_BOOLEAN_INPUT, hands_)),
      play_(actions_.make("play", "Pause or play; while two scenes are compared, hold to see the other",
                          XR_ACTION_TYPE_BOOLEAN_INPUT, hands_)),
      haptic_(actions_.make("pulse", "Feel the panel", XR_ACTION_TYPE_VIBRATION_OUTPUT, hands_)),
      gamepad_(actions_),
      gaze_(session, actions_) {
    suggestBindings();
    gamepad_.bind(session.instance());
    gaze_.bind();
    actions_.attach();
    for (std::size_t h = 0; h < 2; ++h) {
        aim_spaces_[h] = actions_.makeSpace(aim_, hands_[h]);
        grip_spaces_[h] = actions_.makeSpace(grip_, hands_[h]);
    }
    gaze_.makeSpace();
}

void Input::suggestBindings() const {
    const Instance& instance = session_.instance();
    std::string rejected;
    for (const ProfileBindings& profile : allProfileBindings()) {
        if (profile.extension != nullptr && !instance.hasExtension(profile.extension)) { continue; }
        std::vector<XrActionSuggestedBinding> bindings;
        for (std::size_t h = 0; h < 2; ++h) {
            const auto bind = [&](XrAction action, const char* where) {
                if (where != nullptr) {
                    bindings.push_back(
                        {action, instance.path(fmt::format("{}/{}", kHandPaths[h], where).c_str())});
                }
            };
            bind(aim_, "input/aim/pose");
            bind(grip_, "input/grip/pose");
            bind(trigger_, profile.trigger);
            bind(squeeze_, profile.squeeze);
            bind(stick_, profile.stick);
            bind(stick_click_, profile.stick_click);
            bind(stick_press_, profile.stick_press);
            bind(menu_, profile.menu[h]);
            bind(play_, profile.play[h]);
            bind(haptic_, profile.haptic);
        }
        // A runtime need not know every controller.
        const XrResult result = actions_.suggest(profile.path, bindings);
        if (XR_FAILED(result)) {
            rejected += fmt::format("{}{} ({})", rejected.empty() ? "" : ", ", profile.path, nameOf(result));
        }
    }
    if (!rejected.empty()) {
        instance.troubles().add("controllers that the OpenXR runtime rejects: " + rejected);
    }
}

std::array<Hand, 2> Input::read() {
    std::array<Hand, 2> hands;
    const bool is_focused = actions_.sync();
    const bool was_at_rest = std::exchange(is_at_rest_, !is_focused);
    const bool is_new = std::exchange(times_focused_, session_.timesFocused()) != session_.timesFocused();
    if (std::exchange(times_held_changed_, session_.timesHeldChanged()) != session_.timesHeldChanged()) {
        const std::array<const ProfileBindings*, 2> held = this->held();
        for (std::size_t h = 0; h < held.size(); ++h) {
            // Every controller has a menu button, see bindings.cpp.
            are_bare_[h] = held[h] != nullptr && held[h]->menu[h] == nullptr;
        }
    }
    if (!is_focused || is_new) {
        for (auto* holds : {&clicks_, &grabs_, &menus_, &presses_, &plays_}) {
            for (Hold& hold : *holds) { hold.forget(); }
        }
        gamepad_.forget();
    }
    // Even if the focus went and came back between two frames, hands rest for one frame, so that no press
    // seems to be released in place.
    if (!is_focused || (is_new && !was_at_rest)) { return hands; }
    for (std::size_t h = 0; h < 2; ++h) { readHand(h, hands[h]); }
    gamepad_.addTo(hands);
    return hands;
}

void Input::readHand(std::size_t h, Hand& hand) {
    const XrPath path = hands_[h];
    hand.aim = actions_.locate(aim_, path, aim_spaces_[h], Actions::kKnown);
    hand.grip = actions_.locate(grip_, path, grip_spaces_[h], Actions::kKnown);
    hand.joints = tracking_.locate(static_cast<int>(h));
    const std::optional<double> trigger = actions_.readNumber(trigger_, path);
    hand.clicks = clicks_[h].update(trigger);
    hand.is_bare = are_bare_[h];
    hand.grabs = grabs_[h].update(actions_.readNumber(squeeze_, path));
    // A pad that is touched but not pressed is at rest.
    if (actions_.readButton(stick_click_, path).value_or(true)) {
        hand.stick = actions_.readStick(stick_, path);
    }
    const auto isHeld = [&](XrAction button, Hold& hold) {
        const std::optional<bool> pressed = actions_.readButton(button, path);
        return hold.update(pressed ? std::optional(*pressed ? 1.0 : 0.0) : std::nullopt);
    };
    hand.menu = isHeld(menu_, menus_[h]);
    hand.play = isHeld(play_, plays_[h]);
    hand.stick_presses = isHeld(stick_press_, presses_[h]);
}

std::array<const ProfileBindings*, 2> Input::held() {
    std::array<const ProfileBindings*, 2> held{};
    const Instance& instance = session_.instance();
    for (std::size_t h = 0; h < 2 && tells_held_; ++h) {
        auto state = structure<XrInteractionProfileState>(XR_TYPE_INTERACTION_PROFILE_STATE);
        tells_held_ = instance.troubles().tryFor("drawings of the controllers that are held", [&] {
            BINOSPLAT_XR(xrGetCurrentInteractionProfile(session_.handle(), hands_[h], &state));
        });
        if (state.interactionProfile == XR_NULL_PATH) { continue; }
        for (const ProfileBindings& profile : allProfileBindings()) {
            const std::string path = fmt::format("/interaction_profiles/{}", profile.path);
            if (instance.path(path.c_str()) == state.interactionProfile) { held[h] = &profile; }
        }
    }
    return held;
}

void Input::pulse(int hand) {
    if (!pulses_) { return; }
    auto info = structure<XrHapticActionInfo>(XR_TYPE_HAPTIC_ACTION_INFO);
    info.action = haptic_;
    info.subactionPath = hands_[static_cast<std::size_t>(hand)];
    auto vibration = structure<XrHapticVibration>(XR_TYPE_HAPTIC_VIBRATION);
    vibration.duration = kPulseNs;
    vibration.frequency = XR_FREQUENCY_UNSPECIFIED;
    vibration.amplitude = kPulseStrength;
    pulses_ = session_.instance().troubles().tryFor("pulses", [&] {
        BINOSPLAT_XR(xrApplyHapticFeedback(session_.handle(), &info,
                                           reinterpret_cast<const XrHapticBaseHeader*>(&vibration)));
    });
}

}  // namespace binosplat::xr
