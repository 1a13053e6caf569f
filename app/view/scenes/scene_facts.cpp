// Numbers about a scene, in units that can be read at a glance.
#include "app/view/scenes/scene_facts.h"

#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/gpu/gpu_scene.h"
#include "engine/places/standpoint.h"

#include <fmt/format.h>

#include <filesystem>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

std::uint64_t bytesOnDisk(const fs::path& place) {
    std::error_code error;
    if (!fs::is_directory(place, error)) {
        const std::uintmax_t bytes = fs::file_size(place, error);
        return error ? 0 : bytes;
    }
    std::uint64_t sum = 0;
    for (fs::recursive_directory_iterator entry(place, error), end; !error && entry != end;
         entry.increment(error)) {
        std::error_code ignored;
        if (entry->is_regular_file(ignored)) { sum += entry->file_size(ignored); }
    }
    return sum;
}

// 1234567 as 1 234 567.
std::string inThousands(std::uint64_t count) {
    std::string digits = fmt::format("{}", count);
    for (auto at = std::ssize(digits) - 3; at > 0; at -= 3) { digits.insert(digits.begin() + at, ' '); }
    return digits;
}

std::string kindOf(const Scene& scene, const LoadNotes& notes) {
    if (!notes.three_scales) { return "2D Gaussians (discs)"; }
    if (!scene.isGaussian3d()) { return "3D Gaussians, drawn as discs"; }
    return scene.antialiased ? "3D Gaussians, antialiased" : "3D Gaussians";
}

}  // namespace

std::string inMib(std::uint64_t bytes) {
    const double mib = static_cast<double>(bytes) / (1024.0 * 1024.0);
    return mib < 0.1 ? fmt::format("{:.1f} KiB", 1024.0 * mib) : fmt::format("{:.1f} MiB", mib);
}

std::string describeBriefly(const SceneFacts& facts) {
    return fmt::format("{} splats, {}", inThousands(facts.splats), facts.kind) +
           (facts.file_bytes == 0 ? "" : ", " + inMib(facts.file_bytes));
}

SceneFacts factsOf(const Scene& scene, const LoadNotes& notes, const std::string& source) {
    SceneFacts facts;
    facts.splats = scene.size();
    facts.left_out = notes.skipped_not_finite + notes.skipped_zero_rotation;
    facts.kind = kindOf(scene, notes);
    facts.sh_degree = scene.sh_degree;
    facts.sh_degree_in_file = notes.sh_degree_in_file;
    facts.device_bytes = scene.size() * deviceBytesPerSplat(scene.sh_degree, scene.isGaussian3d());
    facts.is_from_web = isAddress(source);
    if (!isBuiltin(source) && !facts.is_from_web) { facts.file_bytes = bytesOnDisk(source); }
    const SceneCore core = measureCore(scene);
    facts.size_units = core.size;
    facts.middle = core.middle;
    return facts;
}

std::vector<std::pair<std::string, std::string>> describeFacts(const SceneFacts& facts,
                                                               double metres_per_unit) {
    std::string splats = inThousands(facts.splats);
    if (facts.left_out > 0) {
        splats += fmt::format(", {} broken ones left out", inThousands(facts.left_out));
    }
    std::string colours = fmt::format("degree {}", facts.sh_degree);
    if (facts.sh_degree_in_file > facts.sh_degree) {
        colours += fmt::format(", {} in the file", facts.sh_degree_in_file);
    }
    return {{"Splats", splats},
            {"Kind", facts.kind},
            {"Colours (SH)", colours},
            {"In memory", inMib(facts.device_bytes)},
            {"File", facts.is_from_web       ? "from the web"
                     : facts.file_bytes == 0 ? "made by the program"
                                             : inMib(facts.file_bytes)},
            {"Scale", fmt::format("{:.3g} metres a scene unit", metres_per_unit)}};
}

}  // namespace binosplat
