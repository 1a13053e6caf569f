// Finds the files that come with the program.
#include "engine/setup/data_folders.h"

namespace binosplat {

namespace fs = std::filesystem;

std::vector<fs::path> dataFolders() {
    std::vector<fs::path> folders;
    if (const std::string chosen = environment("BINOSPLAT_DATA"); !chosen.empty()) {
        folders.emplace_back(chosen);
    }
    std::error_code gone;
    if (const fs::path here = fs::current_path(gone); !gone) { folders.push_back(here); }
    const fs::path program = programFile();
    for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
        folders.push_back(folder);
    }
    if (!program.empty()) { folders.push_back(program.parent_path().parent_path() / "share" / "binosplat"); }
    return folders;
}

fs::path givenOrShipped(const fs::path& name) {
    if (name.empty() || *name.begin() != "configs") { return name; }
    std::error_code unknown;
    if (fs::exists(name, unknown)) { return name; }
    for (const fs::path& root : dataFolders()) {
        if (fs::exists(root / name, unknown)) { return root / name; }
    }
    return name;
}

}  // namespace binosplat
