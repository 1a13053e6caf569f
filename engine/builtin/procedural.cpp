// The table of built-in scenes.
#include "engine/builtin/procedural.h"

#include "engine/builtin/builtin.h"
#include "engine/error.h"

#include <array>

namespace binosplat {

namespace {

constexpr std::string_view kPrefix = "builtin:";

struct Entry {
    const char* name;
    const char* what;
    std::uint64_t default_splats, min_splats, max_splats;
    Scene (*make)(std::uint64_t splats, const Progress& progress);
    View (*view)();
};

template <Scene (*kMake)()>
Scene makeFixed(std::uint64_t, const Progress& progress) {
    Scene scene = kMake();
    if (progress) { progress(1.0); }
    return scene;
}

View viewFromOrigin() { return {{0.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}, 60.0}; }

constexpr std::uint64_t kWallSplats = 121 * 121;
constexpr std::array<Entry, 6> kEntries{{
    {"atelier", "a furnished room with a window onto hills", 200'000, 1'000, 40'000'000, builtin::makeAtelier,
     builtin::atelierView},
    {"one-splat", "one disc", 1, 1, 1, makeFixed<builtin::makeOneSplat>, viewFromOrigin},
    {"slanted-wall", "a wall at 45 degrees", 41 * 41, 41 * 41, 41 * 41, makeFixed<builtin::makeSlantedWall>,
     viewFromOrigin},
    {"two-layers", "a translucent disc in front of another", 2, 2, 2, makeFixed<builtin::makeTwoLayers>,
     viewFromOrigin},
    {"step-edge", "a near wall that ends in front of a far one", 30 * 61 + kWallSplats, 30 * 61 + kWallSplats,
     30 * 61 + kWallSplats, makeFixed<builtin::makeStepEdge>, viewFromOrigin},
    {"fence", "thin bars in front of a wall", 9 * 81 + kWallSplats, 9 * 81 + kWallSplats,
     9 * 81 + kWallSplats, makeFixed<builtin::makeFence>, viewFromOrigin},
}};

const Entry* findEntry(std::string_view name) {
    if (name.starts_with(kPrefix)) { name.remove_prefix(kPrefix.size()); }
    for (const Entry& entry : kEntries) {
        if (name == entry.name) { return &entry; }
    }
    return nullptr;
}

}  // namespace

std::vector<BuiltinInfo> listBuiltins() {
    std::vector<BuiltinInfo> list;
    for (const Entry& entry : kEntries) {
        list.push_back({entry.name, entry.what, entry.default_splats, entry.min_splats, entry.max_splats});
    }
    return list;
}

bool isBuiltin(const std::string& source) { return source.starts_with(kPrefix); }

std::optional<View> builtinView(const std::string& name) {
    const Entry* entry = findEntry(name);
    return entry != nullptr ? std::optional(entry->view()) : std::nullopt;
}

Scene makeBuiltin(const std::string& source, std::uint64_t splats, const Progress& progress) {
    const Entry* entry = findEntry(source);
    if (entry == nullptr) {
        std::string names;
        for (const Entry& known : kEntries) {
            names += (names.empty() ? "" : ", ") + std::string(known.name);
        }
        fail("{}: no such built-in scene, expected one of {}", source, names);
    }
    if (splats == 0) { splats = entry->default_splats; }
    check(splats >= entry->min_splats && splats <= entry->max_splats, "{}: {} splats asked for, expected {}",
          source, splats,
          entry->min_splats == entry->max_splats
              ? fmt::format("{}", entry->min_splats)
              : fmt::format("{} to {}", entry->min_splats, entry->max_splats));
    Scene scene = entry->make(splats, progress);
    scene.name = std::string(kPrefix) + entry->name;
    return scene;
}

}  // namespace binosplat
