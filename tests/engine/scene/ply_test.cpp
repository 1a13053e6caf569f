// What a PLY file means: values, encodings, orders, types, and what is written reads back.
#include "engine/scene/ply.h"
#include "engine/scene/describe.h"
#include "engine/scene/procedural.h"
#include "tests/engine/scene/ply_files.h"

TEST_SUITE_BEGIN("ply");

namespace ply_test {

using namespace binosplat;
using namespace binosplat::test;

TEST_CASE("a PLY's numbers arrive activated, in every encoding") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly();
        ply.encoding = encoding;
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("known.ply", ply.bytes()), 0, &notes);
        REQUIRE(scene.size() == 3);
        CHECK(scene.sh_degree == 0);
        CHECK(scene.positions[2] == glm::vec3(-3.0f, 0.125f, 6.0f));
        CHECK(scene.sh == std::vector<float>{0.0f, 0.25f, 0.5f, 0.0f, 0.5f, 1.0f, 0.0f, -0.5f, -1.0f});
        CHECK(scene.opacities[0] == 0.5f);
        CHECK(scene.opacities[1] == doctest::Approx(1.0 / (1.0 + std::exp(-2.0))).epsilon(1e-6));
        CHECK(scene.scales[0].x == 1.0f);
        CHECK(scene.scales[0].y == doctest::Approx(std::exp(-3.0)).epsilon(1e-6));
        CHECK(scene.rotations[0] == glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
        CHECK(scene.rotations[1] == glm::quat(0.5f, 0.5f, 0.5f, 0.5f));
        CHECK(scene.rotations[2] == glm::quat(0.0f, 0.0f, -1.0f, 0.0f));
        CHECK(notes.splats_in_file == 3);
        CHECK_FALSE(notes.three_scales);
        CHECK(notes.lines.empty());
    }
}

TEST_CASE("f_rest is channel-major in the file and coefficient-major in the scene") {
    const Folder folder;
    for (const int degree : {1, 2, 3}) {
        const int per_channel = shCoefficientCount(degree) - 1;
        const Scene scene = loadScene(folder.write("sh.ply", makePly(3 * per_channel).bytes()));
        REQUIRE(scene.sh_degree == degree);
        for (int channel = 0; channel < 3; ++channel) {
            for (int k = 1; k <= per_channel; ++k) {
                const std::size_t at = static_cast<std::size_t>((1 * shCoefficientCount(degree) + k) * 3 + channel);
                CHECK(scene.sh[at] == static_cast<float>(100 + channel * per_channel + k - 1));
            }
        }
    }
}

TEST_CASE("SH bands that are all zero are left out, even if a band below is used late") {
    const Folder folder;
    PlyText ply = makePly(45);
    for (int i = 0; i < 45; ++i) {
        for (double& value : ply[fmt::format("f_rest_{}", i)].values) { value = 0.0; }
    }
    LoadNotes notes;
    CHECK(loadScene(folder.write("flat.ply", ply.bytes()), 0, &notes).sh_degree == 0);
    CHECK(notes.sh_degree_in_file == 3);
    REQUIRE(notes.lines.size() == 1);
    CHECK(contains(notes.lines[0], "SH bands above degree 0"));

    // 700 splats are three blocks; the only coefficient of band 2 is in the last splat, so rows stored before are widened.
    for (Column& column : ply.columns) { column.values.resize(700, column.values[0]); }
    ply["f_rest_0"].values[3] = 7.0;     // channel 0, k = 1
    ply["f_rest_21"].values[699] = 9.0;  // channel 1, k = 7
    const Scene scene = loadScene(folder.write("late.ply", ply.bytes()));
    REQUIRE(scene.sh_degree == 2);
    REQUIRE(scene.sh.size() == 700 * 27);
    CHECK(scene.sh[3 * 27 + 3 * 1 + 0] == 7.0f);
    CHECK(scene.sh[699 * 27 + 3 * 7 + 1] == 9.0f);
    CHECK(std::count(scene.sh.begin(), scene.sh.end(), 0.0f) == 700 * 25 - 2 + 0);  // f_dc_1 and f_dc_2 are not zero
}

TEST_CASE("properties come in any order, of any type, among others") {
    const Folder folder;
    const Scene expected = loadScene(folder.write("plain.ply", makePly(9).bytes()));
    std::uint32_t state = 1;
    for (int round = 0; round < 12; ++round) {
        PlyText ply = makePly(9);
        ply.encoding = kEncodings[round % 3];
        for (std::size_t i = ply.columns.size(); i > 1; --i) {
            state = state * 1664525u + 1013904223u;
            std::swap(ply.columns[i - 1], ply.columns[state % i]);
        }
        for (const char* name : {"x", "f_rest_3", "rot_1", "opacity"}) { ply[name].type = round % 2 == 0 ? "double" : "float64"; }
        ply["f_rest_0"].type = "short";
        ply["f_rest_1"].type = "uint16";
        ply["f_rest_2"].type = "int32";
        ply["z"].type = "uchar";
        ply["scale_0"].type = "int8";
        ply["rot_2"].type = "char";
        ply["rot_0"].type = "uint";
        ply.columns.insert(ply.columns.begin() + round, {"red", "uchar", {255.0, 0.0, 17.0}});
        ply.columns.push_back({"confidence", "ushort", {1.0, 2.0, 3.0}});
        checkSameScene(loadScene(folder.write("shuffled.ply", ply.bytes())), expected);
    }
}

TEST_CASE("other elements are passed over, with and without lists, before and after the splats") {
    const Folder folder;
    const Scene expected = loadScene(folder.write("plain.ply", makePly().bytes()));
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly();
        ply.encoding = encoding;
        ply.header_before =
            "element camera 2\nproperty float a\nproperty uchar b\nelement strip 2\nproperty list uchar int index\nproperty double "
            "w\nelement none 5\n";
        ply.header_after = "element face 1\nproperty list uchar int vertex_indices\n";
        for (const double row : {1.0, 2.0}) {
            appendTyped(ply.data_before, "float", row, encoding);
            appendTyped(ply.data_before, "uchar", 3.0, encoding);
            if (encoding == Encoding::kAscii) { ply.data_before += "\n"; }
        }
        for (const int count : {3, 0}) {
            appendTyped(ply.data_before, "uchar", count, encoding);
            for (int i = 0; i < count; ++i) { appendTyped(ply.data_before, "int", i, encoding); }
            appendTyped(ply.data_before, "double", 0.5, encoding);
            if (encoding == Encoding::kAscii) { ply.data_before += "\n"; }
        }
        ply.data_after = "whatever follows";
        checkSameScene(loadScene(folder.write("more.ply", ply.bytes())), expected);
    }
}

TEST_CASE("line breaks of Windows are read") {
    const Folder folder;
    PlyText ply = makePly();
    const Scene expected = loadScene(folder.write("plain.ply", ply.bytes()));
    ply.line_break = "\r\n";
    checkSameScene(loadScene(folder.write("windows.ply", ply.bytes())), expected);
    ply.encoding = Encoding::kAscii;
    checkSameScene(loadScene(folder.write("windows.ply", replaced(ply.bytes(), "\n", "\n"))), expected);
}

TEST_CASE("of three scales the shortest becomes the last, the frame stays right-handed, and flattening drops it") {
    const Folder folder;
    for (std::size_t shortest = 0; shortest < 3; ++shortest) {
        PlyText ply = makePly(0, true);
        const double logs[] = {-1.0, -2.0, -0.5};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (double& value : ply[fmt::format("scale_{}", axis)].values) { value = axis == shortest ? -7.0 : logs[axis]; }
        }
        const double rotation[] = {0.3, -0.5, 0.7, 0.2};
        for (std::size_t i = 0; i < 4; ++i) {
            for (double& value : ply[fmt::format("rot_{}", i)].values) { value = rotation[i]; }
        }
        LoadNotes notes;
        Scene scene = loadScene(folder.write("three.ply", ply.bytes()), 0, &notes);
        const glm::mat3 trained = glm::mat3_cast(glm::normalize(glm::quat(0.3f, -0.5f, 0.7f, 0.2f)));
        const glm::mat3 kept = glm::mat3_cast(scene.rotations[0]);
        const int u = static_cast<int>((shortest + 1) % 3), v = static_cast<int>((shortest + 2) % 3);
        CHECK(glm::length(kept[0] - trained[u]) < 1e-6f);
        CHECK(glm::length(kept[1] - trained[v]) < 1e-6f);
        CHECK(glm::length(kept[2] - trained[static_cast<int>(shortest)]) < 1e-6f);  // the normal lies along the shortest axis
        CHECK(glm::determinant(kept) == doctest::Approx(1.0));
        CHECK(scene.scales[0].x == doctest::Approx(std::exp(logs[u])));
        CHECK(scene.scales[0].y == doctest::Approx(std::exp(logs[v])));
        CHECK(notes.three_scales);
        CHECK(notes.median_flatness == doctest::Approx(std::exp(-7.0 - std::min(logs[u], logs[v]))));
        REQUIRE(scene.isGaussian3d());
        CHECK(scene.thicknesses[0] == doctest::Approx(std::exp(-7.0)));
        writePly(scene, folder.file("again.ply"));
        checkSameScene(loadScene(folder.file("again.ply")), scene);
        CHECK(notes.lines.empty());
        flatten(scene, notes);
        CHECK_FALSE(scene.isGaussian3d());
        REQUIRE(notes.lines.size() == 1);
        CHECK(contains(notes.lines[0], "shortest axis"));
    }
}

TEST_CASE("splats with NaN, infinity, overflow or no rotation are skipped and counted") {
    const Folder folder;
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const Encoding encoding : kEncodings) {
        for (const char* name : {"x", "z", "f_dc_1", "f_rest_8", "opacity", "scale_1", "rot_3"}) {
            for (const double bad : {nan, infinity, -infinity}) {
                if (name == std::string_view("opacity") && bad == infinity) { continue; }  // is opacity 1
                PlyText ply = makePly(9);
                ply.encoding = encoding;
                ply[name].values[1] = bad;
                LoadNotes notes;
                const Scene scene = loadScene(folder.write("nan.ply", ply.bytes()), 0, &notes);
                REQUIRE(scene.size() == 2);
                CHECK(scene.positions[1].x == -3.0f);
                CHECK(scene.sh.size() == 2 * 12);
                CHECK(notes.skipped_not_finite == 1);
                CHECK(notes.skipped_zero_rotation == 0);
                REQUIRE(notes.lines.size() == 1);
                CHECK(contains(notes.lines[0], "1 of 3 splats skipped"));
            }
        }
    }
    PlyText ply = makePly(9);
    ply["scale_0"].values[0] = 89.0;  // exp(89) is beyond float32
    ply["rot_2"].values[2] = 0.0;
    ply["nx"].values[1] = nan;  // of no interest
    LoadNotes notes;
    CHECK(loadScene(folder.write("bad.ply", ply.bytes()), 0, &notes).size() == 1);
    CHECK(notes.skipped_not_finite == 1);
    CHECK(notes.skipped_zero_rotation == 1);
    CHECK(notes.lines.size() == 2);
}

TEST_CASE("a logit of infinity is opacity 1") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        for (const bool three_scales : {false, true}) {
            PlyText ply = makePly(9, three_scales);
            ply.encoding = encoding;
            ply["opacity"].values[1] = std::numeric_limits<double>::infinity();
            LoadNotes notes;
            const Scene scene = loadScene(folder.write("opaque.ply", ply.bytes()), 0, &notes);
            REQUIRE(scene.size() == 3);
            CHECK(scene.opacities[1] == 1.0f);
            CHECK(notes.lines.empty());
            writePly(scene, folder.file("again.ply"));
            CHECK(loadScene(folder.file("again.ply")).opacities[1] == 1.0f);
        }
    }
}

TEST_CASE("the shortest of three axes may have no extent, any other may not") {
    const Folder folder;
    const double none = -std::numeric_limits<double>::infinity();
    for (const Encoding encoding : kEncodings) {
        for (int axis = 0; axis < 3; ++axis) {
            CAPTURE(axis);
            PlyText ply = makePly(0, true);
            ply.encoding = encoding;
            ply[fmt::format("scale_{}", axis)].values[0] = none;
            LoadNotes notes;
            const Scene disc = loadScene(folder.write("disc.ply", ply.bytes()), 0, &notes);
            REQUIRE(disc.size() == 3);
            CHECK(disc.thicknesses[0] == 0.0f);
            const double kept = axis == 0 ? -3.0 : axis == 1 ? -5.0 : 0.0;  // the one that follows in cyclic order
            CHECK(disc.scales[0].x == doctest::Approx(std::exp(kept)));
            CHECK(notes.lines.empty());
            writePly(disc, folder.file("again.ply"));
            CHECK(loadScene(folder.file("again.ply")).thicknesses[0] == 0.0f);

            ply[fmt::format("scale_{}", (axis + 1) % 3)].values[0] = none;  // a needle without width
            CHECK(loadScene(folder.write("needle.ply", ply.bytes()), 0, &notes).size() == 2);
            CHECK(notes.skipped_not_finite == 1);
        }
        PlyText flat = makePly();
        flat.encoding = encoding;
        flat["scale_1"].values[0] = none;
        LoadNotes notes;
        CHECK(loadScene(folder.write("flat.ply", flat.bytes()), 0, &notes).size() == 2);
        CHECK(notes.skipped_not_finite == 1);
    }
}

TEST_CASE("a comment asks for antialiasing, the last one counts, and writing keeps it") {
    const Folder folder;
    const auto loadWith = [&](const std::string& comments, bool three_scales = true) {
        return loadScene(folder.write("said.ply", replaced(makePly(0, three_scales).bytes(), "comment made for a test\n", comments)));
    };
    CHECK_FALSE(loadWith("comment made for a test\n").antialiased);
    for (const char* comment : {"comment SplatRenderMode: mip\n", "comment  splatrendermode:  MIP \r\n", "comment antialiased 1\n",
                                "comment postshot.anti_aliasing=1\n", "comment SplatRenderMode: default\ncomment antialiased 1\n"}) {
        CAPTURE(comment);
        const Scene scene = loadWith(comment);
        CHECK(scene.antialiased);
        writePly(scene, folder.file("again.ply"));
        CHECK(loadScene(folder.file("again.ply")).antialiased);
    }
    for (const char* comment :
         {"comment SplatRenderMode: default\n", "comment SplatRenderMode:\n", "comment SplatRenderMode: mip or not\n",
          "comment antialiased 0\n", "comment antialiased 1\ncomment SplatRenderMode: default\n", "obj_info SplatRenderMode: mip\n"}) {
        CAPTURE(comment);
        const Scene scene = loadWith(comment);
        CHECK_FALSE(scene.antialiased);
        writePly(scene, folder.file("again.ply"));
        CHECK_FALSE(loadScene(folder.file("again.ply")).antialiased);
    }
    CHECK_FALSE(loadWith("comment SplatRenderMode: mip\n", false).antialiased);  // discs are not dimmed
}

TEST_CASE("a PLY that looks as if its activations had been applied is loaded as usual, with one line that says so") {
    const Folder folder;
    for (const bool three_scales : {false, true}) {
        PlyText ply = makePly(0, three_scales);
        ply["opacity"].values = {0.0, 1.0, 0.5};
        ply["scale_0"].values = {0.01, 0.5, 2.0};
        ply["scale_1"].values = {0.02, 0.5, 1e-6};
        if (three_scales) { ply["scale_2"].values = {0.001, 0.1, 3.0}; }
        for (Column& column : ply.columns) { column.values.resize(700, column.values[0]); }
        const auto linesOf = [&] {
            LoadNotes notes;
            CHECK(loadScene(folder.write("applied.ply", ply.bytes()), 0, &notes).size() == 700);
            return std::ranges::count_if(notes.lines, [](const std::string& line) { return contains(line, "activations applied"); });
        };
        CHECK(linesOf() == 1);
        CHECK(loadScene(folder.file("applied.ply")).opacities[1] == doctest::Approx(1.0 / (1.0 + std::exp(-1.0))));
        for (const auto& [name, usual] : {std::pair("opacity", 1.01), std::pair("opacity", -0.01), std::pair("scale_1", 0.0)}) {
            PlyText kept = ply;
            ply[name].values[650] = usual;  // one splat in the last block
            CHECK(linesOf() == 0);
            ply = kept;
        }
    }
    LoadNotes notes;
    PlyText empty = makePly();
    for (Column& column : empty.columns) { column.values.clear(); }
    (void)loadScene(folder.write("empty.ply", empty.bytes()), 0, &notes);
    CHECK(notes.lines.empty());
}

TEST_CASE("tiny and huge quaternions are normalised") {
    const Folder folder;
    for (const double length : {1e-30, 1e30}) {
        PlyText ply = makePly();
        for (const char* name : {"rot_0", "rot_1", "rot_2", "rot_3"}) { ply[name].values[0] = length; }
        CHECK(loadScene(folder.write("length.ply", ply.bytes())).rotations[0] == glm::quat(0.5f, 0.5f, 0.5f, 0.5f));
    }
}

TEST_CASE("an empty scene is a scene") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly(9, true);
        ply.encoding = encoding;
        for (Column& column : ply.columns) { column.values.clear(); }
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("empty.ply", ply.bytes()), 0, &notes);
        CHECK(scene.size() == 0);
        CHECK(notes.median_flatness == 0.0);
        CHECK(describeScene(scene, &notes).splats == 0);
        writePly(scene, folder.file("again.ply"));
        CHECK(loadScene(folder.file("again.ply")).size() == 0);
    }
}

TEST_CASE("what is written reads back the same") {
    const Folder folder;
    for (const int rest_count : {0, 9, 24, 45}) {
        const Scene scene = loadScene(folder.write("in.ply", makePly(rest_count).bytes()));
        double last = -1.0;
        writePly(scene, folder.file("out.ply"), [&](double share) {
            CHECK(share > last);
            last = share;
        });
        CHECK(last == 1.0);
        const Scene again = loadScene(folder.file("out.ply"));
        CHECK(again.positions == scene.positions);
        CHECK(again.sh == scene.sh);
        for (std::size_t i = 0; i < scene.size(); ++i) {
            CHECK(glm::length(again.rotations[i] - scene.rotations[i]) < 1e-6f);
            CHECK(glm::length(again.scales[i] / scene.scales[i] - 1.0f) < 1e-6f);
            CHECK(again.opacities[i] == doctest::Approx(scene.opacities[i]).epsilon(1e-6));
        }
    }
}

TEST_CASE("opacity 0 and 1 and scale 0 survive writing exactly") {
    const Folder folder;
    Scene scene;
    for (const float opacity : {0.0f, 1.0f, 1e-6f, 0.999999f}) {
        scene.positions.emplace_back(0.0f);
        scene.rotations.push_back(glm::identity<glm::quat>());
        scene.scales.emplace_back(0.0f, 1e-6f);
        scene.opacities.push_back(opacity);
        scene.sh.insert(scene.sh.end(), {0.0f, 0.0f, 0.0f});
    }
    writePly(scene, folder.file("ends.ply"));
    const Scene again = loadScene(folder.file("ends.ply"));
    REQUIRE(again.size() == 4);
    CHECK(again.opacities[0] == 0.0f);
    CHECK(again.opacities[1] == 1.0f);
    CHECK(again.opacities[2] == doctest::Approx(1e-6).epsilon(1e-5));
    CHECK(again.opacities[3] == doctest::Approx(0.999999).epsilon(1e-6));
    CHECK(again.scales[0].x == 0.0f);
    CHECK(again.scales[0].y == doctest::Approx(1e-6).epsilon(1e-5));
}

TEST_CASE("writing leaves nothing half-written") {
    const Folder folder;
    const Scene scene = makeBuiltin("builtin:one-splat");
    const auto errorOf = [&](const std::string& path) -> std::string {
        try {
            writePly(scene, path);
        } catch (const Error& error) { return error.what(); }
        return {};
    };
    CHECK(contains(errorOf(folder.file("absent/scene.ply")), "cannot be written"));
    CHECK(contains(errorOf(folder.file(".")), "is a directory"));
#ifndef _WIN32
    std::filesystem::create_symlink("/dev/null", folder.file("device.ply"));
    CHECK(contains(errorOf(folder.file("device.ply")), "not a regular file"));
    std::filesystem::remove(folder.file("device.ply"));
#endif
    // An old file stays as it was if the new one does not come to its end.
    writePly(scene, folder.file("kept.ply"));
    CHECK_THROWS_AS(writePly(makeBuiltin("builtin:atelier", 10'000), folder.file("kept.ply"),
                             [](double share) {
                                 if (share > 0.5) { fail("stopped"); }
                             }),
                    Error);
    CHECK(loadScene(folder.file("kept.ply")).size() == 1);
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("loading reports progress from 0 to 1") {
    const Folder folder;
    writePly(makeBuiltin("builtin:atelier", 100'000), folder.file("large.ply"));
    std::vector<double> shares;
    (void)loadScene(folder.file("large.ply"), 0, nullptr, [&](double share) { shares.push_back(share); });
    CHECK(shares.size() > 3);
    CHECK(std::is_sorted(shares.begin(), shares.end()));
    CHECK(shares.front() == 0.0);
    CHECK(shares.back() == 1.0);
}

}  // namespace ply_test
