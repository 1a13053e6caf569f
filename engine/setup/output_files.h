// Files that appear all together or not at all: they are written in a hidden folder beside their place and
// moved at the end.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace binosplat {

class OutputFiles {
public:
    // Makes `folder` (with its parents) and checks that it can be written. Throws Error otherwise, naming the
    // folder.
    explicit OutputFiles(const std::filesystem::path& folder);
    OutputFiles(const OutputFiles&) = delete;
    OutputFiles& operator=(const OutputFiles&) = delete;

    // Removes unpublished files, and the folders made for them.
    ~OutputFiles();

    // Where to write files for now, under their final names. The hidden folder is made by the first call, so
    // that a run that is stopped before it has anything to write leaves none.
    [[nodiscard]] const std::filesystem::path& staging();

    // Moves every staged file into the folder, replacing files of the same name. Throws Error if one cannot
    // be moved.
    void publish();

private:
    void makeStaging();
    void removeUnpublished() noexcept;

    std::filesystem::path folder_;
    std::filesystem::path staging_;
    // Outermost first; they are removed again if nothing is published.
    std::vector<std::filesystem::path> made_folders_;
};

// Writes `text` as a whole file and checks that it reached the disk. Throws Error naming the file.
void writeText(const std::filesystem::path& path, const std::string& text);

}  // namespace binosplat
