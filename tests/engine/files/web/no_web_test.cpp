// A build without network support says so.
#include "engine/files/web/web_files.h"
#include "tests/engine/files/ply_files.h"

SUITE(no_web) {

TEST_CASE("a scene at an address names the build that reads it") {
    const Folder folder;
    LoadNotes notes;
    CHECK_THROWS_WITH_AS((void)loadSceneFromAnywhere("http://127.0.0.1/a.ply", 0, notes, {}, {},
                                                     {folder.file("cache"), 0, {}}),
                         doctest::Contains("this build has no network"), Error);
}

}  // SUITE(no_web)
