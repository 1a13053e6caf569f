// Paths, links and addresses of chunks.
#include "engine/files/streamed_chunks.h"

#include "engine/error.h"
#include "engine/files/scene_files.h"
#include "engine/files/sog_files.h"

#include <algorithm>
#include <system_error>
#include <vector>

namespace binosplat {

namespace fs = std::filesystem;

namespace {

// Enough for a hundred thousand leaves of five levels.
constexpr std::uint64_t kMaxLodMetaBytes = std::uint64_t{1} << 25;

fs::path folderOf(const std::string& file) {
    const fs::path path(file);
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

bool isBundle(const fs::path& path) { return path.extension() == ".sog"; }

}  // namespace

StreamedChunks::StreamedChunks(const fs::path& folder, const std::string& name) : folder_(folder) {
    const std::unique_ptr<SogFiles> files = openSogFolder(folder.string());
    place_ = files->place(name);
    meta_ = parseLodMeta(files->read(name, kMaxLodMetaBytes), place_);
}

StreamedChunks::StreamedChunks(const std::string& folder)
    : StreamedChunks(fs::path(folder), "lod-meta.json") {}

StreamedChunks::StreamedChunks(InputFile& file)
    : StreamedChunks(file.others() != nullptr
                         ? StreamedChunks()
                         : StreamedChunks(folderOf(file.name()), fs::path(file.name()).filename().string())) {
    if (file.others() == nullptr) { return; }
    place_ = file.name();
    meta_ = parseLodMeta(file.readWhole(kMaxLodMetaBytes), file.name());
    elsewhere_ = file.others();
}

const std::string& StreamedChunks::path(std::size_t file) const {
    return file == environmentIndex() ? meta_.environment : meta_.files.at(file);
}

void StreamedChunks::expect(std::span<const std::size_t> files) const {
    if (elsewhere_ == nullptr) { return; }
    std::vector<std::string> names;
    for (const std::size_t file : files) { names.push_back(path(file)); }
    elsewhere_->expect(names);
}

SogSplats StreamedChunks::open(std::size_t index) {
    const std::string& name = path(index);
    if (elsewhere_ != nullptr) {
        return SogSplats(isBundle(name) ? openSogBundle(*elsewhere_, name)
                                        : openSogFolder(*elsewhere_, name));
    }
    const std::string place =
        place_ + (index == environmentIndex() ? ": environment" : fmt::format(": filenames[{}]", index));
    const fs::path file = folder_ / name;
    std::error_code error;
    check(fs::is_regular_file(file, error), "{}: {} is not there, expected a chunk of the scene", place,
          file.string());
    const fs::path folder = fs::canonical(folder_, error), real = fs::canonical(file, error);
    check(!error, "{}: {} cannot be read: {}", place, file.string(), error.message());
    check(std::mismatch(folder.begin(), folder.end(), real.begin(), real.end()).first == folder.end(),
          "{}: {} is a link to {}, expected a place within {}", place, file.string(), real.string(),
          folder.string());
    check(opened_.emplace(real, index).first->second == index,
          "{}: {} is a link to a chunk that is named already, expected each chunk once", place,
          file.string());
    SogSplats splats(isBundle(file) ? openSogBundle(InputFile(file.string()))
                                    : openSogFolder(file.parent_path().string()));
    splats.requirePlausibleCount();
    return splats;
}

std::optional<SogSplats> StreamedChunks::openEnvironment() {
    if (!hasEnvironment()) { return std::nullopt; }
    std::error_code error;
    const fs::path file = folder_ / meta_.environment;
    try {
        if (elsewhere_ != nullptr) {
            (void)elsewhere_->open(meta_.environment);
        } else if (!fs::exists(file, error)) {
            missing_environment_ = file.string() + " is not there";
        }
    } catch (const Error& unreachable) { missing_environment_ = unreachable.what(); }
    if (missing_environment_.empty()) { return open(environmentIndex()); }
    meta_.environment.clear();
    return std::nullopt;
}

void StreamedChunks::requireRange(std::size_t file, SplatRange range, const SogSplats& splats) const {
    check(range.first + range.count <= splats.count(),
          "{}: tree: a leaf names splat {} of filenames[{}] ({}), which has {}", place_,
          range.first + range.count - 1, file, path(file), splats.count());
}

}  // namespace binosplat
