// The links of documents.
#pragma once

#include "tests/suite.h"

#include <cctype>
#include <regex>

namespace binosplat::test {

// What the pattern's group matches.
inline std::vector<std::string> findAll(const std::string& text, const char* pattern) {
    const std::regex regex(pattern);
    std::vector<std::string> found;
    for (std::sregex_iterator match(text.begin(), text.end(), regex); match != std::sregex_iterator{};
         ++match) {
        found.push_back((*match)[1]);
    }
    return found;
}

// The anchor of a heading: lower case, dashes for spaces, no punctuation.
inline std::string anchorOf(const std::string& heading) {
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

// All links to other files lead somewhere, those with an anchor to a heading.
inline void checkLinks(const std::vector<fs::path>& documents) {
    int links = 0;
    for (const fs::path& document : documents) {
        CAPTURE(document);
        for (const std::string& link : findAll(textIn(document), R"(\]\(([^)\s]+)[^)]*\))")) {
            if (link.starts_with("http")) { continue; }
            const std::size_t hash = link.find('#');
            const std::string path = link.substr(0, hash);
            const fs::path target = path.empty() ? document : document.parent_path() / path;
            CHECK_MESSAGE(fs::exists(target), link);
            ++links;
            if (hash == std::string::npos) { continue; }
            const auto headings = findAll(fmt::format("\n{}", textIn(target)), "\n#+ ([^\n]*)");
            CHECK_MESSAGE(std::ranges::find(headings, link.substr(hash + 1), anchorOf) != headings.end(),
                          link);
        }
    }
    CHECK(links > 50);
}

inline std::vector<fs::path> documentsIn(const fs::path& folder) {
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".md") { files.push_back(entry.path()); }
    }
    return files;
}

}  // namespace binosplat::test
