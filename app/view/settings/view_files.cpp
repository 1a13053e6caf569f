// Saving and loading from the panel.
#include "app/view/settings/view_files.h"

#include "app/options/option_layers.h"
#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/error.h"
#include "engine/platform.h"
#include "engine/setup/output_files.h"

#include <algorithm>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

fs::path configFolder() { return viewFolder() / "scenes"; }

// FNV-1a: the same for the same scene in every run.
std::uint64_t fingerprint(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (const char letter : text) { hash = (hash ^ static_cast<std::uint8_t>(letter)) * 0x100000001b3; }
    return hash;
}

// File names have at most 255 bytes. Cut between letters (UTF-8); scenes whose names begin alike differ in
// their fingerprints.
std::string withRoomFor(std::size_t more_bytes, std::string name) {
    std::size_t bytes = std::min(name.size(), std::size_t{255} - more_bytes);
    while (bytes > 0 && bytes < name.size() && (static_cast<std::uint8_t>(name[bytes]) & 0xc0) == 0x80) {
        --bytes;
    }
    name.resize(bytes);
    return name;
}

std::vector<SettingsTable> viewTables(std::vector<SettingsTable> tables) {
    std::erase_if(tables, [](const SettingsTable& table) { return table.name != "view"; });
    return tables;
}

}  // namespace

fs::path viewFolder() {
    const fs::path folder = userConfigFolder();
    check(!folder.empty(), "settings cannot be saved or loaded: neither XDG_CONFIG_HOME nor HOME is set");
    return folder / "binosplat";
}

fs::path viewSettingsFile(const std::string& scene) {
    if (isBuiltin(scene)) {
        return configFolder() / (scene.substr(std::string("builtin:").size()) + ".view.toml");
    }
    std::error_code ignored;
    fs::path place = isAddress(scene) ? fs::path(scene) : fs::weakly_canonical(scene, ignored);
    if (!place.has_filename()) { place = place.parent_path(); }
    const std::uintmax_t bytes = fs::is_regular_file(place, ignored) ? fs::file_size(place, ignored) : 0;
    const std::string tail =
        fmt::format("-{:016x}.view.toml", fingerprint(fmt::format("{}:{}", place.string(), bytes)));
    return configFolder() / (withRoomFor(tail.size(), place.stem().string()) + tail);
}

fs::path viewFileStem(const std::string& scene) {
    const fs::path settings = viewSettingsFile(scene);
    return settings.parent_path() / settings.stem().stem();
}

RememberedPlace rememberedPlace(const std::string& scene) {
    const fs::path file = viewSettingsFile(scene);
    std::error_code ignored;
    if (!fs::exists(file, ignored)) { return {}; }
    const ViewSettings saved = readViewSettings(viewTables(readSettingsFile(file)), {});
    return {saved.scene_from_room, saved.metres_per_unit};
}

std::string saveViewSettings(const std::string& scene, const ViewSettings& settings) {
    try {
        const fs::path file = viewSettingsFile(scene);
        OutputFiles files(file.parent_path());
        writeText(files.staging() / file.filename(), scenePlaceToml(settings));
        files.publish();
        return "saved as " + file.string();
    } catch (const Error& error) { return error.what(); }
}

SavedSettings readSavedSettings(const std::string& scene) {
    SavedSettings saved;
    try {
        saved.file = viewSettingsFile(scene);
        saved.tables = readSettingsFile(saved.file);
    } catch (const Error& error) { saved.trouble = error.what(); }
    return saved;
}

std::string takeSavedSettings(const SavedSettings& saved, ViewSettings& settings) {
    if (!saved.trouble.empty()) { return saved.trouble; }
    try {
        RunOptions run;
        run.stereo = settings.stereo;
        ViewSettings loaded = readViewSettings(viewTables(saved.tables), settings);
        loaded.stereo = runOptions(configLayer(saved.file, saved.tables, {"view"}), run).stereo;
        settings = loaded;
        return "loaded " + saved.file.string();
    } catch (const Error& error) { return error.what(); }
}

}  // namespace binosplat
