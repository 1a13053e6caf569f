// Folders, files and addresses.
#include "engine/stream/chunk_source.h"

#include "engine/address.h"
#include "engine/builtin/procedural.h"
#include "engine/files/streamed_sog.h"

#include <filesystem>
#include <system_error>

namespace binosplat {

namespace {

// Around everything that can be loaded.
constexpr float kEverywhere = 1e6f;

}  // namespace

bool isStreamedScene(const std::string& source) {
    if (isBuiltin(source)) { return false; }
    // The content of an address is unknown until it is fetched, so only one whose name says so counts as a
    // streamed scene.
    if (isAddress(source)) {
        return source.substr(0, source.find_first_of("?#")).ends_with("/lod-meta.json");
    }
    std::error_code unreadable;
    if (std::filesystem::is_directory(source, unreadable)) { return isStreamedSogFolder(source); }
    InputFile file(source);
    return isStreamedSogFile(file);
}

ChunkSource::ChunkSource(const std::string& source, const WebSettings& web, const Progress& waiting)
    : name_(source) {
    requireSogDecoder(source);
    std::error_code unreadable;
    if (isAddress(source)) {
        const auto wait = [this](double share) {
            if (while_waiting_) { while_waiting_(share); }
        };
        while_waiting_ = waiting;
        web_ = std::make_unique<WebFiles>(source, web, wait);
        meta_file_ = web_->open("");
        chunks_ = std::make_unique<StreamedChunks>(*meta_file_);
    } else if (std::filesystem::is_directory(source, unreadable)) {
        chunks_ = std::make_unique<StreamedChunks>(source);
    } else {
        InputFile file(source);
        chunks_ = std::make_unique<StreamedChunks>(file);
    }
    leaves_ = meta().tree;
    if (const std::optional<SogSplats> environment = chunks_->openEnvironment()) {
        environment_splats_ = environment->count();
        const auto file = static_cast<std::uint32_t>(chunks_->environmentIndex());
        if (environment_splats_ > 0) {
            leaves_.push_back(
                {glm::vec3(-kEverywhere), glm::vec3(kEverywhere), {{0, file, {0, environment_splats_}}}});
        }
    }
    while_waiting_ = {};
}

}  // namespace binosplat
