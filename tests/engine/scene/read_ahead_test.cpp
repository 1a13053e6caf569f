// Facts about blocks that are read on a second thread: all come, in order, and so does what went wrong.
#include "engine/scene/read_ahead.h"
#include "engine/error.h"
#include "engine/scene/ply.h"
#include "tests/engine/scene/ply_files.h"

#include <doctest/doctest.h>

TEST_SUITE_BEGIN("read_ahead");

namespace read_ahead_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// Takes blocks whose x counts rows; the number taken, or what was thrown.
std::string take(std::uint64_t rows, std::uint64_t fails_at, std::uint64_t& taken) {
    std::uint64_t filled = 0;
    taken = 0;
    ReadAhead blocks(rows, [&](ReadAhead::Block& block) {
        check(fails_at >= filled + block.stored.rows, "row {}", fails_at);
        for (std::size_t row = 0; row < block.stored.rows; ++row) { block.stored.put(kStoredX, row, static_cast<float>(filled++)); }
    });
    try {
        while (const ReadAhead::Block* block = blocks.next()) {
            for (std::size_t row = 0; row < block->stored.rows; ++row) {
                if (block->stored.column(kStoredX)[row] != static_cast<float>(taken++)) { return "out of order"; }
            }
        }
    } catch (const Error& error) { return error.what(); }
    return "all";
}

// Rows whose first ones have no SH bands, then some that have.
Scene makeScene(std::size_t splats, std::size_t without_sh) {
    Scene scene;
    scene.sh_degree = 3;
    for (std::size_t i = 0; i < splats; ++i) {
        scene.positions.emplace_back(static_cast<float>(i), 0.0f, 1.0f);
        scene.rotations.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
        scene.scales.emplace_back(1.0f, 2.0f);
        scene.opacities.push_back(0.5f);
        for (std::size_t k = 0; k < 48; ++k) { scene.sh.push_back(i < without_sh && k > 2 ? 0.0f : static_cast<float>(i % 97 + k)); }
    }
    return scene;
}

}  // namespace

TEST_CASE("every row comes once and in order, whatever their number") {
    for (const std::uint64_t rows : {0, 1, 255, 256, 257, 2048, 2049, 4096, 4097, 6143, 6145, 20000}) {
        CAPTURE(rows);
        std::uint64_t taken = 0;
        CHECK(take(rows, rows, taken) == "all");
        CHECK(taken == rows);
    }
}

TEST_CASE("what goes wrong is thrown behind the blocks before it") {
    for (const std::uint64_t fails_at : {0, 255, 256, 2047, 2048, 9000, 19999}) {
        CAPTURE(fails_at);
        std::uint64_t taken = 0;
        CHECK(take(20000, fails_at, taken) == fmt::format("row {}", fails_at));
        CHECK(taken == fails_at / StoredBlock::kRows * StoredBlock::kRows);
    }
}

TEST_CASE("whoever stops taking waits for nothing") {
    for (const int blocks_taken : {0, 1, 9, 40}) {
        std::size_t filled = 0;
        {
            ReadAhead blocks(100'000'000, [&](ReadAhead::Block&) { ++filled; });
            for (int i = 0; i < blocks_taken; ++i) { REQUIRE(blocks.next() != nullptr); }
        }
        CHECK(filled >= static_cast<std::size_t>(blocks_taken));
        CHECK(filled <= static_cast<std::size_t>(blocks_taken) + 48);
    }
}

TEST_CASE("bands that only late splats use are kept, few of them too") {
    const Folder folder;
    for (const std::size_t without_sh : {std::size_t{0}, std::size_t{1}, std::size_t{4000}, std::size_t{19999}, std::size_t{20000}}) {
        CAPTURE(without_sh);
        const Scene scene = makeScene(20000, without_sh);
        writePly(scene, folder.file("a.ply"));
        const Scene loaded = loadScene(folder.file("a.ply"));
        REQUIRE(loaded.size() == scene.size());
        REQUIRE(loaded.sh_degree == (without_sh == 20000 ? 0 : 3));
        const auto width = static_cast<std::size_t>(3 * shCoefficientCount(loaded.sh_degree));
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < scene.size(); ++i) {
            wrong += loaded.positions[i] != scene.positions[i];
            wrong += !std::equal(loaded.sh.begin() + static_cast<std::ptrdiff_t>(i * width),
                                 loaded.sh.begin() + static_cast<std::ptrdiff_t>((i + 1) * width),
                                 scene.sh.begin() + static_cast<std::ptrdiff_t>(i * 48));
        }
        CHECK(wrong == 0);
    }
}

}  // namespace read_ahead_test
