// Buffered reading of one file. The buffer is 1 MiB, large enough for full disk speed and small beside any
// scene, or as large as a smaller file needs.
#include "engine/files/input_file.h"

#include "engine/error.h"
#include "engine/files/scene_files.h"
#include "engine/git_lfs.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace binosplat {

namespace {
constexpr std::size_t kMostBufferBytes = std::size_t{1} << 20, kLeastBufferBytes = 4096;
}

std::string_view withoutByteOrderMark(std::string_view start) {
    constexpr std::string_view kMark = "\xef\xbb\xbf";
    if (start.starts_with(kMark)) { start.remove_prefix(kMark.size()); }
    return start;
}

InputFile::InputFile(const std::string& path) : path_(path), name_(path) { open(); }

InputFile::InputFile(const std::filesystem::path& path, std::string name, SceneFiles& others)
    : path_(path), name_(std::move(name)), others_(&others) {
    open();
}

InputFile::InputFile(TemporaryFolder folder, const std::string& file, std::string name)
    : folder_(std::move(folder)), path_(folder_->path() / file), name_(std::move(name)) {
    open();
}

InputFile::~InputFile() = default;

void InputFile::takeOthers(std::unique_ptr<SceneFiles> others) {
    own_others_ = std::move(others);
    others_ = own_others_.get();
}

std::function<std::unique_ptr<InputFile>()> InputFile::again() const {
    if (others_ != nullptr && !folder_) {
        return [others = others_] { return others->open(""); };
    }
    return [path = path_.string()] { return std::make_unique<InputFile>(path); };
}

void InputFile::open() {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(path_, error);
    check(status.type() != std::filesystem::file_type::not_found, "{}: no such file", name_);
    check(!error, "{}: cannot be read: {}", name_, error.message());
    check(status.type() != std::filesystem::file_type::directory, "{}: is a directory, expected a file",
          name_);
    check(status.type() == std::filesystem::file_type::regular,
          "{}: is not a regular file (a pipe or a device), expected a file on disk", name_);
    std::string reason;
    file_ = openRegularFile(path_, reason);
    check(file_ != nullptr, "{}: cannot be opened: {}", name_, reason);
    opened_ = stamp();
    std::setvbuf(file_.get(), nullptr, _IONBF, 0);
    if (sizeBytes() < kLongestLfsPointer) {
        std::array<char, kLfsPointerStart.size()> start{};
        requireNoLfsPointer({start.data(), readAt(0, std::as_writable_bytes(std::span(start)))}, name_);
    }
    // One byte more than a small file, so that its last line does not seem too long because it fills the
    // buffer.
    const auto buffer_bytes = static_cast<std::size_t>(
        std::clamp<std::uint64_t>(sizeBytes() + 1, kLeastBufferBytes, kMostBufferBytes));
    // Stays unused if the file is read in parts.
    room_ = std::make_unique_for_overwrite<char[]>(buffer_bytes);
    buffer_ = {room_.get(), buffer_bytes};
}

FileStamp InputFile::stamp() const {
    const std::optional<FileStamp> stamp = stampOf(file_.get());
    check(stamp.has_value(), "{}: cannot be read: {}", name_, std::strerror(errno));
    return *stamp;
}

void InputFile::requireUnchanged() const {
    check(stamp() == opened_, "{}: was changed while it was read, must stay as it is until then", name_);
}

void InputFile::fillTo(std::size_t count) {
    count = std::min(count, buffer_.size());
    if (end_ - begin_ >= count) { return; }
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
    while (end_ < count) {
        errno = 0;
        const std::size_t got = std::fread(buffer_.data() + end_, 1, buffer_.size() - end_, file_.get());
        check(std::ferror(file_.get()) == 0, "{}: reading failed at byte {}: {}", name_,
              position_bytes_ + end_, std::strerror(errno));
        if (got == 0) { return; }
        end_ += got;
    }
}

std::string_view InputFile::peek(std::size_t count) {
    fillTo(count);
    return {buffer_.data() + begin_, std::min(count, end_ - begin_)};
}

InputFile::LineEnd InputFile::readLine(std::string_view& line) {
    // Most lines are short, so the search starts small and widens to the whole buffer only if it finds no
    // break.
    for (const std::size_t reach : {kLeastBufferBytes, buffer_.size()}) {
        fillTo(reach);
        const char* start = buffer_.data() + begin_;
        const void* found = std::memchr(start, '\n', end_ - begin_);
        if (found == nullptr) { continue; }
        const auto length = static_cast<std::size_t>(static_cast<const char*>(found) - start);
        begin_ += length + 1;
        position_bytes_ += length + 1;
        line = {start, length > 0 && start[length - 1] == '\r' ? length - 1 : length};
        return LineEnd::kBreak;
    }
    check(end_ - begin_ < buffer_.size(), "{}: byte {}: a line is longer than {} bytes", name_,
          position_bytes_, buffer_.size());
    line = {buffer_.data() + begin_, end_ - begin_};
    position_bytes_ += line.size();
    begin_ = end_;
    return line.empty() ? LineEnd::kNoLine : LineEnd::kFileEnd;
}

std::span<const std::byte> InputFile::readBlock(std::size_t count) {
    fillTo(count);
    const std::span<const char> block(buffer_.data() + begin_, std::min(count, end_ - begin_));
    begin_ += block.size();
    position_bytes_ += block.size();
    return std::as_bytes(block);
}

std::size_t InputFile::readAt(std::uint64_t offset, std::span<std::byte> target) const {
    const std::optional<std::size_t> got = binosplat::readAt(file_.get(), offset, target);
    check(got.has_value(), "{}: reading failed at byte {}: {}", name_, offset, std::strerror(errno));
    return *got;
}

std::size_t InputFile::read(std::span<std::byte> target) {
    std::size_t done = 0;
    while (done < target.size()) {
        const std::span<const std::byte> block = readBlock(target.size() - done);
        if (block.empty()) { break; }
        std::ranges::copy(block, target.begin() + static_cast<std::ptrdiff_t>(done));
        done += block.size();
    }
    return done;
}

void InputFile::skip(std::uint64_t count) {
    while (count > 0) {
        const std::size_t got =
            readBlock(static_cast<std::size_t>(std::min<std::uint64_t>(count, buffer_.size()))).size();
        check(got > 0, "{}: ends at byte {}, {} more were expected", name_, position_bytes_, count);
        count -= got;
    }
}

std::vector<std::byte> InputFile::readWhole(std::uint64_t most_bytes) {
    check(sizeBytes() <= most_bytes, "{}: is {} bytes long, expected at most {}", name_, sizeBytes(),
          most_bytes);
    std::vector<std::byte> bytes(sizeBytes());
    bytes.resize(read(bytes));
    requireUnchanged();
    return bytes;
}

}  // namespace binosplat
