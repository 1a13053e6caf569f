// A file read once from front to back through one buffer, by lines or by blocks; its name is part of every
// message.
#pragma once

#include "engine/platform.h"
#include "engine/temporary_folder.h"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace binosplat {

class SceneFiles;

// The start of a text, without the byte order mark that some editors put there.
std::string_view withoutByteOrderMark(std::string_view start);

class InputFile {
public:
    // Throws Error if `path` is missing, a directory, not a regular file, not readable or a Git LFS pointer.
    explicit InputFile(const std::string& path);
    // A file that messages call `name`; the other files of its scene come from `others`, which must outlive
    // it.
    InputFile(const std::filesystem::path& path, std::string name, SceneFiles& others);
    // A file in a folder of its own, which is removed along with it; messages call it `name`.
    InputFile(TemporaryFolder folder, const std::string& file, std::string name);
    ~InputFile();

    [[nodiscard]] const std::string& name() const { return name_; }
    // Its path on the disk.
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    // Null if they are next to it, on the disk.
    [[nodiscard]] SceneFiles* others() const { return others_; }
    void takeOthers(std::unique_ptr<SceneFiles> others);
    // Opens it once more, as long as this one exists or the others that it was given do.
    [[nodiscard]] std::function<std::unique_ptr<InputFile>()> again() const;
    [[nodiscard]] std::uint64_t sizeBytes() const { return opened_.size_bytes; }
    [[nodiscard]] std::uint64_t positionBytes() const { return position_bytes_; }
    [[nodiscard]] std::uint64_t bytesLeft() const {
        return sizeBytes() > position_bytes_ ? sizeBytes() - position_bytes_ : 0;
    }

    // Throws Error if the file has been written to since it was opened, because what was read may be half old
    // and half new. A file that was removed or replaced is read to its end as it was.
    void requireUnchanged() const;

    // Bytes from anywhere, without advancing; fewer at the end of the file.
    [[nodiscard]] std::size_t readAt(std::uint64_t offset, std::span<std::byte> target) const;

    // The next bytes, at most `count`, without advancing. Valid until the next call.
    [[nodiscard]] std::string_view peek(std::size_t count);

    // How a line ended: by a line break, by the end of the file after at least one character, or there was no
    // line at all.
    enum class LineEnd { kBreak, kFileEnd, kNoLine };
    // The next line without its break ("\n" or "\r\n"); valid until the next call. Throws Error for a line
    // over 1 MiB.
    LineEnd readLine(std::string_view& line);

    // The next `count` bytes, at most 1 MiB; fewer only at the end of the file. Valid until the next call.
    [[nodiscard]] std::span<const std::byte> readBlock(std::size_t count);

    // Fills `target` as far as the file goes, and returns how far.
    [[nodiscard]] std::size_t read(std::span<std::byte> target);

    // Skips `count` bytes, which must exist.
    void skip(std::uint64_t count);

    // The whole file, before anything has been read. Throws Error if it has more than `most_bytes`.
    [[nodiscard]] std::vector<std::byte> readWhole(std::uint64_t most_bytes);

    // The open file, for a library; nothing can be read here afterwards.
    [[nodiscard]] File release() { return std::move(file_); }

private:
    void open();
    [[nodiscard]] FileStamp stamp() const;
    // Fills the buffer to at least `count` unread bytes, or to the rest of the file.
    void fillTo(std::size_t count);

    std::optional<TemporaryFolder> folder_;  // removed after the file is closed
    std::filesystem::path path_;
    std::string name_;
    std::unique_ptr<SceneFiles> own_others_;
    SceneFiles* others_ = nullptr;
    File file_;
    FileStamp opened_;
    std::uint64_t position_bytes_ = 0;
    std::unique_ptr<char[]> room_;
    std::span<char> buffer_;
    std::size_t begin_ = 0, end_ = 0;  // the unread part of the buffer
};

}  // namespace binosplat
