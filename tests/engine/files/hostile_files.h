// Files that are broken in every way, and what is required of whoever reads them.
#pragma once

#include "tests/engine/files/ply_files.h"
#include "tests/hostile.h"

namespace binosplat::test {

// A good file, or a part of one, and how to break it.
struct Target {
    std::string name, good;
    int changes = 1000;                  // bits are flipped this many times, and bytes are spliced as often
    std::size_t numbers = 0, lines = 0;  // in this many bytes, numbers are replaced and lines shuffled
    bool must_be_whole = true;           // it is refused whatever length it is cut to
    std::function<std::string(const std::string&)> wrap = [](const std::string& bytes) { return bytes; };
    // The file that is written, and the one that is then read.
    std::string file = "broken", source = "broken";
    std::size_t most_splats = 1000;
    std::vector<std::string> more{};
};

// One in `stride` of the possible breaks is tried; more than one in `share` of all must be refused.
inline void attack(const Folder& folder, const std::vector<Target>& targets, std::size_t stride,
                   std::size_t share, long most_mebibytes,
                   const std::function<void(const std::string& path, const Target& target)>& read) {
    std::size_t inputs = 0, refused = 0;
    for (const Target& target : targets) {
        (void)folder.write(target.file, target.wrap(target.good));
        CHECK_MESSAGE(errorOf([&] { read(folder.file(target.source), target); }) == "", target.name);
        // A folder, for tests/fuzz/run.sh --keep.
        if (const char* const seeds = std::getenv("BINOSPLAT_WRITE_SEEDS")) {
            std::ofstream(fs::path(seeds) / target.name, std::ios::binary) << target.wrap(target.good);
        }
        Tally tally;
        // A long file is cut at fewer lengths.
        std::size_t count = 0, step = stride * (1 + target.good.size() / 2000);
        const Attempt attempt = [&](const std::string& what, const std::string& bytes) {
            if (count++ % step != 0) { return; }
            (void)folder.write(target.file, target.wrap(bytes));
            tally.attempt(target.name + ", " + what, [&] { read(folder.file(target.source), target); });
        };
        truncate(target.good, attempt);
        if (target.must_be_whole) { CHECK_MESSAGE(tally.read == 0, target.name); }
        step = stride;
        flipBits(target.good, target.changes, attempt);
        spliceBytes(target.good, target.changes, attempt);
        replaceNumbers(target.good, target.numbers, attempt);
        shuffleLines(target.good, target.lines, attempt);
        for (const std::string& bytes : target.more) {
            count = 0, attempt("one that begins with " + bytes.substr(0, 20), bytes);
        }
        MESSAGE(fmt::format("{}: {} broken files, {} read, {} refused", target.name, tally.inputs, tally.read,
                            tally.refused));
        inputs += tally.inputs, refused += tally.refused;
    }
    CHECK(refused > inputs / share);
    CHECK(peakMebibytes() < most_mebibytes);
}

}  // namespace binosplat::test
