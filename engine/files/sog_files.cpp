// Reads a directory through InputFile or SceneFiles, and an archive through ZipArchive; libzip also makes
// one.
#include "engine/files/sog_files.h"

#include "engine/error.h"
#include "engine/files/zip_archive.h"

#include <filesystem>
#include <optional>
#include <string_view>

#ifdef BINOSPLAT_SOG
#include <zip.h>
#endif

namespace binosplat {

namespace {

constexpr const char* kMetaName = "meta.json";

void requirePlainName(const std::string& place, const std::string& name) {
    const bool plain = !name.empty() && name != "." && name != ".." && name.size() < 256 &&
                       name.find_first_of(std::string_view("/\\:\0", 4)) == std::string::npos;
    check(plain, "{}: names a file that is not beside it, expected a plain file name", place);
}

class FolderFiles final : public SogFiles {
public:
    explicit FolderFiles(std::string folder) : folder_(std::move(folder)) {}

    std::vector<std::byte> read(const std::string& name, std::uint64_t max_bytes) override {
        requirePlainName(place("meta.json"), name);
        return InputFile(place(name)).readWhole(max_bytes);
    }
    std::uint64_t sizeBytes(const std::string& name) const override {
        requirePlainName(place("meta.json"), name);
        return InputFile(place(name)).sizeBytes();
    }
    std::string place(const std::string& name) const override {
        return (std::filesystem::path(folder_) / name).string();
    }

private:
    std::string folder_;
};

class ElsewhereFiles final : public SogFiles {
public:
    ElsewhereFiles(SceneFiles& files, std::string meta) : files_(files), meta_(std::move(meta)) {}

    std::vector<std::byte> read(const std::string& name, std::uint64_t max_bytes) override {
        return files_.open(whole(name), max_bytes)->readWhole(max_bytes);
    }
    std::uint64_t sizeBytes(const std::string& name) const override {
        return files_.open(whole(name))->sizeBytes();
    }
    void expect(const std::vector<std::string>& names, std::uint64_t max_bytes) override {
        std::vector<std::string> all;
        for (const std::string& name : names) { all.push_back(whole(name)); }
        files_.expect(all, max_bytes);
    }
    std::string place(const std::string& name) const override {
        return files_.place(name == kMetaName ? meta_ : folder() + name);
    }

private:
    // meta.json may have another name there.
    std::string whole(const std::string& name) const {
        requirePlainName(place(kMetaName), name);
        return name == kMetaName ? meta_ : folder() + name;
    }
    std::string folder() const { return meta_.substr(0, meta_.rfind('/') + 1); }  // with its slash

    SceneFiles& files_;
    std::string meta_;
};

#ifdef BINOSPLAT_SOG

struct ArchiveCloser {
    void operator()(zip_t* archive) const { zip_discard(archive); }
};
struct SourceCloser {
    void operator()(zip_source_t* source) const { zip_source_free(source); }
};
constexpr zip_uint16_t kFirstDosDate = 1 << 5 | 1;  // 1 January 1980

#endif

class BundleFiles final : public SogFiles {
public:
    BundleFiles(std::string path, std::uint64_t size_bytes, ZipArchive::Open open)
        : path_(std::move(path)), size_bytes_(size_bytes), archive_(path_, "a .sog bundle", std::move(open)) {
        findPrefix();
    }

    std::vector<std::byte> read(const std::string& name, std::uint64_t max_bytes) override {
        const ZipArchive::Entry entry = find(name);
        // Pictures are compressed already and meta.json is text: anything that grows a hundredfold is meant
        // to fill the memory.
        const std::uint64_t bound = std::min(max_bytes, 100 * size_bytes_);
        check(entry.size_bytes <= bound, "{}: is {} bytes long, expected at most {}", place(name),
              entry.size_bytes, bound);
        ZipReader opened(archive_, entry);
        std::vector<std::byte> bytes(entry.size_bytes);
        const std::size_t got = opened.read(bytes);
        check(got == bytes.size(), "{}: ends after {} of {} bytes", place(name), got, entry.size_bytes);
        // The checksum is compared at the end of the entry.
        std::byte behind{};
        check(opened.read({&behind, 1}) == 0, "{}: is longer than its {} bytes", place(name),
              entry.size_bytes);
        return bytes;
    }
    std::uint64_t sizeBytes(const std::string& name) const override { return find(name).size_bytes; }
    void close() override { archive_.close(); }
    std::string place(const std::string& name) const override { return path_ + ": " + prefix_ + name; }

private:
    // Some archives hold the folder instead of its files: all files are looked up beside meta.json, the one
    // with the shortest path if there are several.
    void findPrefix() {
        constexpr std::string_view kMeta = kMetaName;
        std::optional<std::string> found;
        for (const std::string& name : archive_.names()) {
            if (!name.ends_with(kMeta)) { continue; }
            // Some Windows writers put backslashes between folders.
            const std::string_view folder = std::string_view(name).substr(0, name.size() - kMeta.size());
            const bool is_meta = folder.empty() || folder.ends_with('/') || folder.ends_with('\\');
            if (is_meta && (!found || name.size() < found->size())) { found = name; }
        }
        check(found.has_value(), "{}: a zip archive without a meta.json, expected a .sog bundle", path_);
        prefix_ = found->substr(0, found->size() - kMeta.size());
    }

    ZipArchive::Entry find(const std::string& name) const {
        requirePlainName(place(kMetaName), name);
        return archive_.find(prefix_ + name);
    }

    std::string path_, prefix_;
    std::uint64_t size_bytes_;
    ZipArchive archive_;
};

}  // namespace

std::unique_ptr<SogFiles> openSogFolder(const std::string& folder) {
    return std::make_unique<FolderFiles>(folder);
}

std::unique_ptr<SogFiles> openSogFolder(SceneFiles& files, const std::string& meta) {
    return std::make_unique<ElsewhereFiles>(files, meta);
}

std::unique_ptr<SogFiles> openSogBundle(const InputFile& file) {
    return std::make_unique<BundleFiles>(file.name(), file.sizeBytes(), file.again());
}

std::unique_ptr<SogFiles> openSogBundle(SceneFiles& files, const std::string& bundle) {
    const std::uint64_t size_bytes = files.open(bundle)->sizeBytes();
    return std::make_unique<BundleFiles>(files.place(bundle), size_bytes,
                                         [&files, bundle] { return files.open(bundle); });
}

#ifdef BINOSPLAT_SOG

std::vector<std::byte> packSogBundle(const std::vector<NamedBytes>& files, const std::string& place) {
    const auto require = [&](bool done) { check(done, "{}: libzip cannot make the archive", place); };
    zip_error_t error;
    zip_error_init(&error);
    const std::unique_ptr<zip_source_t, SourceCloser> target(zip_source_buffer_create(nullptr, 0, 0, &error));
    require(target != nullptr);
    // A reference for the archive, which releases its own even if it is not opened.
    zip_source_keep(target.get());
    std::unique_ptr<zip_t, ArchiveCloser> archive(zip_open_from_source(target.get(), ZIP_TRUNCATE, &error));
    if (archive == nullptr) { zip_source_free(target.get()); }
    require(archive != nullptr);
    for (const NamedBytes& file : files) {
        zip_source_t* bytes = zip_source_buffer(archive.get(), file.bytes.data(), file.bytes.size(), 0);
        require(bytes != nullptr);
        const zip_int64_t entry = zip_file_add(archive.get(), file.name.c_str(), bytes, ZIP_FL_ENC_UTF_8);
        if (entry < 0) { zip_source_free(bytes); }
        require(entry >= 0);
        const auto index = static_cast<zip_uint64_t>(entry);
        require(zip_set_file_compression(archive.get(), index, ZIP_CM_STORE, 0) == 0);
        require(zip_file_set_dostime(archive.get(), index, 0, kFirstDosDate, 0) == 0);
    }
    require(zip_close(archive.get()) == 0);
    (void)archive.release();  // closed
    zip_stat_t size;
    zip_stat_init(&size);
    require(zip_source_stat(target.get(), &size) == 0 && (size.valid & ZIP_STAT_SIZE) != 0 &&
            zip_source_open(target.get()) == 0);
    std::vector<std::byte> bundle(size.size);
    const zip_int64_t got = zip_source_read(target.get(), bundle.data(), bundle.size());
    zip_source_close(target.get());
    require(got == static_cast<zip_int64_t>(bundle.size()));
    return bundle;
}

#else

std::vector<std::byte> packSogBundle(const std::vector<NamedBytes>&, const std::string& place) {
    fail("{}: cannot be written, this build is without libzip", place);
}

#endif

}  // namespace binosplat
