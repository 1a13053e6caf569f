// The entry point of every test program. A run without a single case fails, since a suite's name must have
// been mistyped. A run that lacks the shared scenes and has no failures ends with 77, which ctest reports as
// skipped.
#define DOCTEST_CONFIG_IMPLEMENT
#include "tests/shared_data.h"

namespace {

struct Counter : doctest::IReporter {
    explicit Counter(const doctest::ContextOptions&) {}
    static inline unsigned cases = 0;

    void report_query(const doctest::QueryData&) override {}
    void test_run_start() override {}
    void test_run_end(const doctest::TestRunStats& stats) override {
        cases = stats.numTestCasesPassingFilters;
    }
    void test_case_start(const doctest::TestCaseData&) override {}
    void test_case_reenter(const doctest::TestCaseData&) override {}
    void test_case_end(const doctest::CurrentTestCaseStats&) override {}
    void test_case_exception(const doctest::TestCaseException&) override {}
    void subcase_start(const doctest::SubcaseSignature&) override {}
    void subcase_end() override {}
    void log_assert(const doctest::AssertData&) override {}
    void log_message(const doctest::MessageData&) override {}
    void test_case_skipped(const doctest::TestCaseData&) override {}
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
