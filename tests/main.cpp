// The entry point of every test program. A run without a single case fails, since a suite's name must have
// been mistyped. A run that lacks the shared scenes and has no failures ends with 77, which ctest reports as
// skipped.
#define DOCTEST_CONFIG_IMPLEMENT
#include "tests/shared_data.h"

namespace {

// Listens and says nothing.
struct Counter : doctest::ConsoleReporter {
    explicit Counter(const doctest::ContextOptions& options) : ConsoleReporter(options, nowhere) {}
    static inline std::ostream nowhere{nullptr};
    static inline unsigned cases = 0;

    void test_run_end(const doctest::TestRunStats& stats) override {
        cases = stats.numTestCasesPassingFilters;
    }
};
DOCTEST_REGISTER_LISTENER("counter", 1, Counter);

}  // namespace

int main(int count, char** arguments) {
    doctest::Context context(count, arguments);
    // See nightly() in tests/suite.h.
    if (std::getenv("BINOSPLAT_NIGHTLY") != nullptr) { context.setOption("no-skip", true); }
    const int failed = context.run();
    if (context.shouldExit() || failed != 0) { return failed; }
    if (Counter::cases == 0) {
        std::fputs("no test case has this name\n", stderr);
        return 1;
    }
    return binosplat::test::shared_data_is_missing ? 77 : 0;
}
