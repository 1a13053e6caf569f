// Facts about the documents: what they link to is there, and the options and files that they name exist.
#include "app/options/commands_table.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>

namespace fs = std::filesystem;
using namespace binosplat;

namespace {

const fs::path kSource = BINOSPLAT_SOURCE_DIR;

std::string textOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<fs::path> documents() {
    std::vector<fs::path> files;
    for (const char* name : {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "third_party/NOTICES.md", "xr/simulated/README.md"}) {
        files.push_back(kSource / name);
    }
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(kSource / "docs")) {
        if (entry.path().extension() == ".md") { files.push_back(entry.path()); }
    }
    return files;
}

std::vector<std::string> findAll(const std::string& text, const char* pattern) {
    const std::regex regex(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), regex); match != std::sregex_iterator{}; ++match) {
        found.push_back((*match)[1]);
    }
    return found;
}

// The anchor that a heading gets: lower case, spaces as dashes, punctuation left out.
std::string anchorOf(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        if (std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_') {
            anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
        } else if (c == ' ') {
            anchor += '-';
        }
    }
    return anchor;
}

bool hasAnchor(const fs::path& document, const std::string& anchor) {
    const std::vector<std::string> headings = findAll(fmt::format("\n{}", textOf(document)), "\n#+ ([^\n]*)");
    return std::ranges::any_of(headings, [&](const std::string& heading) { return anchorOf(heading) == anchor; });
}

// Of cmake, ctest, doctest, apt-get, compare_frame_logs and others whose commands the documents show.
const std::set<std::string> kForeignOptions{"--preset",    "--build",   "--install", "--config",    "--test-dir",
                                            "--test-case", "--target",  "--prefix",  "--component", "--output-on-failure",
                                            "--help",      "--version", "--success", "--pictures",  "--share",
                                            "--tolerance", "--ignore"};

bool isOption(const std::string& name) {
    const auto has = [&](const Command& command) {
        return std::ranges::any_of(optionsOf(command),
                                   [&](const OptionDescription& option) { return name == fmt::format("--{}", option.text.key); });
    };
    return kForeignOptions.contains(name) || std::ranges::any_of(commands(), has);
}

}  // namespace

TEST_CASE("links of the documents lead somewhere") {
    int links = 0;
    for (const fs::path& document : documents()) {
        for (const std::string& link : findAll(textOf(document), R"(\]\(([^)\s]+)\))")) {
            if (link.starts_with("http")) { continue; }
            const std::size_t hash = link.find('#');
            const std::string path = link.substr(0, hash);
            const fs::path target = path.empty() ? document : document.parent_path() / path;
            CHECK_MESSAGE(fs::exists(target), document.string() << ": " << link);
            if (hash != std::string::npos) { CHECK_MESSAGE(hasAnchor(target, link.substr(hash + 1)), document.string() << ": " << link); }
            ++links;
        }
    }
    CHECK(links > 50);
}

TEST_CASE("options that the documents name exist") {
    int options = 0;
    for (const fs::path& document : documents()) {
        for (const std::string& option : findAll(textOf(document), R"((?:^|[\s`('"\[])(--[a-z][a-z-]+))")) {
            CHECK_MESSAGE(isOption(option), document.string() << ": " << option);
            ++options;
        }
    }
    CHECK(options > 100);
}

TEST_CASE("files of the source tree that the documents name exist") {
    int files = 0;
    for (const fs::path& document : documents()) {
        for (const std::string& name :
             findAll(textOf(document), R"(`((?:configs|docs|tests|engine|shaders|app|xr|third_party)/[a-zA-Z0-9_/.]+)`)")) {
            CHECK_MESSAGE(fs::exists(kSource / name), document.string() << ": " << name);
            ++files;
        }
    }
    CHECK(files > 20);
}

TEST_CASE("the simulated runtime's folder has the same licence") {
    REQUIRE(!textOf(kSource / "LICENSE").empty());
    CHECK(textOf(kSource / "xr" / "simulated" / "LICENSE") == textOf(kSource / "LICENSE"));
}

TEST_CASE("every library that is built with has its row in the notices, and its licence if it is compiled in") {
    const std::string notices = textOf(kSource / "third_party" / "NOTICES.md");
    const std::size_t licences = notices.find("\n## Licences of what is compiled in");
    REQUIRE(licences != std::string::npos);
    std::string rows;
    for (const std::string& row : findAll(notices.substr(0, licences), "\n(\\|[^\n]*)")) {
        for (const char c : row) { rows += static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }
        if (row.find("compiled in") == std::string::npos) { continue; }
        const std::string link = row.substr(2, row.find(')') - 1);
        CHECK_MESSAGE(notices.find(link, licences) != std::string::npos, "no licence of " << link);
    }
    const std::vector<std::string> libraries =
        findAll(textOf(kSource / "third_party" / "CMakeLists.txt"), R"(add_library\(third_party_([a-z0-9]+) )");
    CHECK(libraries.size() > 10);
    for (const std::string& library : libraries) { CHECK_MESSAGE(rows.find(library) != std::string::npos, "no row of " << library); }
}
