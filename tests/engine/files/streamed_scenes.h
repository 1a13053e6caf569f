// Streamed SOG scenes made to measure: chunks in folders, and a lod-meta.json that describes them.
#pragma once

#include "tests/engine/files/sog_scenes.h"

namespace binosplat::test {

// Two levels of three leaves, plus an environment. Level 0 is two chunks: a/meta.json (SH degree 1) and
// b/meta.json (no SH). Level 1 is one chunk, c/meta.json (version 1), and the last leaf does not have it.
// Every chunk has eight splats.
inline std::string makeLodMeta() {
    const auto leaf = [](const std::string& lods) {
        return R"({"bound":{"min":[-1,-2,0],"max":[1,0.5,2e0]},"lods":{)" + lods + R"(},"errors":[0,0.5]})";
    };
    const std::string bound = R"({"bound":{"min":[-4,-2,0],"max":[1,0.5,2]},"children":[)";
    return R"({"version":1,"asset":{"generator":"a test"},"count":24,"counts":[16,8],"lodLevels":2,)"
           R"("lodErrors":true,"environment":"env/meta.json",)"
           R"("filenames":["a/meta.json","b/meta.json","c/meta.json"],"tree":)" +
           bound + leaf(R"("0":{"file":0,"offset":5,"count":3},"1":{"file":2,"offset":0,"count":6})") + "," +
           bound + leaf(R"("0":{"file":0,"offset":0,"count":5},"1":{"file":2,"offset":6,"count":2})") + "," +
           leaf(R"("0":{"file":1,"offset":0,"count":8})") + "]}]}}";
}

// A chunk at a place of its own: its splats begin at x = -expm1(-left).
inline SogText makeChunk(int left, int version = 2, bool with_palette = true) {
    SogText files = makeSog(version, with_palette);
    files["meta.json"] = replaced(files["meta.json"], "\"mins\":[-1,", fmt::format("\"mins\":[-{},", left));
    return files;
}

// Returns the folder. `meta` is from makeLodMeta, or broken. Chunks listed in `bundles` are .sog files.
inline std::string writeStreamed(const Folder& folder, const std::string& name, std::string meta,
                                 const std::vector<std::string>& bundles = {}) {
    fs::remove_all(folder.file(name));
    fs::create_directories(folder.file(name));
    for (const auto& [chunk, files] : {std::pair("a", makeChunk(2)),
                                       {"b", makeChunk(3, 2, false)},
                                       {"c", makeChunk(4, 1)},
                                       {"env", makeChunk(5, 2, false)}}) {
        if (std::ranges::count(bundles, chunk) > 0) {
            meta = replaced(meta, fmt::format("\"{}/meta.json\"", chunk), fmt::format("\"{}.sog\"", chunk));
            (void)folder.write(fmt::format("{}/{}.sog", name, chunk), makeZip(files, *chunk == 'b'));
        } else {
            (void)writeSogFolder(folder, fmt::format("{}/{}", name, chunk), files);
        }
    }
    (void)folder.write(name + "/lod-meta.json", meta);
    return folder.file(name);
}

}  // namespace binosplat::test
