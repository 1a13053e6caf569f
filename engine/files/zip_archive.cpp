// libzip, and its words for what is wrong.
#include "engine/files/zip_archive.h"

#include "engine/error.h"

#ifdef BINOSPLAT_SOG
#include <zip.h>
#endif

#include <utility>

namespace binosplat {

#ifdef BINOSPLAT_SOG

struct ZipArchive::State {
    struct Closer {
        void operator()(zip_t* archive) const { zip_discard(archive); }
    };
    std::string path, expected;
    Open open;
    std::unique_ptr<zip_t, Closer> archive = nullptr;

    zip_t* opened() {
        if (archive != nullptr) { return archive.get(); }
        zip_error_t error;
        zip_error_init(&error);
        File file = open()->release();
        zip_source_t* source = zip_source_filep_create(file.get(), 0, -1, &error);
        if (source != nullptr) { (void)file.release(); }  // closed with the source
        archive.reset(source != nullptr ? zip_open_from_source(source, ZIP_RDONLY, &error) : nullptr);
        if (archive == nullptr) {
            if (source != nullptr) { zip_source_free(source); }
            const std::string reason = zip_error_strerror(&error);
            zip_error_fini(&error);
            fail("{}: not a whole zip archive ({}), expected {}", path, reason, expected);
        }
        return archive.get();
    }
};

ZipArchive::ZipArchive(std::string path, std::string expected, Open open)
    : state_(std::make_unique<State>(State{std::move(path), std::move(expected), std::move(open)})) {}

std::vector<std::string> ZipArchive::names() const {
    std::vector<std::string> names;
    for (zip_int64_t i = 0; i < zip_get_num_entries(state_->opened(), 0); ++i) {
        const char* name = zip_get_name(state_->opened(), static_cast<zip_uint64_t>(i), 0);
        names.emplace_back(name != nullptr ? name : "");
    }
    return names;
}

ZipArchive::Entry ZipArchive::find(const std::string& name) const {
    const std::string place = state_->path + ": " + name;
    const zip_int64_t index = zip_name_locate(state_->opened(), name.c_str(), 0);
    check(index >= 0, "{}: not in the archive", place);
    zip_stat_t entry;
    zip_stat_init(&entry);
    check(zip_stat_index(state_->opened(), static_cast<zip_uint64_t>(index), 0, &entry) == 0 &&
              (entry.valid & ZIP_STAT_SIZE) != 0,
          "{}: its size cannot be read", place);
    check((entry.valid & ZIP_STAT_ENCRYPTION_METHOD) == 0 || entry.encryption_method == ZIP_EM_NONE,
          "{}: is encrypted and asks for a password, expected an archive without one (unpack it first)",
          place);
    return {place, static_cast<std::uint64_t>(index), entry.size};
}

void ZipArchive::close() { state_->archive.reset(); }

struct ZipReader::State {
    struct Closer {
        void operator()(zip_file_t* entry) const { zip_fclose(entry); }
    };
    std::unique_ptr<zip_file_t, Closer> entry;
};

ZipReader::ZipReader(const ZipArchive& archive, const ZipArchive::Entry& entry) : place_(entry.place) {
    zip_t* const opened = archive.state_->opened();
    state_ = std::make_unique<State>();
    state_->entry.reset(zip_fopen_index(opened, entry.index, 0));
    check(state_->entry != nullptr, "{}: cannot be read ({})", place_, zip_strerror(opened));
}

std::size_t ZipReader::read(std::span<std::byte> target) {
    std::size_t done = 0;
    while (done < target.size()) {
        const zip_int64_t got = zip_fread(state_->entry.get(), target.data() + done, target.size() - done);
        check(got >= 0, "{}: cannot be read ({})", place_, zip_file_strerror(state_->entry.get()));
        if (got == 0) { break; }
        done += static_cast<std::size_t>(got);
    }
    return done;
}

#else

struct ZipArchive::State {};

ZipArchive::ZipArchive(std::string path, std::string expected, Open) {
    fail("{}: a zip archive, which this build cannot read as it is without libzip, expected {}, unpacked",
         path, expected);
}
std::vector<std::string> ZipArchive::names() const { return {}; }
ZipArchive::Entry ZipArchive::find(const std::string&) const { return {}; }
void ZipArchive::close() {}

struct ZipReader::State {};
ZipReader::ZipReader(const ZipArchive&, const ZipArchive::Entry&) {}
std::size_t ZipReader::read(std::span<std::byte>) { return 0; }

#endif

ZipArchive::~ZipArchive() = default;
ZipReader::~ZipReader() = default;

}  // namespace binosplat
