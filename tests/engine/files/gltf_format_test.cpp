// glTF with KHR_gaussian_splatting: values, nodes, buffers, what is ignored and what is refused.
#include "engine/files/quantized.h"
#include "engine/files/scene_series.h"
#include "engine/files/spz.h"
#include "engine/srgb.h"
#include "engine/twin/harmonics.h"
#include "tests/engine/files/gltf_files.h"
#include "tests/engine/scene/scene_measures.h"
#include "tests/shared_data.h"

#include <glm/gtc/matrix_transform.hpp>

SUITE(gltf_format) {

std::string quoted(const glm::dmat4& matrix) {
    return fmt::format("[{:.17g}]", fmt::join(&matrix[0][0], &matrix[0][0] + 16, ","));
}

// The splats of `scene` are those of `plain`, placed by `world_from_node`.
void checkPlaced(const Scene& scene, const Scene& plain, const glm::dmat4& world_from_node, double epsilon) {
    REQUIRE(scene.size() == plain.size());
    const glm::dmat3 linear(world_from_node);
    for (std::size_t i = 0; i < plain.size(); ++i) {
        const glm::dvec3 position(world_from_node * glm::dvec4(glm::dvec3(plain.positions[i]), 1.0));
        CHECK(glm::length(position - glm::dvec3(scene.positions[i])) < epsilon);
        const glm::dmat3 covariance = linear * covarianceOf(plain, i) * glm::transpose(linear);
        CHECK(largest(covariance - covarianceOf(scene, i)) < epsilon * largest(covariance));
    }
}

void checkAlike(const Scene& a, const Scene& b) {
    CHECK(these(a.sh_degree, a.positions) == these(b.sh_degree, b.positions));
    checkPlaced(a, b, glm::dmat4(1.0), 1e-6);
    for (std::size_t i = 0; i < a.sh.size(); ++i) {
        CHECK(a.sh[i] == doctest::Approx(b.sh[i]).epsilon(1e-5));
    }
    for (std::size_t i = 0; i < a.size(); ++i) {
        CHECK(a.opacities[i] == doctest::Approx(b.opacities[i]).epsilon(1e-6));
    }
}

glm::dvec3 colourOf(const Scene& scene, std::size_t splat, const glm::dvec3& seen_along) {
    const int width = 3 * shCoefficientCount(scene.sh_degree);
    return reference::evaluateHarmonics(scene.sh.data() + width * splat, scene.sh_degree,
                                        glm::normalize(seen_along));
}

TEST_CASE_FIXTURE(InFolder, "a glTF holds what a PLY of the same splats holds, whatever its buffers are") {
    for (const int rest_count : {0, 9, 24, 45}) {
        const Scene expected = loadScene(folder.write("same.ply", makePly(rest_count, true).bytes()));
        const GltfText gltf = makeGltf(rest_count);
        const auto [notes, scene] = readScene(folder.write("a.glb", gltf.glb()));
        checkAlike(scene, expected);
        CHECK(these(scene.by_distance, scene.y_up, scene.vertical_axis, notes.lines.empty(),
                    notes.three_scales) == these(true, true, 1, true, true));
        checkAlike(loadScene(folder.write("in_its_text", gltf.embedded())), expected);
        (void)folder.write("its splats.bin", gltf.binary());
        checkAlike(loadScene(folder.write("beside.gltf", gltf.json(R"(,"uri":"its%20splats.bin")"))),
                   expected);
    }
}

TEST_CASE_FIXTURE(InFolder, "values may come in turn, and other things among them") {
    const Scene expected = loadScene(folder.write("same.ply", makePly(0, true).bytes()));
    // One row of 56 bytes per splat: position, rotation, scale, opacity, colour.
    const GltfText gltf = makeGltf(0);
    std::string rows;
    const std::size_t widths[] = {12, 16, 12, 4, 12}, starts[] = {0, 36, 84, 120, 132};
    for (std::size_t splat = 0; splat < 3; ++splat) {
        for (std::size_t i = 0; i < 5; ++i) {
            rows += gltf.binary().substr(starts[i] + splat * widths[i], widths[i]);
        }
    }
    nlohmann::json json = nlohmann::json::parse(gltf.json(""));
    json["bufferViews"] = nlohmann::json::array({{{"buffer", 0}, {"byteLength", 168}, {"byteStride", 56}}});
    for (std::size_t i = 0, offset = 0; i < 5; offset += widths[i], ++i) {
        json["accessors"][i].update({{"bufferView", 0}, {"byteOffset", offset}});
    }
    checkAlike(loadScene(folder.write("rows.glb", GltfText::makeGlb(json.dump(), rows))), expected);

    GltfText more = makeGltf(0);
    more.other_primitives = R"(,{"attributes":{"POSITION":0}},{"mode":0,"attributes":{"POSITION":0}})";
    more.other_keys =
        R"(,"materials":[{"name":"x"}],"images":[{"uri":"nowhere.png"}],"textures":[{"source":0}],)"
        R"("animations":"broken","extras":{"a":[[[]]]})";
    const auto [notes, scene] = readScene(folder.write("more.glb", more.glb()));
    checkAlike(scene, expected);
    checkSays(notes.lines, "2 primitives without KHR_gaussian_splatting (meshes, points) were left out");
}

TEST_CASE_FIXTURE(InFolder, "nodes place their splats, shapes and colours along with them, mirrored or not") {
    const Scene plain = loadScene(folder.write("plain.glb", makeGltf(45).glb()));
    const glm::dmat4 turned = glm::mat4_cast(glm::angleAxis(0.9, glm::normalize(glm::dvec3(1.0, -2.0, 0.5))));
    const glm::dmat4 moved = glm::translate(glm::dmat4(1.0), {3, -4, 5});
    const auto scaled = [](double x, double y, double z) { return glm::scale(glm::dmat4(1.0), {x, y, z}); };
    for (const glm::dmat4& placed : {moved, turned, moved * scaled(2.5, 2.5, 2.5), turned * scaled(-1, 1, 1),
                                     scaled(-3, -3, -3) * turned, moved * turned * scaled(0.5, -0.5, 0.5)}) {
        GltfText gltf = makeGltf(45);
        gltf.nodes = R"([{"mesh":0,"matrix":)" + quoted(placed) + "}]";
        const auto [notes, scene] = readScene(folder.write("placed.glb", gltf.glb()));
        CHECK(notes.lines.empty());
        checkPlaced(scene, plain, placed, 1e-5);
        for (std::size_t i = 0; i < 3; ++i) {
            for (const glm::dvec3 direction : {glm::dvec3(1, 0, 0), glm::dvec3(0.2, -0.7, 0.4),
                                               glm::dvec3(-1, 2, 3), glm::dvec3(0, 0, -1)}) {
                const glm::dvec3 colour = colourOf(plain, i, direction);
                CHECK(glm::length(colour - colourOf(scene, i, glm::dmat3(placed) * direction)) <
                      1e-5 * glm::length(colour));
            }
        }
    }
    // With uneven scales, the ellipsoids are stretched exactly.
    GltfText gltf = makeGltf(0);
    gltf.nodes = R"([{"children":[1],"scale":[2,1,-0.25]},{"mesh":0,"rotation":[0.5,0.5,0.5,0.5],)"
                 R"("translation":[1,2,3]}])";
    const auto [notes, scene] = readScene(folder.write("stretched.glb", gltf.glb()));
    checkSays(notes.lines, "unevenly");
    const glm::dmat4 inner =
        glm::translate(glm::dmat4(1.0), {1, 2, 3}) * glm::mat4_cast(glm::dquat(0.5, 0.5, 0.5, 0.5));
    checkPlaced(scene, plain, scaled(2, 1, -0.25) * inner, 1e-5);
}

TEST_CASE_FIXTURE(InFolder, "splats that lie far from 0 count from an origin near them, with their detail") {
    const Scene plain = loadScene(folder.write("plain.glb", makeGltf(9).glb()));
    const glm::dvec3 away(4'485'123.25, -1'870'456.5, 0.0);
    const glm::dquat turn = glm::angleAxis(0.9, glm::normalize(glm::dvec3(1.0, -2.0, 0.5)));
    GltfText gltf = makeGltf(9);
    gltf.nodes = R"([{"mesh":0,"matrix":)" +
                 quoted(glm::translate(glm::dmat4(1.0), away) * glm::mat4_cast(turn)) + "}]";
    auto [notes, scene] = readScene(folder.write("far.glb", gltf.glb()));
    CHECK(glm::distance(scene.origin, away) < 10.0);
    CHECK(these(scene.origin.z, scene.origin) == these(0.0, glm::round(scene.origin)));
    checkSays(notes.lines, "count from " + describeOrigin(scene));
    for (std::size_t i = 0; i < 3; ++i) {
        const glm::dvec3 expected = turn * glm::dvec3(plain.positions[i]) + away;
        CHECK(glm::distance(glm::dvec3(scene.positions[i]) + scene.origin, expected) < 1e-6);
    }
    // All files of a moving scene take the first one's origin.
    for (const char* frame : {"f1.glb", "f2.glb"}) { (void)folder.write(frame, gltf.glb()); }
    CHECK(SceneSeries(folder.file("")).load(1, notes).origin == scene.origin);
    // A scene that is nearer than that keeps its coordinates.
    gltf.nodes = R"([{"mesh":0,"translation":[100,0,-9000]}])";
    CHECK(loadScene(folder.write("near.glb", gltf.glb())).origin == glm::dvec3(0.0));
}

TEST_CASE_FIXTURE(InFolder, "several primitives and nodes are one scene, of the highest degree among them") {
    GltfText gltf = makeGltf(9);
    const std::string attributes =
        R"("POSITION":0,"KHR_gaussian_splatting:ROTATION":1,"KHR_gaussian_splatting:SCALE":2,)"
        R"("KHR_gaussian_splatting:OPACITY":3,"KHR_gaussian_splatting:SH_DEGREE_0_COEF_0":4)";
    gltf.other_primitives = R"(,{"mode":0,"attributes":{)" + attributes +
                            R"(},"extensions":{"KHR_gaussian_splatting":)" + gltf.extension + "}}";
    gltf.nodes = R"([{"mesh":0},{"children":[2]},{"mesh":0,"translation":[10,0,0]},{"mesh":0}])";
    gltf.roots = "[1,0]";  // the last node is in no scene
    const Scene scene = loadScene(folder.write("several.glb", gltf.glb()));
    REQUIRE(scene.size() == 12);
    CHECK(these(scene.sh_degree, scene.positions[0].x, scene.positions[6].x) == these(1, 11.0f, 1.0f));
    CHECK(scene.sh[3] != 0.0f);           // of the first primitive
    CHECK(scene.sh[3 * 12 + 3] == 0.0f);  // of the second, which has only the constant band
    CHECK(scene.sh[3 * 12 + 1] == scene.sh[1]);
}

TEST_CASE_FIXTURE(InFolder, "what the extension's keys say is kept, or told if it is not known") {
    LoadNotes notes;
    const auto loadWith = [&](const std::string& keys) {
        GltfText gltf = makeGltf(0);
        gltf.extension = "{" + keys + "}";
        return loadScene(folder.write("keys.glb", gltf.glb()), 0, &notes);
    };
    const std::string usual = R"("kernel":"ellipse","colorSpace":"srgb_rec709_display")";
    CHECK(loadWith(usual + R"(,"sortingMethod":"cameraDistance","projection":"perspective")").by_distance);
    CHECK(these(notes.axes, notes.colour_space, notes.lines.empty()) ==
          these("x left, y up, z front; right-handed (glTF's own)", "srgb_rec709_display (named by the file)",
                true));
    CHECK_FALSE(loadWith(usual + R"(,"sortingMethod":"zDepth")").by_distance);
    CHECK(notes.lines.empty());
    CHECK(loadWith(R"("kernel":"cube","colorSpace":"p3","sortingMethod":"none","projection":"fisheye")")
              .by_distance);
    CHECK(notes.lines.size() == 4);
    CHECK(loadWith("").size() == 3);
    CHECK(notes.lines.empty());
    const Scene light = loadWith(R"("kernel":"ellipse","colorSpace":"lin_rec709_display")");
    CHECK(light.is_linear);
    checkSays(notes.lines, "linear light");
    for (const bool as_ply : {true, false}) {
        CHECK_THROWS_WITH_AS(
            as_ply ? writePly(light, folder.file("out.ply")) : writeSpz(light, folder.file("out.spz")),
            doctest::Contains("cannot hold colours of linear light"), Error);
    }
    CHECK(folder.fileCount() == 1);
}

TEST_CASE_FIXTURE(InFolder, "of splats in two colour spaces the fewer are converted") {
    const std::string linear = R"({"kernel":"ellipse","colorSpace":"lin_rec709_display"})";
    for (const int linear_parts : {1, 2}) {
        GltfText gltf = makeGltf(0);
        for (int k = 0; k < 3; ++k) {
            gltf.add(fmt::format("SH_DEGREE_1_COEF_{}", k), "VEC3", {.02, 0, .03, 0, .01, 0, .03, .02, .01});
        }
        const Scene plain = loadScene(folder.write("plain.glb", gltf.glb()));
        const std::string json = gltf.json("");
        const std::size_t begin = json.find(R"({"mode":0)"), end = json.find("]}],\"buffers\"");
        const std::string other = replaced(json.substr(begin, end - begin), gltf.extension, linear);
        for (int part = 0; part < linear_parts; ++part) { gltf.other_primitives += "," + other; }
        const auto [notes, scene] = readScene(folder.write("both.glb", gltf.glb()));
        REQUIRE(scene.size() == 3u + 3u * linear_parts);
        CHECK(scene.is_linear == (linear_parts == 2));
        CHECK(countSaying(notes.lines, "3 of ") == 1);
        for (std::size_t i = 0; i < scene.size(); ++i) {
            const bool was_linear = i >= 3;
            for (const glm::dvec3 direction :
                 {glm::dvec3(1, 0, 0), glm::dvec3(0, 0.6, -0.8), glm::dvec3(0, -1, 0)}) {
                const glm::dvec3 before = 0.5 + colourOf(plain, i % 3, direction);
                const glm::dvec3 expected = was_linear == scene.is_linear ? before
                                            : was_linear                  ? encodedOf(before)
                                                                          : lightOf(before);
                CHECK(glm::length(0.5 + colourOf(scene, i, direction) - expected) <
                      (was_linear == scene.is_linear ? 1e-6 : 2e-3));
            }
        }
    }
}

// Where they are not usual, by case of the conformance matrix.
const std::map<std::string, glm::dvec3> kLogsOfScales{{"scale_f32", {0.2, -0.1, 0.7}},
                                                      {"scale_i8", {1, -2, 3}},
                                                      {"scale_i8_norm", {1, 0, -1}},
                                                      {"scale_i16", {2, -3, 4}},
                                                      {"scale_i16_norm", {1, 0, -1}}};
const std::map<std::string, double> kOpacities{
    {"opacity_f32", 0.75}, {"opacity_u8_norm", 64.0 / 255.0}, {"opacity_u16_norm", 16384.0 / 65535.0}};

TEST_CASE("the fifteen cases of the conformance matrix give the values that they hold" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Folder folder;
    const std::string path = (*data / "formats/khr_conformance_matrix.glb").string();
    const auto [mixed, all] = readScene(path);
    CHECK(all.is_linear);
    CHECK(countSaying(mixed.lines,
                      "1 of 15 splats have colours in srgb_rec709_display and were converted to "
                      "lin_rec709_display") == 1);
    CHECK(mixed.colour_space == "lin_rec709_display (named by the file)");
    const std::string glb = textIn(path);
    std::uint32_t text_bytes = 0;
    std::memcpy(&text_bytes, glb.data() + 12, 4);
    nlohmann::json document = nlohmann::json::parse(glb.substr(20, text_bytes));
    int cases = 0;
    for (std::size_t node = 0; node < document["nodes"].size(); ++node) {
        if (!document["nodes"][node].contains("mesh")) { continue; }
        const std::string name = document["nodes"][node]["name"];
        CAPTURE(name);
        ++cases;
        document["scenes"][0]["nodes"] = {node};
        const auto [notes, scene] = readScene(
            folder.write("one.glb", GltfText::makeGlb(document.dump(), glb.substr(28 + text_bytes))));
        REQUIRE(scene.size() == 1);
        for (std::size_t i = 0; i < 48; ++i) {
            const double stored = i < scene.sh.size() ? scene.sh[i] : 0.0;
            const double in_all =
                scene.is_linear ? stored : (lightOf(0.5 + kShConstant * stored) - 0.5) / kShConstant;
            CHECK(all.sh[48 * node + i] == doctest::Approx(i < 3 ? in_all : stored).epsilon(1e-5));
        }
        CHECK(these(scene.is_linear, scene.positions[0]) ==
              these((name != "scale_f32"), glm::vec3(1.0f, 2.0f, 3.0f)));
        // Half a turn about x, which changes no covariance along the axes. As in the draft, all scales are
        // logarithms.
        const auto valueOf = [&](const auto& values, auto usual) {
            return values.contains(name) ? values.at(name) : usual;
        };
        const glm::dvec3 logs = valueOf(kLogsOfScales, glm::dvec3(0.0, 0.5, -0.5));
        glm::dmat3 expected(0.0);
        for (int axis = 0; axis < 3; ++axis) { expected[axis][axis] = std::exp(2.0 * logs[axis]); }
        CHECK(largest(covarianceOf(scene, 0) - expected) < 1e-5 * largest(expected));
        CHECK(scene.opacities[0] == doctest::Approx(valueOf(kOpacities, 0.25)).epsilon(1e-6));
        CHECK(scene.sh_degree == (name.starts_with("sh_degree") ? name.back() - '0' : 0));
        for (std::size_t i = 0; i < scene.sh.size(); ++i) {
            CHECK(scene.sh[i] ==
                  doctest::Approx(static_cast<double>(i / 3) + 0.1 * static_cast<double>(i % 3 + 1)));
        }
        CHECK(countSaying(notes.lines, "logarithms") == 1);
    }
    CHECK(cases == 15);
}

TEST_CASE("an unknown kernel and colour space are drawn as known ones, COLOR_0 as harmonics" *
          needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const auto [notes, scene] = readScene((*data / "formats/khr_extensible_fallback.gltf").string());
    REQUIRE(scene.size() == 1);
    CHECK(scene.opacities[0] == 0.5f);
    for (int channel = 0; channel < 3; ++channel) {
        CHECK(scene.sh[channel] == doctest::Approx(1.0 + channel).epsilon(1e-5));
    }
    CHECK(these(notes.lines.size(), countSaying(notes.lines, "customShape"),
                countSaying(notes.lines, "custom_space_display")) == these(2, 1, 1));
}

TEST_CASE_FIXTURE(InFolder, "a small file whose nodes name many primitives does not fill the memory") {
    const auto errorOf = [&](std::size_t nodes, std::size_t primitives) {
        GltfText gltf = makeGltf(0);
        gltf.nodes = R"([{"mesh":0})", gltf.roots = "[0";
        for (std::size_t i = 1; i < nodes; ++i) {
            gltf.nodes += R"(,{"mesh":0})";
            gltf.roots += fmt::format(",{}", i);
        }
        gltf.nodes += "]", gltf.roots += "]";
        for (std::size_t i = 1; i < primitives; ++i) { gltf.other_primitives += ",{}"; }
        return loadError(folder.write("a.glb", gltf.glb()));
    };
    CHECK(errorOf(512, 512).empty());
    CHECK(contains(errorOf(513, 512),
                   "a.glb: its nodes have 262656 primitives and more, expected at most 262144"));
}

SCRIPT(gltf_format, "engine/files/gltf_format") {
    const Folder folder;
    const GltfText gltf = makeGltf(9);
    runFaults(gltf.json(""), [&](const std::string& json) {
        return loadError(folder.write("broken.glb", GltfText::makeGlb(json, gltf.binary())));
    });
}

TEST_CASE_FIXTURE(InFolder, "attributes, headers and buffers that do not fit are named") {
    const auto checkGlb = [&](const std::string& part, const std::string& bytes) {
        checkError(part, folder.write("broken.glb", bytes));
    };
    for (const auto& [left_out, message] :
         {std::pair("SCALE", "has no attribute KHR_gaussian_splatting:SCALE"),
          {"SH_DEGREE_1_COEF_1", "expected all of its degree"},
          {"SH_DEGREE_0_COEF_0", "degree 1, but none of degree 0"}}) {
        GltfText gltf = makeGltf(9);
        gltf.remove(left_out);
        checkGlb(message, gltf.glb());
    }
    const auto checkOpacity = [&](const char* part, const char* type, const std::vector<double>& values,
                                  int component = kGltfFloat) {
        GltfText gltf = makeGltf(9);
        gltf.add("OPACITY", type, values, component);
        checkGlb(part, gltf.glb());
    };
    checkOpacity("holds integers, expected floats or normalized", "SCALAR", {1, 2, 3}, kGltfUint8);
    checkOpacity("has 3 components a splat, expected 1", "VEC3", {1, 2, 3});
    checkOpacity("has 3 positions and 2 values", "SCALAR", {1, 2});

    const GltfText gltf = makeGltf(9);
    const std::string json = gltf.json(""), blanks(std::size_t{32} << 20, ' ');
    checkGlb("expected a GLB's header of 20", gltf.glb().substr(0, 15));
    checkGlb("version 1, expected 2",
             replaced(gltf.glb(), std::string("glTF\2", 5), std::string("glTF\1", 5)));
    checkGlb("bytes of JSON, expected at most", GltfText::makeGlb(json + blanks, gltf.binary()));
    checkError("buffers[0]: has no uri", folder.write("out.gltf", json));
    checkError("bytes of JSON, expected at most 33554432", folder.write("long.gltf", json + blanks));
}

}  // SUITE(gltf_format)
