// A folder in which benches are planned and run.
#pragma once

#include "app/bench/bench_plan.h"
#include "tests/app/options/parsed.h"
#include "tests/run_program.h"

namespace binosplat::test {

using Names = std::vector<std::string>;

struct Bench : Workplace {
    // A config in b.toml, and more words on the command line.
    [[nodiscard]] BenchOptions options(const std::string& toml, const std::string& words = "") const {
        write("b.toml", toml);
        return parse<BenchOptions>(
            fmt::format("bench --out out --config {} {}", (path / "b.toml").string(), words));
    }
    [[nodiscard]] BenchPlan plan(const std::string& toml, const std::string& words = "") const {
        return planBench(options(toml, words));
    }
    [[nodiscard]] std::string planError(const std::string& toml, const std::string& words = "") const {
        return errorOf([&] { static_cast<void>(plan(toml, words)); });
    }
    [[nodiscard]] nlohmann::json results(const std::string& file) const {
        return nlohmann::json::parse(bytesOf(file)).at("results");
    }
};

}  // namespace binosplat::test
