// Broken scene files of every format but SOG: each loads into a whole scene or is refused in one line.
#include "tests/engine/scene/gltf_files.h"
#include "tests/engine/scene/hostile_scenes.h"
#include "tests/engine/scene/ksplat_files.h"
#include "tests/hostile.h"

TEST_SUITE_BEGIN("hostile_scene");

namespace hostile_scene_test {

using namespace binosplat;
using namespace binosplat::test;

namespace {

// Loads from one file, overwritten for each input.
class SceneAttempts {
public:
    explicit SceneAttempts(std::string name) : name_(std::move(name)) {}
    ~SceneAttempts() {
        MESSAGE(fmt::format("{}: {} broken files, {} loaded, {} refused", name_, tally_.inputs, tally_.read, tally_.refused));
        CHECK(tally_.refused > tally_.inputs / 4);
        CHECK(peakMebibytes() < 512);
    }
    SceneAttempts(const SceneAttempts&) = delete;
    SceneAttempts& operator=(const SceneAttempts&) = delete;

    Attempt attempt() {
        return [this](const std::string& what, const std::string& bytes) {
            const std::string path = folder_.write("broken", bytes);
            tally_.attempt(name_ + ", " + what, [&] { checkWhole(loadScene(path)); });
        };
    }

private:
    static void checkWhole(const Scene& scene) {
        const std::size_t splats = scene.size();
        bool whole = scene.rotations.size() == splats && scene.scales.size() == splats && scene.opacities.size() == splats &&
                     scene.sh.size() == splats * 3 * static_cast<std::size_t>(shCoefficientCount(scene.sh_degree));
        for (std::size_t i = 0; whole && i < splats; ++i) {
            const glm::vec3& p = scene.positions[i];
            whole = std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(scene.scales[i].x) &&
                    std::isfinite(scene.scales[i].y) && scene.scales[i].x >= 0.0f && scene.scales[i].y >= 0.0f &&
                    std::abs(glm::length(scene.rotations[i]) - 1.0f) < 1e-4f && scene.opacities[i] >= 0.0f && scene.opacities[i] <= 1.0f;
        }
        for (const float value : scene.sh) { whole = whole && std::isfinite(value); }
        if (!whole) { FAIL_CHECK("a scene with values that are not to be"); }
    }

    std::string name_;
    Folder folder_;
    Tally tally_;
};

}  // namespace

TEST_CASE("broken PLY files") {
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly(9, encoding == Encoding::kLittle);
        ply.encoding = encoding;
        ply.header_before = "element strip 1\nproperty list uchar short index\n";
        appendTyped(ply.data_before, "uchar", 2.0, encoding);
        appendTyped(ply.data_before, "short", 1.0, encoding);
        appendTyped(ply.data_before, "short", 2.0, encoding);
        if (encoding == Encoding::kAscii) { ply.data_before += "\n"; }
        const std::string good = ply.bytes();
        SceneAttempts attempts(fmt::format("PLY {}", static_cast<int>(encoding)));
        truncate(good, attempts.attempt());
        flipBits(good, 1000, attempts.attempt());
        spliceBytes(good, 1000, attempts.attempt());
        replaceNumbers(good, good.find("end_header") + 200, attempts.attempt());
        shuffleLines(good, good.find("end_header") + 12, attempts.attempt());
    }
}

TEST_CASE("broken compressed PLY files") {
    const std::string good = makeCompressedPly();
    SceneAttempts attempts("compressed PLY");
    truncate(good, attempts.attempt());
    flipBits(good, 1500, attempts.attempt());
    spliceBytes(good, 1500, attempts.attempt());
    replaceNumbers(good, good.find("end_header"), attempts.attempt());
    shuffleLines(good, good.find("end_header") + 12, attempts.attempt());
}

TEST_CASE("broken .splat files") {
    const std::string good = makeSplatFile();
    SceneAttempts attempts(".splat");
    truncate(good, attempts.attempt());
    flipBits(good, 1000, attempts.attempt());
    spliceBytes(good, 1000, attempts.attempt());
}

TEST_CASE("broken .ksplat files") {
    for (const int level : {0, 1, 2}) {
        KsplatText text;
        text.level = level;
        text.degrees = {1, 2};
        const std::string good = text.bytes();
        // Most of the headers is empty: what is not is attacked.
        const std::size_t first = 4096 + 1024, sections = 4096;
        SceneAttempts attempts(fmt::format(".ksplat {}", level));
        const Attempt attempt = attempts.attempt();
        const auto around = [&](std::size_t begin, std::size_t end) {
            return Attempt([&, begin, end](const std::string& what, const std::string& bytes) {
                attempt(fmt::format("{} to {}, {}", begin, end, what), good.substr(0, begin) + bytes + good.substr(end));
            });
        };
        for (const auto& [begin, end] :
             {std::pair(std::size_t{0}, std::size_t{44}), std::pair(sections, sections + 44), std::pair(first, first + 44)}) {
            flipBits(good.substr(begin, end - begin), 1000, around(begin, end));
            spliceBytes(good.substr(begin, end - begin), 500, around(begin, end));
        }
        flipBits(good.substr(first + 1024), 200, around(first + 1024, good.size()));
        for (std::size_t length = 0; length < good.size(); length += 7 * kStep) {
            attempt(fmt::format("the first {} bytes", length), good.substr(0, length));
        }
    }
}

TEST_CASE("broken SPZ containers") {
    SpzText spz = makeSpz(3);
    spz.version = 4;
    const std::string good = makeSpzContainer(spz);
    SceneAttempts attempts("SPZ 4");
    truncate(good, attempts.attempt());
    flipBits(good, 1000, attempts.attempt());
    spliceBytes(good, 1000, attempts.attempt());
    // Records of extensions, alone.
    spz.flags = 2;
    const std::string records = spzRecord(7, "another's") + spzAxesRecord(10);
    const Attempt around = [&](const std::string& what, const std::string& bytes) {
        attempts.attempt()("records, " + what, makeSpzContainer(spz, bytes));
    };
    truncate(records, around);
    flipBits(records, 400, around);
    spliceBytes(records, 400, around);
}

TEST_CASE("broken SPZ files") {
    for (const std::uint32_t version : {2u, 3u}) {
        const std::string plain = makeSpz(version).bytes(), good = gzip(plain);
        SceneAttempts attempts(fmt::format("SPZ {}", version));
        const Attempt attempt = attempts.attempt();
        truncate(good, attempt);
        flipBits(good, 500, attempt);
        spliceBytes(good, 500, attempt);
        // Broken within a stream that is whole.
        const Attempt within = [&](const std::string& what, const std::string& bytes) { attempt("within gzip, " + what, gzip(bytes)); };
        truncate(plain, within);
        flipBits(plain, 1000, within);
        spliceBytes(plain, 1000, within);
        // And bare.
        truncate(plain, attempt);
        flipBits(plain, 500, attempt);
        spliceBytes(plain, 500, attempt);
    }
}

#ifdef BINOSPLAT_GLTF
TEST_CASE("broken glTF files") {
    GltfText gltf = makeGltf(9);
    gltf.nodes = R"([{"children":[1,2]},{"mesh":0,"rotation":[0.5,0.5,0.5,0.5],"scale":[1,2,-3]},{"mesh":0,"translation":[1,2,3]}])";
    gltf.other_primitives = R"(,{"mode":4,"attributes":{"POSITION":0}})";
    {
        const std::string good = gltf.glb();
        SceneAttempts attempts("GLB");
        truncate(good, attempts.attempt());
        flipBits(good, 2000, attempts.attempt());
        spliceBytes(good, 2000, attempts.attempt());
    }
    const std::string json = gltf.json("");
    {
        // Broken JSON within a GLB that is whole.
        SceneAttempts attempts("JSON of a GLB");
        const Attempt attempt = attempts.attempt();
        const Attempt within = [&](const std::string& what, const std::string& bytes) {
            attempt(what, GltfText::makeGlb(bytes, gltf.binary()));
        };
        flipBits(json, 1000, within);
        spliceBytes(json, 1000, within);
        replaceNumbers(json, json.size(), within);
    }
    const std::string embedded = gltf.embedded();
    SceneAttempts attempts("glTF");
    truncate(embedded, attempts.attempt());
    flipBits(embedded, 1000, attempts.attempt());
    spliceBytes(embedded, 1000, attempts.attempt());
    attempts.attempt()("deep", std::string(R"({"asset":)") + std::string(100'000, '['));
    attempts.attempt()("deep extras",
                       replaced(embedded, R"("nodes":[)", R"("extras":)" + std::string(60, '[') + std::string(60, ']') + R"(,"nodes":[)"));
}
#endif

}  // namespace hostile_scene_test
