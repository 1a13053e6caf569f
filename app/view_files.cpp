// Saving and loading from the panel.
#include "app/view_files.h"

#include "app/option_layers.h"
#include "engine/error.h"
#include "engine/scene/procedural.h"
#include "engine/setup/output_files.h"

namespace binosplat {

std::filesystem::path viewSettingsFile(const std::string& scene) {
    const std::size_t prefix = std::string("builtin:").size();
    std::filesystem::path path = isBuiltin(scene) ? scene.substr(prefix) : scene;
    if (!path.has_filename()) { path = path.parent_path(); }
    return path.stem().string() + ".view.toml";
}

std::string saveViewSettings(const std::filesystem::path& file, const ViewSettings& settings) {
    try {
        OutputFiles files(std::filesystem::current_path());
        writeText(files.staging() / file, viewSettingsToml(settings));
        files.publish();
        return "saved as " + file.string();
    } catch (const Error& error) { return error.what(); }
}

std::string loadViewSettings(const std::filesystem::path& file, ViewSettings& settings) {
    try {
        const std::vector<SettingsTable> tables = readSettingsFile(file);
        std::vector<SettingsTable> view;
        for (const SettingsTable& table : tables) {
            if (table.name == "view") { view.push_back(table); }
        }
        RunOptions run;
        run.stereo = settings.stereo;
        ViewSettings loaded = readViewSettings(view, settings);
        loaded.stereo = runOptions(configLayer(file, tables, {"view"}), run).stereo;
        settings = loaded;
        return "loaded " + file.string();
    } catch (const Error& error) { return error.what(); }
}

}  // namespace binosplat
