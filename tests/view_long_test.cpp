// Facts about a long stay in the headset: walking, grabs, scenes one after another, recentres, a headset that is taken off, tracking and
// sessions that are lost. Memory does not grow and nobody complains. BINOSPLAT_WALK_SECONDS=7200 in the environment makes it two hours
// of the wearer's time instead of ten seconds; frames come as fast as they can, 30 to such a second.
#include "tests/panel_sketch.h"
#include "tests/view_runs.h"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdlib>

using namespace binosplat;
using namespace binosplat::test;

namespace {

constexpr int kRate = 30;
constexpr double kRound = 10.0;  // seconds

// Rounds of ten seconds. The wearer is at rest whenever the panel comes before the eyes, so that it can be pointed at.
std::string walkOf(int rounds, const std::string& folder) {
    // Of the panel that hangs where docs/simulated_script.md says.
    const auto lookAt = [](const glm::dvec2& place) {
        const glm::dvec3 at = glm::dvec3(-0.45, 1.5, -0.9) + 0.468 * (place.x - 0.5) * glm::dvec3(0.894, 0.0, -0.447) +
                              0.585 * (0.5 - place.y) * glm::dvec3(-0.044, 0.995, -0.088);
        return fmt::format("position 0.2 1.2 -0.35 look {:.4f} {:.4f} {:.4f}\n", at.x, at.y, at.z);
    };
    const std::string page = lookAt(placeOf("Scenes")), next = lookAt(placeOfScene("Next scene", folder));
    std::string script = fmt::format(
        "rate {}\nsize 64 64\nframes none\nvisibility-mask on\nimages 3 shuffled\nirregular 20\nstate-changes at-begin\n", kRate);
    for (int round = 0; round < rounds; ++round) {
        const double t = kRound * round;
        script += fmt::format("head {:.2f} position 0 1.6 0 turn 0 0\nhead {:.2f} position 0 1.6 0\n", t, t + 2.4);
        script += fmt::format("head {:.2f} position 0.3 1.5 -0.5 turn 25 -10\nhead {:.2f} position 0 1.6 0 turn 0 0\n", t + 3.5, t + 4.6);
        script += fmt::format("controller right {:.2f} {}controller right {:.2f} {}", t + 0.2, page, t + 0.8, page);
        script += fmt::format("controller right {:.2f} {}controller right {:.2f} {}", t + 0.9, next, t + 1.5, next);
        script += fmt::format("press right trigger {:.2f} {:.2f}\n", t + 0.4, t + 0.7);
        script += fmt::format("controller right {:.2f} position 0.5 1.3 -0.5 turn -60 10\n", t + 2.5);
        script += fmt::format("controller right {:.2f} position 0.3 1.1 -0.4 turn -80 -10\n", t + 4.5);
        script += fmt::format("press right trigger {:.2f} {:.2f}\n", t + 1.0, t + 1.3);
        script += fmt::format("press right squeeze {:.2f} {:.2f}\npress left squeeze {:.2f} {:.2f}\n", t + 2.7, t + 4.4, t + 3.2, t + 4.0);
        script += fmt::format("axis left thumbstick {:.2f} 0 0\naxis left thumbstick {:.2f} 0.3 1\n", t + 4.7, t + 4.8);
        script += fmt::format("axis left thumbstick {:.2f} 0.3 1\naxis left thumbstick {:.2f} 0 0\n", t + 5.4, t + 5.5);
        script += fmt::format("at {:.2f} recentre\nat {:.2f} worn off\nat {:.2f} worn on\n", t + 5.0, t + 5.8, t + 6.3);
        script += fmt::format("at {:.2f} lose-session\nat {:.2f} head off\nat {:.2f} head on\n", t + 7.5, t + 8.5, t + 8.8);
        script += fmt::format("at {:.2f} rate {}\nat {:.2f} rate {}\n", t + 9.0, 2 * kRate, t + 9.5, kRate);
    }
    return script;
}

// Of all programs that ran so far, the one that took most.
std::uint64_t peakOfChildrenBytes() {
    rusage usage{};
    REQUIRE(getrusage(RUSAGE_CHILDREN, &usage) == 0);
    return static_cast<std::uint64_t>(usage.ru_maxrss) << 10;
}

std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) { ++found; }
    return found;
}

void walk(const Workplace& work, int rounds) {
    std::ofstream(work.path / "walk.script") << walkOf(rounds, (work.path / "scenes").string());
    ViewRun run;  // its frames are too many to be read
    run.outcome =
        work.run(fmt::format("view scenes/a.ply --load-first --frames {} --simulate walk.script --out walk", rounds * 300), kValidated);
    checkClean(run);
    const auto least = static_cast<std::size_t>(rounds);
    CHECK(count(run.outcome.output, "another one begins") + 1 >= least);
    CHECK(count(run.outcome.output, "shows ") >= least);
    CHECK(count(run.outcome.output, "the wearer's place is the room's") > least);
}

}  // namespace

TEST_CASE("however long somebody walks about, memory stays as it is and nobody complains") {
    const char* const wanted = std::getenv("BINOSPLAT_WALK_SECONDS");
    const int rounds = std::max(static_cast<int>((wanted != nullptr ? std::atof(wanted) : 3.0 * kRound) / kRound), 3);
    const Workplace work;
    std::filesystem::create_directories(work.path / "scenes");
    for (const char* name : {"fence", "step-edge"}) {
        const Outcome made = work.run(fmt::format("scene {} --out scenes/{}.ply", name, *name == 'f' ? "a" : "b"));
        INFO(made.errors);
        REQUIRE(made.exit_code == 0);
    }
    walk(work, std::max(rounds / 12, 1));  // warm
    const std::uint64_t warm = peakOfChildrenBytes();
    walk(work, rounds);
    const std::uint64_t all = peakOfChildrenBytes();
    MESSAGE("peak of memory " << (warm >> 20) << " MiB warm, " << (all >> 20) << " MiB after " << rounds << " rounds");
    CHECK(all <= warm + warm / 20 + (8u << 20));
}
