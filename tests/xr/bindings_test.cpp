// Facts about the controllers that the viewer binds, and the drawings of them in docs/controls.
#include "xr/bindings.h"
#include "tests/run_program.h"
#include "tests/xr/simulated/installed.h"
#include "xr/simulated/api/profiles.h"

SUITE(bindings) {

using namespace binosplat::xr;

std::set<std::string> namesIn(const std::filesystem::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) { names.insert(entry.path().filename().string()); }
    return names;
}

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
            for (const char* what : {"input/aim/pose", "input/grip/pose", bindings.trigger, bindings.squeeze, bindings.stick,
                                     bindings.stick_click, bindings.stick_press, bindings.menu[side], bindings.haptic}) {
                if (what == nullptr) { continue; }
                const std::string path = fmt::format("/user/hand/{}/{}", side == 0 ? "left" : "right", what);
                CHECK_MESSAGE(simulated::allowsBinding(*profile, path, enabled), path);
            }
        }
    }
}

TEST_CASE("the drawings of docs/draw.py are those in docs, and docs/headset.md shows each of them") {
    if (!isInstalled("python3", "python3")) { return; }
    const std::filesystem::path docs = std::filesystem::path(BINOSPLAT_SOURCE_DIR) / "docs";
    const Workplace work;
    const Outcome outcome = work.runCommand(fmt::format("python3 '{}' .", (docs / "draw.py").string()));
    INFO(outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    const std::set<std::string> names = namesIn(docs / "controls");
    CHECK(names.size() >= 6);
    CHECK(namesIn(work.path / "controls") == names);
    const std::string page = textIn(docs / "headset.md");
    for (const std::string& name : names) {
        CAPTURE(name);
        CHECK((textIn(work.path / "controls" / name) == textIn(docs / "controls" / name)));
        CHECK(page.find("controls/" + name) != std::string::npos);
    }
    CHECK((textIn(work.path / "overlap.svg") == textIn(docs / "overlap.svg")));
}

}  // SUITE(bindings)
