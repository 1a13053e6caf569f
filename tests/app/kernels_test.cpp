// `kernels`: every variant of every pass is built by the device's compiler.
#include "tests/run_program.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <set>
#include <utility>

TEST_SUITE_BEGIN("kernels");

namespace kernels_test {

namespace fs = std::filesystem;
using binosplat::test::Outcome;
using binosplat::test::Workplace;

namespace {

const std::string kNoDriver = "VK_DRIVER_FILES=/nonexistent/none.json VK_ICD_FILENAMES=/nonexistent/none.json";

}  // namespace

TEST_CASE("every kernel is built and listed") {
    const Workplace work;
    const Outcome outcome = work.run("kernels --out k");
    INFO("stderr: " << outcome.errors);
    REQUIRE(outcome.exit_code == 0);
    const auto listed = nlohmann::json::parse(std::ifstream(work.path / "k" / "kernels.json"));
    CHECK_FALSE(listed.at("device").get<std::string>().empty());
    std::set<std::string> shaders;
    std::set<std::pair<std::string, std::string>> variants;
    for (const auto& kernel : listed.at("kernels")) {
        shaders.insert(kernel.at("shader").get<std::string>());
        variants.emplace(kernel.at("shader").get<std::string>(), kernel.at("constants").dump());
        CHECK(kernel.at("statistics").is_object());
    }
    CHECK(variants.size() == listed.at("kernels").size());
    // Each shader that there is.
    std::set<std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(BINOSPLAT_SOURCE_DIR) / "shaders")) {
        if (entry.path().extension() == ".comp") { files.insert(entry.path().stem().string()); }
    }
    CHECK(shaders == files);
    for (const auto& [arguments, environment] :
         {std::pair<std::string, std::string>("kernels", kNoDriver), std::pair<std::string, std::string>("kernels --device nobody", "")}) {
        const Outcome refused = work.run(arguments, environment);
        CHECK(refused.exit_code == 3);
        CHECK(std::ranges::count(refused.errors, '\n') == 1);
        CHECK(refused.errors.find(environment.empty() ? "nobody" : "Vulkan") != std::string::npos);
    }
}

}  // namespace kernels_test
