// Replays the inputs that fuzzing kept.
#include "tests/engine/files/ply_files.h"
#include "tests/fuzz/targets.h"

SUITE(fuzz_corpus) {

TEST_CASE("every kept input is read or refused in one line") {
    std::size_t inputs = 0, bytes = 0;
    for (const fuzz::Target& target : fuzz::targets()) {
        const std::size_t before = inputs;
        for (const auto& entry : std::filesystem::directory_iterator(
                 std::filesystem::path(BINOSPLAT_FUZZ_CORPUS) / target.name)) {
            const std::string input = textIn(entry.path().string());
            CAPTURE(entry.path().string());
            fuzz::runTarget(target.name, {reinterpret_cast<const std::uint8_t*>(input.data()), input.size()});
            ++inputs, bytes += input.size();
        }
        CHECK_MESSAGE(inputs > before, "no inputs for ", target.name);
    }
    MESSAGE(fmt::format("{} inputs of {} bytes", inputs, bytes));
    CHECK(bytes < 400'000);
}

}  // SUITE(fuzz_corpus)
