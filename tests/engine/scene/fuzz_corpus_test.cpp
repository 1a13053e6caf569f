// The inputs that fuzzing kept, replayed; and where its first ones come from.
#include "tests/engine/scene/gltf_files.h"
#include "tests/engine/scene/hostile_scenes.h"
#include "tests/engine/scene/ksplat_files.h"
#include "tests/fuzz/targets.h"
#ifdef BINOSPLAT_SOG
#include "tests/engine/scene/streamed_scenes.h"
#endif

#include <iterator>
#include <map>

TEST_SUITE_BEGIN("fuzz_corpus");

namespace fuzz_corpus_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

const std::filesystem::path kCorpus = BINOSPLAT_SOURCE_DIR "/tests/fuzz/corpus";

std::string settingsText(const std::string& name) { return textOf(BINOSPLAT_SOURCE_DIR "/configs/" + name); }

// By target: whole inputs from the writers of these tests.
std::multimap<std::string, std::string> makeSeeds() {
    std::multimap<std::string, std::string> seeds;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly(9, encoding == Encoding::kLittle);
        ply.encoding = encoding;
        seeds.emplace("ply", ply.bytes().substr(4));
    }
    seeds.emplace("ply", makeCompressedPly().substr(4));
    seeds.emplace("scene", makeSplatFile());
    for (const int level : {0, 1, 2}) {
        KsplatText text;
        text.level = level;
        text.degrees = {2, 1};
        seeds.emplace("ksplat", text.bytes());
    }
    for (const std::uint32_t version : {2u, 3u}) {
        seeds.emplace("spz", makeSpz(version).bytes().substr(4));
        seeds.emplace("scene", gzip(makeSpz(version).bytes()));
    }
    SpzText container = makeSpz(3);
    container.version = 4;
    seeds.emplace("scene", makeSpzContainer(container));
    container.flags = 2;
    seeds.emplace("spz_bare", makeSpzContainer(container, spzRecord(7, "another's") + spzAxesRecord(10)).substr(4));
    seeds.emplace("spz_bare", makeSpz(2).bytes().substr(4));
    seeds.emplace("convert", makeSplatFile());
    seeds.emplace("convert", makePly(9, true).bytes());
    seeds.emplace("convert", makeSpz(3).bytes());
#ifdef BINOSPLAT_GLTF
    GltfText gltf = makeGltf(9);
    gltf.nodes = R"([{"children":[1]},{"mesh":0,"rotation":[0.5,0.5,0.5,0.5],"scale":[1,2,-3],"translation":[1,2,3]}])";
    seeds.emplace("gltf", gltf.glb());
    seeds.emplace("gltf", makeGltf(0).embedded());
#endif
#ifdef BINOSPLAT_SOG
    for (const int version : {1, 2}) {
        SogText files = makeSog(version, version == 1);
        seeds.emplace("sog_meta", files["meta.json"]);
        seeds.emplace("sog_bundle", makeZip(files, true));
    }
    seeds.emplace("lod_meta", makeLodMeta());
#endif
    seeds.emplace("settings", settingsText("default.toml"));
    seeds.emplace("settings", settingsText("bench/pareto.toml"));
    seeds.emplace("headset", settingsText("headsets/quest3.toml"));
    seeds.emplace("cameras", R"([{"img_name":"a","width":640,"height":480,"position":[1,2,-3.5],"rotation":[[1,0,0],[0,1,0],[0,0,1]],)"
                             R"("fx":500,"fy":501.5,"cx":320,"cy":240}])");
    seeds.emplace("motion", "time_ms,x,y,z,qw,qx,qy,qz\n0,0.1,1.5,-0.25,1,0,0,0\n# a remark\n16.5,0.11,1.5,-0.25,1,0,0,0\n");
#ifdef BINOSPLAT_OPENXR
    seeds.emplace("script", settingsText("simulated/walk.script"));
    seeds.emplace("script",
                  "size 64 32\nextension XR_KHR_visibility_mask off\nheadset \"a b.toml\"\nhead-motion m.csv axes unity start 1 skip 0.5\n"
                  "aim left turn 5 5\naxis left trigger 0.5 0.5\ntouch left a 0 1\nframes from 2 to 9 every 3\nvisibility-mask on\n"
                  "at 0.1 should-render off\nat 0.2 visible off\nat 0.3 focused off\nat 0.4 slow-images 3\nat 0.5 lose-session\n"
                  "at 0.6 lose-instance\nat 0.7 eye left angles -40 40 40 -40\nat 0.8 controller right off\n");
    seeds.emplace("script", "head 0 rotation 0 0.6 0 0.8\nhead 1 position 1 2 3\ncontroller left -1 turn 350 -80\nframes none\n");
#endif
    return seeds;
}

}  // namespace

TEST_CASE("every kept input is read or refused in one line") {
    std::size_t inputs = 0, bytes = 0;
    for (const fuzz::Target& target : fuzz::targets()) {
        std::size_t of_target = 0;
        for (const auto& entry : std::filesystem::directory_iterator(kCorpus / target.name)) {
            const std::string input = textOf(entry.path().string());
            CAPTURE(entry.path().string());
            fuzz::runTarget(target.name, {reinterpret_cast<const std::uint8_t*>(input.data()), input.size()});
            ++of_target;
            bytes += input.size();
        }
        CHECK_MESSAGE(of_target > 0, "no inputs for ", target.name);
        inputs += of_target;
    }
    MESSAGE(fmt::format("{} inputs of {} bytes", inputs, bytes));
    CHECK(bytes < 400'000);
}

TEST_CASE("the writers' files are whole") {
    for (const auto& [target, bytes] : makeSeeds()) {
        CAPTURE(target);
        fuzz::runTarget(target, {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
    }
}

// Not a test: `fuzz_corpus_test --no-skip --test-case="seeds are written"` begins the corpus anew.
TEST_CASE("seeds are written" * doctest::skip()) {
    int number = 0;
    for (const auto& [target, bytes] : makeSeeds()) {
        std::filesystem::create_directories(kCorpus / target);
        std::ofstream(kCorpus / target / fmt::format("seed_{}", number++), std::ios::binary) << bytes;
    }
}

}  // namespace fuzz_corpus_test
