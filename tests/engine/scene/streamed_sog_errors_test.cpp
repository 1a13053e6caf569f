// Everything that does not fit in a streamed SOG scene: one line with file and place, and nothing is loaded.
#include "tests/engine/scene/streamed_scenes.h"

TEST_SUITE_BEGIN("streamed_sog_errors");

namespace streamed_sog_errors_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// The message of a scene whose lod-meta.json says `to` instead of `from`.
struct Broken {
    Folder folder;

    std::string load(const std::string& meta) const {
        std::string message = loadError(writeStreamed(folder, "scene", meta));
        CHECK(contains(message, "scene/lod-meta.json: "));
        CHECK(message.find('\n') == std::string::npos);
        return message;
    }
    std::string with(const std::string& from, const std::string& to) const { return load(replaced(makeLodMeta(), from, to)); }
};

}  // namespace

TEST_CASE("the unbroken scene loads") {
    const Folder folder;
    CHECK(loadError(writeStreamed(folder, "scene", makeLodMeta())).empty());
}

TEST_CASE("a lod-meta.json that does not fit is named with its key") {
    const Broken broken;
    CHECK(contains(broken.load(""), "not JSON"));
    CHECK(contains(broken.load(makeLodMeta().substr(0, 300)), "expected the levels of a streamed SOG scene"));
    CHECK(contains(broken.load("[]"), "is array, expected an object"));
    CHECK(contains(broken.load("{}"), "has no lodLevels, expected one"));
    CHECK(contains(broken.with("\"version\":1", "\"version\":2"), "version: is 2, expected 1"));
    CHECK(contains(broken.with("\"lodLevels\":2", "\"lodLevels\":0"), "lodLevels: is 0, expected 1 to 64"));
    CHECK(contains(broken.with("\"lodLevels\":2", "\"lodLevels\":18446744073709551615"), "expected 1 to 64"));
    CHECK(contains(broken.with("\"lodLevels\":2", "\"lodLevels\":1"), "lods.1: is no level, expected 0 to 0"));
    CHECK(contains(broken.with("\"1\":{", "\"01\":{"), "lods.01: is no level, expected 0 to 1"));
    CHECK(contains(broken.with("\"filenames\":", "\"files\":"), "has no filenames"));
    CHECK(contains(broken.with("\"tree\":", "\"trees\":"), "has no tree"));
    CHECK(contains(broken.with("\"children\":", "\"child\":"), "tree: has neither children nor lods"));
    CHECK(contains(broken.with("\"children\":", "\"lods\":{},\"children\":"), "tree: has both children and lods"));
    CHECK(contains(broken.with("\"lods\":{", "\"lods\":7,\"lod\":{"), "tree.children[0].lods: is number, expected an object"));
    CHECK(contains(broken.load(R"({"lodLevels":1,"filenames":[],"tree":{"bound":{"min":[0,0,0],"max":[0,0,0]},"children":[]}})"),
                   "tree.children: is empty"));
}

TEST_CASE("bounds that are no numbers are refused") {
    const Broken broken;
    CHECK(contains(broken.with("\"min\":[-4,", "\"min\":[NaN,"), "not JSON"));
    CHECK(contains(broken.with("\"min\":[-4,", "\"min\":[1e999,"), "not JSON"));
    CHECK(contains(broken.with("\"min\":[-4,", "\"min\":[1e300,"), "tree.bound.min[0]: is 1e+300, expected a float32 number"));
    CHECK(contains(broken.with("\"min\":[-4,", "\"min\":[null,"), "tree.bound.min[0]: is null, expected a number"));
    CHECK(contains(broken.with("\"min\":[-4,", "\"min\":["), "tree.bound.min: has 2 entries, expected 3"));
    CHECK(contains(broken.with("\"bound\":", "\"box\":"), "tree: has no bound"));
    CHECK(contains(broken.with("\"min\":[-1,-2,0],\"max\":[1,", "\"min\":[2,-2,0],\"max\":[1,"),
                   "tree.children[0].lods: lies in no box, expected a bound whose min is at most its max"));
}

TEST_CASE("names that are not those of chunks within the folder are refused") {
    const Broken broken;
    for (const char* path :
         {"../a/meta.json", "x/../../a/meta.json", "/etc/meta.json", "a\\\\meta.json", "c:meta.json", "a/meta.json\\u0000"}) {
        CHECK(contains(broken.with("\"b/meta.json\"", fmt::format("\"{}\"", path)), "expected a path within the folder of this file"));
    }
    for (const char* path : {"", "a", "a/other.json", "a/meta.json/"}) {
        CHECK(contains(broken.with("\"b/meta.json\"", fmt::format("\"{}\"", path)), "expected the meta.json or the .sog of a chunk"));
    }
    for (const char* path : {"../b.sog", "/b.sog", "x\\\\b.sog"}) {
        CHECK(contains(broken.with("\"b/meta.json\"", fmt::format("\"{}\"", path)), "expected a path within the folder of this file"));
    }
    CHECK(contains(broken.with("b/meta.json", "b.sog"), "b.sog is not there, expected a chunk of the scene"));
    CHECK(contains(broken.with("\"b/meta.json\"", "7"), "filenames[1]: is number, expected a text"));
    CHECK(contains(broken.with("env/meta.json", "../env/meta.json"), "environment: names \"../env/meta.json\""));
}

TEST_CASE("a chunk that is named twice is refused") {
    const Broken broken;
    CHECK(contains(broken.with("b/meta.json", "a/meta.json"), "filenames[1]: names a/meta.json once more, expected each chunk once"));
    CHECK(contains(broken.with("b/meta.json", "./x/../a//meta.json"), "expected a path within"));
    CHECK(contains(broken.with("b/meta.json", ".//a/./meta.json"), "filenames[1]: names a/meta.json once more"));
    CHECK(contains(broken.with("env/meta.json", "a/meta.json"), "environment: names a/meta.json once more"));
}

#ifndef _WIN32  // where links take a privilege
TEST_CASE("links that lead out of the folder or to the same chunk are refused") {
    const Broken broken;
    const std::string source = writeStreamed(broken.folder, "scene", makeLodMeta());
    std::filesystem::rename(source + "/b", broken.folder.file("elsewhere"));
    std::filesystem::create_directory_symlink(broken.folder.file("elsewhere"), source + "/b");
    std::string message = loadError(source);
    CHECK(contains(message, "scene/lod-meta.json: filenames[1]: "));
    CHECK(contains(message, "elsewhere/meta.json, expected a place within"));
    std::filesystem::remove(source + "/b");
    std::filesystem::create_directory_symlink("a", source + "/b");
    message = loadError(source);
    CHECK(contains(message, "filenames[1]: "));
    CHECK(contains(message, "is a link to a chunk that is named already"));
    // A link to the whole scene leads nowhere else.
    std::filesystem::remove(source + "/b");
    std::filesystem::rename(broken.folder.file("elsewhere"), source + "/b");
    std::filesystem::create_directory_symlink("scene", broken.folder.file("linked"));
    CHECK(loadScene(broken.folder.file("linked")).size() == 24);
}
#endif

TEST_CASE("chunks that are missing or broken are named before any is decoded") {
    const Broken broken;
    const std::string source = writeStreamed(broken.folder, "scene", makeLodMeta());
    const auto errorOf = [&] {
        std::vector<double> shares;
        try {
            (void)loadScene(source, 0, nullptr, [&](double share) { shares.push_back(share); });
        } catch (const Error& error) {
            CHECK(shares == std::vector<double>{0.0});
            return std::string(error.what());
        }
        return std::string();
    };
    std::filesystem::remove(source + "/env/q.webp");
    CHECK(contains(errorOf(), "scene/env/q.webp: no such file"));
    std::filesystem::remove_all(source + "/env");
    CHECK(contains(errorOf(), "scene/lod-meta.json: environment: "));
    std::filesystem::remove(source + "/b/meta.json");
    CHECK(contains(errorOf(), "scene/lod-meta.json: filenames[1]: "));
    CHECK(contains(errorOf(), "scene/b/meta.json is not there, expected a chunk of the scene"));
    const SogText chunk = makeSog();
    (void)broken.folder.write("scene/a/meta.json", replaced(chunk.at("meta.json"), "\"count\":8", "\"count\":4294967296"));
    CHECK(contains(errorOf(), "scene/a/meta.json: count: is 4294967296, expected fewer than 256 for each"));
    (void)broken.folder.write("scene/a/meta.json", "{");
    CHECK(contains(errorOf(), "scene/a/meta.json: not JSON"));
}

TEST_CASE("ranges that overlap, lead beyond their chunk or name no chunk are refused") {
    const Broken broken;
    CHECK(contains(broken.with(R"("offset":5,"count":3)", R"("offset":4,"count":4)"),
                   "tree: two leaves name splat 4 of filenames[0] (a/meta.json), expected each splat once"));
    CHECK(contains(broken.with(R"("offset":0,"count":5)", R"("offset":5,"count":3)"), "two leaves name splat 5"));
    CHECK(contains(broken.with(R"("offset":5,"count":3)", R"("offset":5,"count":4)"),
                   "tree: a leaf names splat 8 of filenames[0] (a/meta.json), which has 8"));
    CHECK(contains(broken.with(R"("file":0)", R"("file":3)"), "lods.0.file: is 3, expected less than the 3 of filenames"));
    CHECK(contains(broken.with(R"("file":0)", R"("file":-1)"), "lods.0.file: is -1, expected a whole number from 0 on"));
    CHECK(contains(broken.with(R"("file":0,)", ""), "lods.0: has no file"));
    CHECK(contains(broken.with(R"("offset":5)", R"("offset":18446744073709551615)"), "expected at most 1099511627776"));
    CHECK(contains(broken.with(R"("count":3)", R"("count":9223372036854775808)"), "lods.0.count: is 9223372036854775808"));
    CHECK(contains(broken.with(R"("count":3)", R"("count":1e19)"), "lods.0.count: is 1e+19, expected a whole number"));
    CHECK(contains(broken.with(R"("count":3)", R"("count":3.5)"), "lods.0.count: is 3.5, expected a whole number"));
}

TEST_CASE("a tree that is too deep is refused, one that is deep is not") {
    const Broken broken;
    const auto nest = [](int nodes) {
        std::string meta = R"({"lodLevels":1,"filenames":["a/meta.json"],"tree":)";
        for (int i = 1; i < nodes; ++i) { meta += R"({"bound":{"min":[0,0,0],"max":[1,1,1]},"children":[)"; }
        meta += R"({"bound":{"min":[0,0,0],"max":[1,1,1]},"lods":{"0":{"file":0,"offset":0,"count":8}}})";
        for (int i = 1; i < nodes; ++i) { meta += "]}"; }
        return meta + "}";
    };
    CHECK(loadScene(writeStreamed(broken.folder, "scene", nest(64))).size() == 8);
    CHECK(contains(broken.load(nest(70)), "nested more than 132 levels deep"));
    CHECK(contains(broken.load(nest(100'000)), "nested more than 132 levels deep"));
    CHECK(contains(broken.load(std::string(1'000'000, '[')), "nested more than 132 levels deep"));
}

}  // namespace streamed_sog_errors_test
