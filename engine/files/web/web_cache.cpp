// The names in the folder: FINGERPRINT.json, FINGERPRINT.data, and FINGERPRINT-PROCESS-N.part while a file is
// on its way.
#include "engine/files/web/web_cache.h"

#include "engine/error.h"
#include "engine/part_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <vector>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kLongestNote = 1 << 16;
constexpr int kMostNames = 1000;
// A file that is not a copy, and has not been written to for this long, is no longer on its way.
constexpr std::chrono::hours kOnItsWay(1);

// FNV-1a. Two addresses with the same one merely replace each other, because the note names the address.
std::string fingerprint(const std::string& text) {
    std::uint64_t hash = 0xcbf29ce484222325u;
    for (const char letter : text) { hash = (hash ^ static_cast<std::uint8_t>(letter)) * 0x100000001b3u; }
    return fmt::format("{:016x}", hash);
}

struct Note {
    std::string address;
    FileStamp stamp;  // of the bytes
    FileVersion version;
    std::int64_t fetched_s = 0;
};

constexpr const char *kNote = ".json", *kData = ".data";

// Empty if it does not exist or is incomplete.
std::optional<Note> readNote(const fs::path& path) {
    std::string reason;
    const File file = openRegularFile(path, reason);
    const std::optional<FileStamp> stamp = file ? binosplat::stampOf(file.get()) : std::nullopt;
    if (!stamp || stamp->size_bytes > kLongestNote) { return std::nullopt; }
    std::string text(stamp->size_bytes, '\0');
    text.resize(std::fread(text.data(), 1, text.size(), file.get()));
    try {
        const nlohmann::json json = nlohmann::json::parse(text);
        return Note{json.at("address"),
                    {json.at("bytes"), json.at("changed_s"), json.at("changed_ns")},
                    {json.at("etag"), json.at("last_modified")},
                    json.at("fetched")};
    } catch (const nlohmann::json::exception&) { return std::nullopt; }
}

// Empty if there is no such file.
std::optional<FileStamp> stampOf(const fs::path& path) {
    std::string reason;
    const File file = openRegularFile(path, reason);
    return file ? binosplat::stampOf(file.get()) : std::nullopt;
}

fs::path with(fs::path stem, const char* extension) { return stem += extension; }

std::int64_t secondsNow() {
    return std::chrono::duration_cast<std::chrono::seconds>(
               std::chrono::system_clock::now().time_since_epoch())
        .count();
}

}  // namespace

IncomingFile::IncomingFile(fs::path path, File file)
    : path_(std::move(path)), file_(std::move(file)), space_(path_.parent_path()) {}

IncomingFile::~IncomingFile() {
    file_.reset();
    std::error_code ignored;
    if (!is_kept_) { fs::remove(path_, ignored); }
}

bool IncomingFile::write(const char* data, std::size_t bytes) {
    if (!space_.holds(size_bytes_, bytes) || std::fwrite(data, 1, bytes, file_.get()) != bytes) {
        return false;
    }
    size_bytes_ += bytes;
    return true;
}

WebCache::WebCache(fs::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    if (fs::create_directories(folder_, error)) { fs::permissions(folder_, fs::perms::owner_all, error); }
    check(fs::is_directory(folder_, error),
          "{}: cannot be made a folder for scenes from the web, expected a place to write to",
          folder_.string());
}

fs::path WebCache::stemOf(const std::string& address) const { return folder_ / fingerprint(address); }

std::unique_ptr<IncomingFile> WebCache::begin(const std::string& address) const {
    for (int attempt = 0; attempt < kMostNames; ++attempt) {
        fs::path path = with(stemOf(address), fmt::format("-{}-{}.part", processId(), attempt).c_str());
        if (File file = createFile(path)) {
            return std::make_unique<IncomingFile>(std::move(path), std::move(file));
        }
        if (errno != EEXIST) { break; }
    }
    return nullptr;
}

fs::path WebCache::keep(const std::string& address, std::unique_ptr<IncomingFile> file,
                        const FileVersion& version) const {
    const fs::path stem = stemOf(address), data = with(stem, kData);
    check(std::fclose(file->file_.release()) == 0, "{}: cannot be kept in {}: {}", address, folder_.string(),
          std::strerror(errno));
    const std::optional<FileStamp> stamp = stampOf(file->path_);
    std::error_code error;
    if (stamp) { fs::rename(file->path_, data, error); }
    check(stamp && !error, "{}: cannot be kept in {}: {}", address, folder_.string(), error.message());
    file->is_kept_ = true;
    const std::string text = nlohmann::json{
        {"address", address},
        {"bytes", stamp->size_bytes},
        {"changed_s", stamp->changed_s},
        {"changed_ns", stamp->changed_ns},
        {"etag", version.etag},
        {"last_modified", version.last_modified},
        {"fetched",
         secondsNow()}}.dump(1, ' ', false, nlohmann::json::error_handler_t::replace);
    PartFile note(with(stem, kNote).string());
    note.write(text.data(), text.size());
    note.commit();
    return data;
}

std::optional<KeptCopy> WebCache::find(const std::string& address) const {
    const fs::path stem = stemOf(address), data = with(stem, kData);
    const std::optional<Note> note = readNote(with(stem, kNote));
    if (!note || note->address != address || stampOf(data) != note->stamp) { return std::nullopt; }
    std::error_code ignored;
    fs::last_write_time(with(stem, kNote), fs::file_time_type::clock::now(), ignored);
    return KeptCopy{data, note->version, note->fetched_s};
}

void WebCache::trim(std::uint64_t most_bytes) const noexcept {
    struct Copy {
        fs::file_time_type used;
        fs::path note, data;
        std::uint64_t bytes = 0;
    };
    try {
        std::error_code error;
        std::vector<fs::path> files;
        for (fs::directory_iterator entry(folder_, error), end; !error && entry != end;
             entry.increment(error)) {
            files.push_back(entry->path());
        }
        std::vector<Copy> copies;
        std::uint64_t total_bytes = 0;
        for (const fs::path& path : files) {
            const fs::path note = fs::path(path).replace_extension(kNote),
                           data = fs::path(path).replace_extension(kData);
            const auto used = fs::last_write_time(path, error);
            if (error) { continue; }
            if (path.extension() == kNote && fs::exists(data, error)) {
                copies.push_back({used, note, data, fs::file_size(note, error) + fs::file_size(data, error)});
                total_bytes += copies.back().bytes;
                continue;
            }
            // Bytes are put in place before their note, and a note that has lost its bytes does not get
            // others.
            const bool is_copy = path.extension() == kData && fs::exists(note, error);
            const bool is_on_its_way =
                path.extension() != kNote && used > fs::file_time_type::clock::now() - kOnItsWay;
            if (!is_copy && !is_on_its_way) { fs::remove(path, error); }
        }
        std::ranges::sort(copies, {}, &Copy::used);
        for (const Copy& copy : copies) {
            if (total_bytes <= most_bytes) { break; }
            fs::remove(copy.note, error);
            fs::remove(copy.data, error);
            total_bytes -= copy.bytes;
        }
    } catch (const std::exception&) {}  // the next one will
}

}  // namespace binosplat
