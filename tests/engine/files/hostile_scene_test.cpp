// Broken scene files of every format: each either loads into a complete scene or is refused in one line.
#include "engine/files/sog.h"
#include "tests/engine/files/gltf_files.h"
#include "tests/engine/files/hostile_files.h"
#include "tests/engine/files/hostile_scenes.h"
#include "tests/engine/files/ksplat_files.h"
#include "tests/engine/files/streamed_scenes.h"
#include "tests/engine/scene/scene_measures.h"

SUITE(hostile_scene) {

Target partOf(Target target, std::size_t begin, std::size_t end = std::string::npos) {
    const std::string before = target.good.substr(0, begin),
                      behind = target.good.substr(std::min(end, target.good.size()));
    target.good = target.good.substr(begin, end - begin);
    target.wrap = [before, behind](const std::string& bytes) { return before + bytes + behind; };
    target.must_be_whole = target.must_be_whole && behind.empty();
    return target;
}

void readWhole(const std::string& path, const Target& target) {
    const Scene scene = loadScene(path);
    if (scene.size() > target.most_splats || !isSound(scene)) {
        FAIL_CHECK("a scene with values that are not to be");
    }
}

std::vector<Target> sceneTargets() {
    std::vector<Target> targets;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly(9, encoding == Encoding::kLittle);
        ply.encoding = encoding;
        ply.header_before = "element strip 1\nproperty list uchar short index\n";
        for (const auto& [type, value] :
             {std::pair("uchar", 2.0), std::pair("short", 1.0), std::pair("short", 2.0)}) {
            appendTyped(ply.data_before, type, value, encoding);
        }
        if (encoding == Encoding::kAscii) { ply.data_before += "\n"; }
        const std::string good = ply.bytes();
        const std::size_t end = good.find("end_header");
        targets.push_back(
            {fmt::format("PLY {}", static_cast<int>(encoding)), good, 1000, end + 200, end + 12});
    }
    const std::string packed = makeCompressedPly();
    targets.push_back(
        {"compressed PLY", packed, 1500, packed.find("end_header"), packed.find("end_header") + 12});
    targets.push_back({.name = ".splat", .good = makeSplatFile(), .must_be_whole = false});
    for (const int level : {0, 1, 2}) {
        // Most of a header is empty, so the rest is attacked.
        const Target whole{.name = fmt::format(".ksplat {}", level),
                           .good = KsplatText{.level = level, .degrees = {1, 2}}.bytes()};
        for (const std::size_t begin : {0, 4096, 4096 + 1024}) {
            targets.push_back(partOf(whole, begin, begin + 44));
        }
        targets.push_back(partOf(whole, 4096 + 2048));
        targets.back().changes = 200;
    }
    for (const std::uint32_t version : {2u, 3u}) {
        const std::string plain = makeSpz(version).bytes(), name = fmt::format("SPZ {}", version);
        targets.push_back({name + " in gzip", gzip(plain), 500});
        targets.push_back({.name = name + " within gzip", .good = plain, .wrap = gzip});
        targets.push_back({name, plain, 500});
    }
    SpzText spz = makeSpz(3);
    spz.version = 4;
    targets.push_back({"SPZ 4", makeSpzContainer(spz)});
    spz.flags = 2;
    targets.push_back({.name = "records of SPZ 4",
                       .good = spzRecord(7, "another's") + spzAxesRecord(10),
                       .changes = 400,
                       .must_be_whole = false,
                       .wrap = [spz](const std::string& records) { return makeSpzContainer(spz, records); }});
    GltfText gltf = makeGltf(9);
    gltf.nodes = R"([{"children":[1,2]},{"mesh":0,"rotation":[0.5,0.5,0.5,0.5],"scale":[1,2,-3]},{"mesh":0,)"
                 R"("translation":[1,2,3]}])";
    gltf.other_primitives = R"(,{"mode":4,"attributes":{"POSITION":0}})";
    const std::string json = gltf.json(""), embedded = gltf.embedded();
    targets.push_back({"GLB", gltf.glb(), 2000});
    targets.push_back(
        {.name = "JSON of a GLB",
         .good = json,
         .numbers = json.size(),
         .wrap = [gltf](const std::string& text) { return GltfText::makeGlb(text, gltf.binary()); }});
    targets.push_back({.name = "glTF", .good = embedded});
    targets.back().more = {
        R"({"asset":)" + std::string(100'000, '['),
        replaced(embedded, R"("nodes":[)",
                 R"("extras":)" + std::string(60, '[') + std::string(60, ']') + R"(,"nodes":[)")};
    return targets;
}

constexpr std::size_t kFew = kSanitized ? 1 : 7;  // shares no divisor with the number of breaks of any kind

TEST_CASE("broken files of every format but SOG, some of them") {
    attack(Folder(), sceneTargets(), kFew, 4, 512, readWhole);
}
TEST_CASE("broken files of every format but SOG" * nightly()) {
    attack(Folder(), sceneTargets(), 1, 4, 512, readWhole);
}

#ifdef BINOSPLAT_SOG

// With codebooks of two entries, which keep the text short.
SogText withShortText(SogText files) {
    std::string& meta = files["meta.json"];
    for (std::size_t at = 0; (at = meta.find("\"codebook\":[", at)) != std::string::npos; ++at) {
        meta.replace(at + 12, meta.find(']', at) - at - 12, "-3,1");
    }
    return files;
}

std::vector<std::string> nestDeep(const std::string& key) {
    return {std::string(1'000'000, '['), key + std::string(100'000, '[') + std::string(100'000, ']') + "}"};
}

std::vector<Target> sogTargets(const Folder& folder) {
    std::vector<Target> targets;
    for (const int version : {1, 2}) {
        const SogText files = withShortText(makeSog(version));
        const std::string good = files.at("meta.json"), name = fmt::format("sog{}", version);
        (void)writeSogFolder(folder, name, files);
        targets.push_back({.name = fmt::format("meta.json of version {}", version),
                           .good = good,
                           .changes = 800,
                           .numbers = good.size(),
                           .file = name + "/meta.json",
                           .source = name,
                           .most_splats = 9,
                           .more = nestDeep(R"({"version":2,"count":)")});
    }
    const std::string levels = makeLodMeta();
    (void)writeStreamed(folder, "streamed", levels);
    targets.push_back({.name = "lod-meta.json",
                       .good = levels,
                       .changes = 800,
                       .numbers = levels.size(),
                       .file = "streamed/lod-meta.json",
                       .source = "streamed",
                       .most_splats = 32,  // four chunks of them
                       .more = nestDeep(R"({"lodLevels":1,"tree":)")});
    for (const std::string picture : {"l.webp", "n.webp", "q.webp", "p.webp"}) {
        (void)writeSogFolder(folder, picture, makeSog());
        targets.push_back({.name = picture,
                           .good = makeSog().at(picture),
                           .changes = 400,
                           .must_be_whole = false,  // its last byte may only be padding to an even number
                           .file = picture + "/" + picture,
                           .source = picture,
                           .most_splats = 9});
        if (picture == "p.webp") { continue; }
        targets.push_back(targets.back());
        const auto stored = std::as_bytes(std::span(targets.back().good));
        const std::vector<std::uint8_t> rgba = decodeWebp(stored, picture).rgba;
        targets.back().name = "pixels of " + picture;
        targets.back().good.assign(rgba.begin(), rgba.end());
        targets.back().wrap = [](const std::string& pixels) {
            std::vector<std::uint8_t> nine(pixels.begin(), pixels.end());
            nine.resize(36);
            return makeWebp(3, 3, nine);
        };
    }
    for (const bool are_deflated : {false, true}) {
        const Target whole{.name = are_deflated ? "deflated bundle" : "stored bundle",
                           .good = makeZip(withShortText(makeSog(2, false)), are_deflated),
                           .most_splats = 9};
        targets.push_back(whole);
        // Most of the damage is done in the directory at the end.
        targets.push_back(partOf(whole, whole.good.find("PK\x01\x02")));
        targets.back().changes = 800;
    }
    // As `convert` writes them, alone and as chunks.
    writeSog(loadScene(writeSogFolder(folder, "sog", makeSog())), folder.file("a.sog"));
    const std::string written = textIn(folder.file("a.sog"));
    targets.push_back({.name = "written bundle", .good = written, .changes = 600, .most_splats = 40});
    (void)writeStreamed(folder, "bundles", levels, {"a", "b", "c", "env"});
    (void)folder.write("bundles/b.sog", written);
    CHECK(loadScene(folder.file("bundles")).size() == 24);
    targets.push_back({.name = "a written bundle as a chunk",
                       .good = written,
                       .changes = 300,
                       .file = "bundles/b.sog",
                       .source = "bundles",
                       .most_splats = 40});
    return targets;
}

void attackSog(std::size_t stride) {
    const Folder folder;
    attack(folder, sogTargets(folder), stride, 8, 768, readWhole);
}

TEST_CASE("broken SOG scenes, some of them") { attackSog(kFew); }
TEST_CASE("broken SOG scenes" * nightly()) { attackSog(1); }
#endif

}  // SUITE(hostile_scene)
