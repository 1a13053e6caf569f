// In a build that cannot decode WebP, a SOG scene is known for what it is and refused in one line.
#include "tests/engine/scene/ply_files.h"

TEST_SUITE_BEGIN("no_sog_format");

namespace no_sog_format_test {

using namespace binosplat;
using namespace binosplat::test;

TEST_CASE("a SOG scene names the build that reads it") {
    const Folder folder;
    const std::string meta = R"({"version":2,"count":0,"means":{"mins":[0,0,0],"maxs":[0,0,0],"files":["l.webp","u.webp"]}})";
    (void)folder.write("meta.json", meta);
    std::filesystem::create_directory(folder.file("streamed"));
    (void)folder.write("streamed/lod-meta.json", "{}");
    for (const std::string& source : {folder.file("."), folder.file("streamed"), folder.file("streamed/lod-meta.json"),
                                      folder.file("meta.json"), folder.write("a.sog", "PK\x03\x04 and so on")}) {
        const std::string message = loadError(source);
        CHECK(contains(message, "a SOG scene, which this build cannot read: configure with BINOSPLAT_SOG=ON"));
        CHECK(message.find('\n') == std::string::npos);
    }
}

#ifndef BINOSPLAT_GLTF
TEST_CASE("a glTF scene names the build that reads it") {
    const Folder folder;
    const std::string message = loadError(folder.write("a.gltf", R"({"asset":{"version":"2.0"}})"));
    CHECK(contains(message, "a.gltf: a glTF scene, which this build cannot read"));
    CHECK(contains(message, "BINOSPLAT_GLTF=ON"));
}
#endif

}  // namespace no_sog_format_test
