// A libFuzzer program for one target, which the build names.
#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    binosplat::fuzz::runTarget(BINOSPLAT_FUZZ_TARGET, {data, size});
    return 0;
}
