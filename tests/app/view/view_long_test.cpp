// Facts about a long stay in the headset: walking, grabs, scenes one after another, recentres, a headset that
// is taken off, lost tracking and lost sessions. Memory does not grow, and no error is reported.
// BINOSPLAT_WALK_SECONDS=7200 in the environment makes it two hours of the wearer's time instead of a minute;
// frames come as fast as they can, ten for each such second. BINOSPLAT_WALK_KEEP=FILE keeps the list of what
// was alive in that file, see tests/faults/live.cpp. Under the address sanitizer,
// ASAN_OPTIONS=malloc_context_size=1:quarantine_size_mb=16 keeps the sanitizer's own memory from growing: it
// remembers each stack that it sees, and those of drivers without frame pointers are never the same.
#include "tests/app/view/view_acts.h"

SUITE(view_long) {

// The lowest rate that the viewer accepts from a headset, so the wearer's time costs as little as possible.
constexpr int kRate = 10;
constexpr double kRound = 10.0;  // seconds
// After this many rounds, everything that is kept for later exists: two scenes were shown in turn, and the
// panel has pictures of both. For longer walks, ten minutes.
constexpr int kFewestWarm = 10, kMostWarm = 60;

// Rounds of ten seconds. The wearer stands still whenever the panel appears, so that it can be pointed at.
std::string walkOf(int rounds, const std::string& folder) {
    Acts acts(
        fmt::format("rate {}\nsize 64 64\nframes none\nvisibility-mask on\nimages 3 shuffled\nirregular 20\n"
                    "state-changes at-begin\n",
                    kRate));
    for (int round = 0; round < rounds; ++round) {
        const auto at = [&](double seconds) -> Acts& {
            acts.now_s = kRound * round + seconds;
            return acts;
        };
        at(0.2).point(placeOf("Scenes"));
        at(0.4).hold("right trigger", 0.3);
        at(0.8).point(placeOfScene("Next scene", folder));
        at(1.0).hold("right trigger", 0.3);
        at(1.5).right("position 0.5 1.3 -0.5 turn -60 10", 1.0);
        at(2.4).head("position 0.3 1.5 -0.5 turn 25 -10", 1.1).head("position 0 1.6 0 turn 0 0", 1.1);
        at(2.6).right("position 0.3 1.1 -0.4 turn -80 -10", 1.9);
        at(2.7).hold("right squeeze", 1.7);
        at(3.2).hold("left squeeze", 0.8);
        at(4.7).push("left thumbstick", {0.3, 1.0}, 0.7);
        for (const auto& [seconds, event] :
             {std::pair(5.0, "recentre"), std::pair(5.8, "worn off"), std::pair(6.3, "worn on"),
              std::pair(7.5, "lose-session"), std::pair(8.5, "head off"), std::pair(8.8, "head on")}) {
            at(seconds).at(event);
        }
        at(9.0).at(fmt::format("rate {}", 2 * kRate));
        at(9.5).at(fmt::format("rate {}", kRate));
    }
    acts.now_s = kRound * rounds;
    return acts;
}

// What was alive during ten submissions.
struct Alive {
    std::uint64_t submissions, fewest_objects, most_objects, least_device_bytes, most_device_bytes,
        heap_bytes, resident_bytes, kernels_made;
};

std::vector<Alive> readAlive(const fs::path& file) {
    std::vector<Alive> lines;
    std::ifstream stream(file);
    char dash = '-';
    for (Alive line{}; stream >> line.submissions >> line.fewest_objects >> dash >> line.most_objects >>
                       line.least_device_bytes >> dash >> line.most_device_bytes >> line.heap_bytes >>
                       line.resident_bytes >> line.kernels_made;) {
        lines.push_back(line);
    }
    return lines;
}

std::uint64_t most(std::span<const Alive> lines, std::uint64_t Alive::*what) {
    return std::ranges::max(lines, {}, what).*what;
}

std::uint64_t medianHeapBytes(std::span<const Alive> lines) {
    std::vector<std::uint64_t> sorted;
    std::ranges::transform(lines, std::back_inserter(sorted), &Alive::heap_bytes);
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::ranges::nth_element(sorted, middle);
    return *middle;
}

// Small blocks fragment the C library's heap, which takes ever larger ones as programs free memory: it grows
// with each scene although no more is in use. This keeps the limit of their size where it is at first.
constexpr const char* kSteadyHeap = "MALLOC_MMAP_THRESHOLD_=131072";

std::uint64_t mebibytes(std::uint64_t bytes) { return bytes >> 20; }

struct Walk : ViewRun {  // its frames are too many to be read
    explicit Walk(const std::string& environment) {
        const Workplace work;
        fs::create_directories(work.path / "scenes");
        work.go("scene one-splat --out scenes/a.ply");
        work.go("scene slanted-wall --out scenes/b.ply");
        const char* const wanted = std::getenv("BINOSPLAT_WALK_SECONDS");
        const int rounds = std::max(static_cast<int>((wanted != nullptr ? std::atof(wanted) : 0.0) / kRound),
                                    2 * kFewestWarm);
        work.write("walk.script", walkOf(rounds, (work.path / "scenes").string()));
        const char* const kept = std::getenv("BINOSPLAT_WALK_KEEP");
        const fs::path file = kept != nullptr ? fs::path(kept) : work.path / "alive.txt";
        // In a process that starts with it: the C library reads its settings only once.
        outcome = work.runCommand(
            fmt::format("{} {} '" BINOSPLAT_PROGRAM
                        "' view scenes/a.ply --load-first --frames {} --simulate walk.script --out walk",
                        kSteadyHeap, withFaults("BINOSPLAT_FAULT_LIVE='" + file.string() + "'", environment),
                        2 * rounds * static_cast<int>(kRound) * kRate));
        lines_alive = readAlive(file);
        const auto least = static_cast<std::size_t>(rounds);
        REQUIRE(lines_alive.size() >= least * 5);
        const std::size_t warm_lines =
            lines_alive.size() * static_cast<std::size_t>(std::min(rounds / 2, kMostWarm)) / least;
        warm = std::span(lines_alive).first(warm_lines);
        later = std::span(lines_alive).subspan(warm_lines);
        MESSAGE(mebibytes(medianHeapBytes(warm))
                << " MiB of heap at first, later " << mebibytes(medianHeapBytes(later))
                << ", at most resident " << mebibytes(most(warm, &Alive::resident_bytes)) << " and "
                << mebibytes(most(later, &Alive::resident_bytes)));
        CHECK(lines("another one begins").size() + 1 >= least);
        CHECK(lines("shows ").size() >= least);
        CHECK(lines("the room now begins where the wearer stands").size() > least);
    }

    std::vector<Alive> lines_alive;
    std::span<const Alive> warm, later;
};

TEST_CASE("however long somebody walks about, nobody complains, and the device is no fuller") {
    const Walk walk(kValidated);
    checkClean(walk);
    // Not one object more: whatever a round leaks would add up in later ones.
    CHECK(most(walk.later, &Alive::most_objects) <= most(walk.warm, &Alive::most_objects));
    // The length of a scene's lists depends on where the wearer stands when it arrives.
    CHECK(most(walk.later, &Alive::most_device_bytes) <=
          most(walk.warm, &Alive::most_device_bytes) * 51 / 50);
}

TEST_CASE("nor does the host's memory grow, and what was made is not made again") {
    // The validation layer of Vulkan 1.3.239 itself keeps 60 KiB more with each scene.
    const Walk walk("XDG_CONFIG_HOME=\"$PWD/../config\" DISPLAY= WAYLAND_DISPLAY=");
    checkEnded(walk);
    // Scenes alternate, and either half of the walk may contain slightly more of the larger one.
    CHECK(medianHeapBytes(walk.later) <= medianHeapBytes(walk.warm) + (512u << 10));
    const std::uint64_t resident = most(walk.warm, &Alive::resident_bytes);
    CHECK(most(walk.later, &Alive::resident_bytes) <= resident + resident / 50 + (8u << 20));
    CHECK(walk.warm.back().kernels_made > 10);
    CHECK(walk.later.back().kernels_made == walk.warm.back().kernels_made);
}

}  // SUITE(view_long)
