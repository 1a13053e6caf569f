// Readers take files, so the inputs are given to them in memory, under a name in /proc.
#include "tests/fuzz/targets.h"

#include "app/summary/survey.h"
#include "engine/files/load_scene.h"
#include "engine/files/lod_meta.h"
#include "engine/files/scene_targets.h"
#include "engine/files/sog_meta.h"
#include "engine/setup/camera_file.h"
#include "engine/setup/head_motion.h"
#include "engine/setup/headset.h"
#include "engine/setup/settings.h"
#include "tests/engine/files/packed_bytes.h"
#include "tests/engine/scene/scene_measures.h"
#ifdef BINOSPLAT_OPENXR
#include "xr/simulated/script/script_files.h"
#endif

#include <sys/mman.h>
#include <unistd.h>

namespace binosplat::fuzz {

namespace {

using Bytes = std::span<const std::uint8_t>;

// A file without a place on any disk.
class MemoryFile {
public:
    explicit MemoryFile(Bytes bytes) : descriptor_(memfd_create("input", 0)) {
        for (std::size_t done = 0; descriptor_ >= 0 && done < bytes.size();) {
            const ssize_t written = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
            if (written <= 0) { break; }
            done += static_cast<std::size_t>(written);
        }
    }
    ~MemoryFile() { ::close(descriptor_); }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    [[nodiscard]] std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

private:
    int descriptor_;
};

std::string textOf(Bytes input) { return {input.begin(), input.end()}; }

void readScene(Bytes input) { (void)loadScene(MemoryFile(input).path()); }
void readScene(const std::string& input) {
    readScene({reinterpret_cast<const std::uint8_t*>(input.data()), input.size()});
}

// What was read can be written in every format, and read again with as many splats.
void convert(Bytes input) {
    const Scene scene = loadScene(MemoryFile(input).path());
    (void)surveyScene(scene);
    const test::Folder files;
    for (const char* name : {"a.ply", "a.spz", "a.sog"}) {
        const SceneTarget& target = findSceneTarget(name);
        try {
            target.write(scene, files.file(name), {});
        } catch (const Error&) {
            if (std::filesystem::exists(files.file(name))) { std::abort(); }
            continue;
        }
        if (target.describeLoss(scene).empty()) { std::abort(); }
        const Scene back = loadScene(files.file(name));
        if (back.size() != scene.size() || !test::isSound(back)) {
            std::fprintf(stderr, "%s: %zu splats of %zu\n", name, back.size(), scene.size());
            std::abort();
        }
    }
}

void readLodMeta(Bytes input) {
    const LodMeta meta = parseLodMeta(std::as_bytes(input), "lod-meta.json");
    for (const LodLevel& level : meta.levels) {
        std::uint64_t splats = 0;
        for (const auto& [file, ranges] : level.chunks) {
            if (file >= meta.files.size() || ranges.empty()) { std::abort(); }
            for (std::uint64_t end = 0; const SplatRange range : ranges) {
                if (range.first < end || range.count == 0) { std::abort(); }
                end = range.first + range.count;
                splats += range.count;
            }
        }
        if (splats != level.splats) { std::abort(); }
    }
}
#ifdef BINOSPLAT_OPENXR
// A script that was read is also queried: before, within and after its keys. The files it names are in a
// folder that does not exist.
void readScript(Bytes input) {
    const simulated::Script script = simulated::Script::parse(textOf(input), "/nowhere/a.script");
    (void)script.stageFromLocal();
    for (const double time_s : {-1e7, -0.5, 0.0, 0.25, 1.0, 2.5, 1e7}) {
        const simulated::State state = script.at(time_s);
        if (!std::isfinite(state.stage_from_head.position.x) ||
            !std::isfinite(state.stage_from_head.orientation.w)) {
            std::abort();
        }
    }
    if (script.eventsIn(-1e7, 1e7).size() != script.events.size()) { std::abort(); }
}
#endif

// "scene" takes any file: .splat, gzip, and what tells the formats apart.
constexpr auto kTargets = std::to_array<Target>({
    {"scene", readScene},
    // Files begin as their format requires, so that no time is spent on finding that out.
    {"ply", [](Bytes input) { readScene("ply\n" + textOf(input)); }},
    // The stream before compression, since a fuzzer does not find its way through gzip.
    {"spz", [](Bytes input) { readScene(test::deflated("NGSP" + textOf(input), MAX_WBITS + 16, 1)); }},
    // Without gzip: versions 2 and 3, and the container of version 4.
    {"spz_bare", [](Bytes input) { readScene("NGSP" + textOf(input)); }},
    {"convert", convert},
    {"ksplat", readScene},
    {"gltf", readScene},
    {"sog_meta", [](Bytes input) { (void)parseSogMeta(std::as_bytes(input), "meta.json"); }},
    {"lod_meta", readLodMeta},
#ifdef BINOSPLAT_SOG
    {"sog_bundle", readScene},
#endif
    {"settings", [](Bytes input) { (void)readSettingsFile(MemoryFile(input).path()); }},
    {"headset", [](Bytes input) { (void)readHeadset(MemoryFile(input).path()); }},
    {"cameras", [](Bytes input) { (void)readCameraFile(MemoryFile(input).path(), glm::dvec3(0.0)); }},
    {"motion", [](Bytes input) { (void)parseHeadMotion(textOf(input), "motion.csv", MotionAxes::kUnity); }},
#ifdef BINOSPLAT_OPENXR
    {"script", readScript},
#endif
});

void requireOneLine(std::string_view message) {
    if (!message.empty() && message.find('\n') == std::string_view::npos) { return; }
    std::fprintf(stderr, "not a message as it should be: %.*s\n", static_cast<int>(message.size()),
                 message.data());
    std::abort();
}

}  // namespace

std::span<const Target> targets() { return kTargets; }

void runTarget(const std::string& name, Bytes input) {
    for (const Target& target : kTargets) {
        if (target.name != name) { continue; }
        try {
            target.read(input);
        } catch (const Error& error) {
            requireOneLine(error.what());
#ifdef BINOSPLAT_OPENXR
        } catch (const simulated::ScriptError& error) {
            requireOneLine(error.what());
#endif
        }
        return;
    }
    std::fprintf(stderr, "no target %s\n", name.c_str());
    std::abort();
}

}  // namespace binosplat::fuzz
