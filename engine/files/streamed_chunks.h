// The chunks of a streamed SOG scene: folders or bundles next to a lod-meta.json, on the disk or elsewhere.
#pragma once

#include "engine/files/input_file.h"
#include "engine/files/lod_meta.h"
#include "engine/files/sog_splats.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>

namespace binosplat {

// For one thread at a time.
class StreamedChunks {
public:
    // For a folder that contains a lod-meta.json, or an open lod-meta.json, whose SceneFiles must outlive
    // this. Throws Error if it is broken.
    explicit StreamedChunks(const std::string& folder);
    explicit StreamedChunks(InputFile& file);

    [[nodiscard]] const LodMeta& meta() const { return meta_; }
    // The name of the lod-meta.json in messages.
    [[nodiscard]] const std::string& place() const { return place_; }
    // True if the chunks come through SceneFiles, which may have to fetch them.
    [[nodiscard]] bool areElsewhere() const { return elsewhere_ != nullptr; }
    [[nodiscard]] bool hasEnvironment() const { return !meta_.environment.empty(); }
    // The environment's place, after the meta's files.
    [[nodiscard]] std::size_t environmentIndex() const { return meta_.files.size(); }
    [[nodiscard]] const std::string& path(std::size_t file) const;

    // Says that these files will be opened soon.
    void expect(std::span<const std::size_t> files) const;
    // One of the meta's files. It is within the folder, wherever links lead, and different from all the
    // others. Throws Error naming the file. If it is elsewhere, it is not known yet whether its count is
    // plausible: SogSplats::requirePlausibleCount waits for its pictures.
    [[nodiscard]] SogSplats open(std::size_t file);
    // Empty if the scene has none, or if it cannot be fetched, in which case it has none from now on. Throws
    // Error if it is broken.
    [[nodiscard]] std::optional<SogSplats> openEnvironment();
    // Why an environment could not be fetched; empty if it could, or if there is none.
    [[nodiscard]] const std::string& missingEnvironment() const { return missing_environment_; }
    // Throws Error if this open file ends before the range does.
    void requireRange(std::size_t file, SplatRange range, const SogSplats& splats) const;

private:
    StreamedChunks() = default;
    StreamedChunks(const std::filesystem::path& folder, const std::string& name);

    std::filesystem::path folder_;
    std::string place_, missing_environment_;
    LodMeta meta_;
    SceneFiles* elsewhere_ = nullptr;                      // not in the folder
    std::map<std::filesystem::path, std::size_t> opened_;  // by paths with links resolved
};

}  // namespace binosplat
