// Unpacks into a temporary file: formats want to look at a file's beginning first, and some at its end.
#include "engine/files/packed_scene.h"

#include "engine/error.h"
#include "engine/files/gzip.h"
#include "engine/files/scene_files.h"
#include "engine/files/zip_archive.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>
#include <vector>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

// Anything that grows more than this is meant to fill the disk, as with SPZ.
constexpr std::uint64_t kMostGrowth = 256, kAlwaysAllowedBytes = 65536;
constexpr std::uint64_t kUnpackedPieceBytes = std::uint64_t{1} << 20;
constexpr std::size_t kMostNames = 3;  // in a message
constexpr const char* kExpected = "one with a scene in it";

// The second is that of an empty archive.
bool isZip(InputFile& file) {
    return file.peek(4) == std::string_view("PK\x03\x04", 4) ||
           file.peek(4) == std::string_view("PK\x05\x06", 4);
}

// Some Windows writers put backslashes between folders.
std::string fileNameOf(const std::string& path) { return path.substr(path.find_last_of("/\\") + 1); }

bool isNamed(const std::string& path, std::string_view name) { return fileNameOf(path) == name; }

std::string extensionOf(const fs::path& file) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](char c) {
        return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    });
    return extension;
}

bool hasPlainSceneName(const fs::path& file) {
    static constexpr std::array<std::string_view, 7> kExtensions{".ply", ".splat", ".ksplat", ".spz",
                                                                 ".sog", ".gltf",  ".glb"};
    return std::ranges::find(kExtensions, extensionOf(file)) != kExtensions.end();
}

// Without folders, hidden files and the extra files of macOS.
std::vector<std::string> filesIn(const ZipArchive& archive) {
    std::vector<std::string> files = archive.names();
    std::erase_if(files, [](const std::string& name) {
        const std::string file = fileNameOf(name);
        return file.empty() || file.starts_with('.') || name.starts_with("__MACOSX/");
    });
    return files;
}

bool isLevels(const std::string& path) { return isNamed(path, "lod-meta.json"); }

std::string findScene(const std::string& path, std::vector<std::string> files) {
    check(std::ranges::none_of(files, isLevels),
          "{}: a streamed SOG scene in a zip archive, expected it unpacked", path);
    const std::size_t count = files.size();
    if (count > 1) {
        std::erase_if(files, [](const std::string& name) { return !hasPlainSceneName(name); });
    }
    check(!files.empty(),
          "{}: a zip archive of {} files without a scene or the meta.json of one, expected one scene", path,
          count);
    std::string shown;
    for (std::size_t i = 0; i < std::min(files.size(), kMostNames); ++i) {
        shown += (i == 0 ? "" : ", ") + files[i];
    }
    check(files.size() == 1, "{}: a zip archive with {} scenes ({}{}), expected one: unpack it and choose",
          path, files.size(), shown, files.size() > kMostNames ? ", ..." : "");
    return files.front();
}

std::uint64_t mostUnpacked(const InputFile& packed) {
    return kMostGrowth * packed.sizeBytes() + kAlwaysAllowedBytes;
}

// Writes what `read` gives, as far as `how` asks for it, to a file that messages call `name`. `told_bytes`:
// the length that it claims.
template <typename Read>
std::unique_ptr<InputFile> unpack(const InputFile& packed, const std::string& name, std::uint64_t told_bytes,
                                  const Unpacking& how, const Read& read) {
    TemporaryFolder folder("binosplat-unpacked-", "a packed scene");
    constexpr const char* kName = "scene";
    const std::uint64_t most_bytes = mostUnpacked(packed);
    DiskSpace space(folder.path(), how.space);
    std::uint64_t done = 0;
    const auto requireSpace = [&](std::uint64_t more) {
        const bool fits = space.holds(done, more);  // which may look again
        check(fits, "{}: needs at least {} bytes unpacked, but only {} are free in {}; free some space", name,
              done + more, space.bytes(), folder.path().parent_path().string());
    };
    const auto requireWritten = [&](bool written) {
        check(written, "{}: cannot be unpacked into {}: {}", name, folder.path().string(),
              std::strerror(errno));
    };
    requireSpace(std::min(told_bytes, how.first_bytes));
    File target = createFile(folder.path() / kName);
    requireWritten(target != nullptr);
    std::vector<std::byte> piece(static_cast<std::size_t>(std::min(kUnpackedPieceBytes, how.first_bytes)));
    while (const std::size_t got = done < how.first_bytes ? read(std::span(piece)) : 0) {
        check(done + got <= most_bytes,
              "{}: is longer than {} bytes unpacked, expected at most {} times as many as packed", name,
              most_bytes, kMostGrowth);
        requireSpace(got);
        requireWritten(std::fwrite(piece.data(), 1, got, target.get()) == got);
        done += got;
    }
    requireWritten(std::fclose(target.release()) == 0);
    packed.requireUnchanged();
    return std::make_unique<InputFile>(std::move(folder), kName, name);
}

std::unique_ptr<InputFile> unpackEntry(const InputFile& packed, const ZipArchive& archive,
                                       const ZipArchive::Entry& entry, const Unpacking& how,
                                       const Progress& progress) {
    ZipReader stream(archive, entry);
    double done = 0.0;
    return unpack(packed, entry.place, entry.size_bytes, how, [&](std::span<std::byte> target) {
        if (progress) { progress(std::min(done / static_cast<double>(entry.size_bytes), 1.0)); }
        const std::size_t got = stream.read(target);
        done += static_cast<double>(got);
        return got;
    });
}

// The neighbours of a packed scene: in the same folder of its archive, or, without an archive, beside the
// packed file.
class FilesBeside final : public SceneFiles {
public:
    FilesBeside(std::unique_ptr<InputFile> packed, std::unique_ptr<ZipArchive> archive, std::string folder)
        : packed_(std::move(packed)), archive_(std::move(archive)), folder_(std::move(folder)) {}

    std::unique_ptr<InputFile> open(const std::string& name, std::uint64_t most_bytes) override {
        if (name.empty()) { return unpackScene(packed_->again()(), {}); }
        if (archive_ == nullptr) { return packed_->others()->open(name, most_bytes); }
        // Finds names that were written with backslashes, too.
        const std::vector<std::string> names = archive_->names();
        const auto found = std::ranges::find(names, withSlashes(folder_ + name), withSlashes);
        const ZipArchive::Entry entry = archive_->find(found != names.end() ? *found : folder_ + name);
        check(entry.size_bytes <= most_bytes, "{}: is {} bytes long, expected at most {}", entry.place,
              entry.size_bytes, most_bytes);
        std::unique_ptr<InputFile> file = unpackEntry(*packed_, *archive_, entry, {}, {});
        // Entries may share their bytes, and a scene may name one as often as it likes.
        unpacked_bytes_ += file->sizeBytes();
        check(unpacked_bytes_ <= mostUnpacked(*packed_),
              "{}: the files that it names are longer than {} bytes unpacked, expected at most {} times as "
              "many as packed",
              packed_->name(), mostUnpacked(*packed_), kMostGrowth);
        return file;
    }
    void expect(const std::vector<std::string>& names, std::uint64_t most_bytes) override {
        if (archive_ == nullptr) { packed_->others()->expect(names, most_bytes); }
    }
    std::string place(const std::string& name) const override {
        return archive_ == nullptr ? packed_->others()->place(name) : packed_->name() + ": " + folder_ + name;
    }

private:
    static std::string withSlashes(std::string path) {
        std::ranges::replace(path, '\\', '/');
        return path;
    }

    std::unique_ptr<InputFile> packed_;
    std::unique_ptr<ZipArchive> archive_;
    std::string folder_;  // in the archive, with its slash
    std::uint64_t unpacked_bytes_ = 0;
};

}  // namespace

bool hasSceneName(const fs::path& file) {
    const std::string extension = extensionOf(file);
    return hasPlainSceneName(file) || extension == ".zip" ||
           (extension == ".gz" && hasPlainSceneName(file.stem()));
}

bool mayHaveScene(const fs::path& file) {
    return hasSceneName(file) || std::ranges::none_of(extensionOf(file), [](char letter) {
               return letter >= 'a' && letter <= 'z';
           });
}

bool isPacked(InputFile& file) {
    if (isZip(file)) {
        if (!ZipArchive::kIsBuiltIn) { return false; }  // SOG's reader says so
        const std::vector<std::string> files = filesIn(ZipArchive(file.name(), kExpected, file.again()));
        const bool is_sog =
            std::ranges::any_of(files, [](const std::string& name) { return isNamed(name, "meta.json"); });
        return !is_sog || std::ranges::any_of(files, isLevels);
    }
    const std::vector<std::byte> start = peekGzip(file, 4);
    return !start.empty() && std::memcmp(start.data(), "NGSP", start.size()) != 0;
}

std::unique_ptr<InputFile> unpackScene(std::unique_ptr<InputFile> file, const Progress& progress,
                                       const Unpacking& how) {
    std::unique_ptr<InputFile> unpacked;
    if (!isZip(*file)) {
        GzipReader stream(*file);
        unpacked = unpack(*file, file->name(), 0, how, [&](std::span<std::byte> target) {
            if (progress) {
                progress(1.0 -
                         static_cast<double>(file->bytesLeft()) / static_cast<double>(file->sizeBytes()));
            }
            std::size_t got = stream.read(target);
            while (got < target.size() && stream.next()) { got += stream.read(target.subspan(got)); }
            return got;
        });
        if (file->others() != nullptr) {
            unpacked->takeOthers(std::make_unique<FilesBeside>(std::move(file), nullptr, ""));
        }
        return unpacked;
    }
    auto archive = std::make_unique<ZipArchive>(file->name(), kExpected, file->again());
    const std::string name = findScene(file->name(), filesIn(*archive));
    unpacked = unpackEntry(*file, *archive, archive->find(name), how, progress);
    unpacked->takeOthers(std::make_unique<FilesBeside>(std::move(file), std::move(archive),
                                                       name.substr(0, name.find_last_of("/\\") + 1)));
    return unpacked;
}

std::unique_ptr<InputFile> openUnpacked(const std::string& path, const Unpacking& how) {
    auto file = std::make_unique<InputFile>(path);
    return isPacked(*file) ? unpackScene(std::move(file), {}, how) : std::move(file);
}

}  // namespace binosplat
