// The source of a streamed scene: a folder, its lod-meta.json, or the address of one. Gives its tree, and its
// chunks one by one.
#pragma once

#include "engine/files/streamed_chunks.h"
#include "engine/files/web/web_files.h"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace binosplat {

// True if `source` is a streamed scene: judges a folder or file by its content, an address by its name.
// Throws Error for a file that cannot be read.
bool isStreamedScene(const std::string& source);

// For one thread at a time.
class ChunkSource {
public:
    // `waiting` is called now and then while waiting for an address, as in WebFiles. Throws Error if
    // lod-meta.json cannot be loaded, if it or the environment is broken, and in a build that cannot decode
    // WebP.
    ChunkSource(const std::string& source, const WebSettings& web, const Progress& waiting = {});

    [[nodiscard]] const std::string& name() const { return name_; }
    // With an environment, one more than the tree's: around everything, with one level, level 0.
    [[nodiscard]] std::span<const LodLeaf> leaves() const { return leaves_; }
    [[nodiscard]] const LodMeta& meta() const { return chunks_->meta(); }
    [[nodiscard]] std::uint64_t environmentSplats() const { return environment_splats_; }
    [[nodiscard]] std::size_t fileCount() const { return chunks_->environmentIndex() + 1; }
    // See WebFiles; 0 and empty for scenes on the disk.
    [[nodiscard]] std::uint64_t failedFetches() const { return web_ ? web_->failedCount() : 0; }
    [[nodiscard]] std::string stale() const { return web_ ? web_->stale() : std::string(); }

    // Replaces `waiting` from now on. It may throw.
    void callWhileWaiting(Progress call) { while_waiting_ = std::move(call); }
    // The LodRange::file of each chunk that will be opened soon.
    void expect(std::span<const std::size_t> files) { chunks_->expect(files); }
    // Throws Error if it cannot be loaded or is broken.
    [[nodiscard]] SogSplats open(std::size_t file) { return chunks_->open(file); }
    void requireRange(std::size_t file, SplatRange range, const SogSplats& splats) const {
        chunks_->requireRange(file, range, splats);
    }

private:
    std::string name_;
    Progress while_waiting_;
    std::unique_ptr<WebFiles> web_;
    std::unique_ptr<InputFile> meta_file_;  // from the web; its name and files are those of the chunks
    std::unique_ptr<StreamedChunks> chunks_;
    std::vector<LodLeaf> leaves_;
    std::uint64_t environment_splats_ = 0;
};

}  // namespace binosplat
