// Facts about the controllers that the viewer binds.
#include "xr/bindings.h"
#include "tests/suite.h"
#include "xr/simulated/api/profiles.h"

SUITE(bindings) {

using namespace binosplat::xr;

TEST_CASE("every input and output that is bound is one of its controller") {
    for (const ProfileBindings& bindings : allProfileBindings()) {
        CAPTURE(bindings.path);
        const simulated::Profile* const profile = simulated::findHandProfile(bindings.path);
        REQUIRE(profile != nullptr);
        simulated::Enabled enabled;
        CHECK(enabled.meets(profile->depends) == (bindings.extension == nullptr));
        if (bindings.extension != nullptr) { enabled.extensions.insert(bindings.extension); }
        CHECK(enabled.meets(profile->depends));
        for (const std::size_t side : {0, 1}) {
            for (const char* what :
                 {"input/aim/pose", "input/grip/pose", bindings.trigger, bindings.squeeze, bindings.stick,
                  bindings.stick_click, bindings.stick_press, bindings.menu[side], bindings.haptic}) {
                if (what == nullptr) { continue; }
                const std::string path = fmt::format("/user/hand/{}/{}", side == 0 ? "left" : "right", what);
                CHECK_MESSAGE(simulated::allowsBinding(*profile, path, enabled), path);
            }
        }
    }
}

TEST_CASE("a gamepad has every input that is bound, and the core has the gamepad") {
    const simulated::Profile* const profile =
        simulated::findProfile(std::string("/interaction_profiles/") + kGamepadProfile);
    REQUIRE(profile != nullptr);
    CHECK(simulated::Enabled().meets(profile->depends));
    for (const GamepadBinding& input : kGamepadBindings) {
        CHECK_MESSAGE(simulated::allowsBinding(*profile, fmt::format("/user/gamepad/{}", input.path), {}),
                      input.path);
        CHECK(input.is_stick == (input.button == nullptr));
    }
}

}  // SUITE(bindings)
