// PLY files as other programs write them: what is read from each, what is told of it, and which are no
// scenes.
#include "tests/engine/scene/scene_measures.h"

SUITE(ply_of_others) {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

TEST_CASE_FIXTURE(InFolder, "properties come in any order, of any type, among others") {
    const Scene expected = loadScene(folder.write("plain.ply", makePly(9).bytes()));
    std::mt19937 random(1);
    for (int round = 0; round < 12; ++round) {
        PlyText ply = makeIn(kEncodings[round % 3], 9);
        for (std::size_t i = ply.columns.size(); i > 1; --i) {
            std::swap(ply.columns[i - 1], ply.columns[random() % i]);
        }
        for (const char* name : {"x", "f_rest_3", "rot_1", "opacity"}) {
            ply[name].type = round % 2 == 0 ? "double" : "float64";
        }
        for (const auto& [name, type] : {std::pair("f_rest_0", "short"),
                                         {"f_rest_1", "uint16"},
                                         {"f_rest_2", "int32"},
                                         {"z", "uchar"},
                                         {"scale_0", "int8"},
                                         {"rot_2", "char"},
                                         {"rot_0", "uint"}}) {
            ply[name].type = type;
        }
        ply.columns.insert(ply.columns.begin() + round, {"red", "uchar", {255.0, 0.0, 17.0}});
        ply.add("confidence", "ushort", {1.0, 2.0, 3.0});
        checkSameScene(loadScene(folder.write("shuffled.ply", ply.bytes())), expected);
    }
}

TEST_CASE("elements before and after the splats and line breaks of Windows are passed over") {
    const Folder folder;
    const Scene expected = loadScene(folder.write("plain.ply", makePly().bytes()));
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding);
        ply.line_break = "\r\n";
        checkSameScene(loadScene(folder.write("windows.ply", ply.bytes())), expected);
        ply.line_break = "\n";
        ply.header_before =
            "element camera 2\nproperty float a\nproperty uchar b\n"
            "element strip 2\nproperty list uchar int index\nproperty double w\nelement none 5\n";
        ply.header_after = "element face 1\nproperty list uchar int vertex_indices\n";
        using Row = std::vector<std::pair<const char*, double>>;
        for (const Row& row : {Row{{"float", 1}, {"uchar", 3}}, Row{{"float", 2}, {"uchar", 3}},
                               Row{{"uchar", 3}, {"int", 0}, {"int", 1}, {"int", 2}, {"double", 0.5}},
                               Row{{"uchar", 0}, {"double", 0.5}}}) {
            for (const auto& [type, value] : row) { appendTyped(ply.data_before, type, value, encoding); }
            if (encoding == Encoding::kAscii) { ply.data_before += "\n"; }
        }
        ply.data_after = "whatever follows";
        checkSameScene(loadScene(folder.write("more.ply", ply.bytes())), expected);
    }
}

TEST_CASE_FIXTURE(InFolder, "a PLY that looks as if its activations had been applied is told of") {
    for (const bool three_scales : {false, true}) {
        PlyText ply = makePly(0, three_scales);
        ply["opacity"].values = {0.0, 1.0, 0.5};
        ply["scale_0"].values = {0.01, 0.5, 2.0};
        ply["scale_1"].values = {0.02, 0.5, 1e-6};
        if (three_scales) { ply["scale_2"].values = {0.001, 0.1, 3.0}; }
        ply.resize(700);
        const auto checkLines = [&](const PlyText& text, int lines) {
            const auto [notes, scene] = readScene(folder.write("applied.ply", text.bytes()));
            CHECK(these(scene.size(), countSaying(notes.lines, "activations applied"), scene.opacities[1]) ==
                  these(700, lines, doctest::Approx(1.0 / (1.0 + std::exp(-1.0)))));
        };
        checkLines(ply, 1);
        for (const auto& [name, usual] : {std::pair("opacity", 1.01), {"opacity", -0.01}, {"scale_1", 0.0}}) {
            PlyText other = ply;
            other[name].values[650] = usual;  // one splat in the last block
            checkLines(other, 0);
        }
    }
}

TEST_CASE_FIXTURE(InFolder, "a byte order mark, CloudCompare's names and SH of degree 4 are no hindrance") {
    LoadNotes notes;
    const Scene plain = loadScene(folder.write("plain.ply", makePly(45, true).bytes()));
    checkSameScene(loadScene(folder.write("marked.ply", "\xef\xbb\xbf" + makePly(45, true).bytes())), plain);
    PlyText renamed = makePly(45, true);
    for (Column& column : renamed.columns) { column.name.insert(0, column.name.size() > 2 ? "scalar_" : ""); }
    renamed.add("scalar_x", "float", {7.0, 8.0, 9.0});  // this is not the position
    checkSameScene(loadScene(folder.write("renamed.ply", renamed.bytes()), 0, &notes), plain);
    CHECK(notes.lines.empty());
    // The first 15 of each channel's 24 values.
    PlyText larger = makePly(72, true);
    for (int i = 0; i < 72; ++i) {
        std::vector<double>& values = larger[fmt::format("f_rest_{}", i)].values;
        values = i % 24 < 15 ? makePly(45)[fmt::format("f_rest_{}", i / 24 * 15 + i % 24)].values
                             : std::vector<double>{kNan, 1.0, 2.0};
    }
    checkSameScene(loadScene(folder.write("larger.ply", larger.bytes()), 0, &notes), plain);
    checkSays(notes.lines, "larger.ply: SH of degree 4 were left out, degree 3 is kept");
}

TEST_CASE_FIXTURE(InFolder, "positions of float64 far from 0 keep their detail, read and written") {
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding, 9, true);
        for (const char* name : {"x", "y", "z"}) { ply[name].type = "double"; }
        ply["x"].values = {431250.001, 431250.002, 431249.5};
        ply["y"].values = {-5412000.1, -5412000.1001, -5412001.0};
        ply["z"].values = {210.5, 211.25, 209.0};
        const auto [notes, scene] = readScene(folder.write("far.ply", ply.bytes()));
        CHECK(scene.origin == glm::dvec3(431250.0, -5412000.0, 0.0));
        checkSays(notes.lines, "count from 431250,-5412000,0");
        const Scene again = writtenAndRead(folder, scene);
        CHECK(these(again.origin, again.rotations, again.sh) ==
              these(scene.origin, scene.rotations, scene.sh));
        REQUIRE(again.size() == 3);
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 expected =
                glm::dvec3(ply["x"].values[i], ply["y"].values[i], ply["z"].values[i]) - scene.origin;
            CHECK(glm::distance(glm::dvec3(scene.positions[i]), expected) < 1e-7);
            CHECK(glm::distance(glm::dvec3(again.positions[i]), expected) < 1e-7);
        }
        if (encoding == Encoding::kAscii) {  // a blank line does not count
            std::string text = ply.bytes();
            text.insert(text.find("end_header\n") + 11, "\n");
            CHECK(loadScene(folder.write("blank.ply", text)).positions == scene.positions);
        }
        // A float32 in the file has already lost its detail, so it stays as it is.
        for (const char* name : {"x", "y", "z"}) { ply[name].type = "float"; }
        const Scene near = loadScene(folder.write("float.ply", ply.bytes()));
        CHECK(these(near.origin, near.positions[2]) ==
              these(glm::dvec3(0.0), glm::vec3(431249.5f, -5412001.0f, 209.0f)));
    }
}

TEST_CASE_FIXTURE(InFolder, "of splats that move and fade the still of one moment is shown") {
    const auto load = [&](const PlyText& ply, const std::string& note) {
        const auto [notes, scene] = readScene(folder.write("moving.ply", ply.bytes()));
        checkSays(notes.lines, note);
        return scene;
    };
    const auto with = [](PlyText ply, const std::string& name, double a, double b, double c) {
        ply.add(name, "float", {a, b, c});
        return ply;
    };
    for (const Encoding encoding : kEncodings) {
        PlyText ply = with(makeIn(encoding, 9, true), "trbf_center", 0.25, 0.5, 1.0);  // the median is shown
        ply = with(ply, "trbf_scale", std::log(0.25), 0.0, 0.0);
        ply = with(ply, "motion_0", 2.0, 9.0, 4.0);  // linear along x, quadratic along z, cubic along y
        ply = with(ply, "motion_5", 16.0, 9.0, 0.0);
        ply = with(ply, "motion_7", 0.0, 9.0, 8.0);
        ply = with(ply, "omega_1", 8.0, 9.0, 0.0);
        const Scene scene = load(ply,
                                 "(trbf_center, trbf_scale, motion_0, motion_5, motion_7, omega_1): shown as "
                                 "the still of one moment, 0.5");
        const auto opacity = [](double logit, double seen) {
            return doctest::Approx(seen / (1.0 + std::exp(-logit))).epsilon(1e-5);
        };
        CHECK(scene.positions ==
              std::vector<glm::vec3>{{1.5f, 0.5f, 5.0f}, {2.0f, 0.25f, 5.0f}, {-5.0f, -0.875f, 6.0f}});
        CHECK(these(scene.opacities[0], scene.opacities[1], scene.opacities[2]) ==
              these(opacity(0.0, std::exp(-1.0)), opacity(2.0, 1.0), opacity(-2.0, std::exp(-0.25))));
        const Scene still = loadScene(folder.write("still.ply", makeIn(encoding, 9, true).bytes()));
        CHECK(these(scene.sh, scene.rotations[1]) == these(still.sh, still.rotations[1]));
        CHECK(std::abs(glm::dot(scene.rotations[0], still.rotations[0])) == doctest::Approx(std::sqrt(0.5)));
    }
    const PlyText fading = with(with(makePly(), "t", 0.0, 1.0, 3.0), "scale_t", 0.0, 0.0, std::log(2.0));
    const Scene faded = load(fading, "(t, scale_t): shown as the still of one moment, 1");
    CHECK(faded.opacities[0] == doctest::Approx(0.5 * std::exp(-0.5)));
    CHECK(faded.opacities[2] == doctest::Approx(std::exp(-0.5) / (1.0 + std::exp(2.0))));
    // Without harmonics, Spacetime Gaussians store colours, or their logits.
    const PlyText coloured = with(makePly(), "trbf_center", 0.0, 0.0, 0.0);
    const auto shown = [](const Scene& scene, std::size_t i) {
        return 0.5 + 0.28209479177387814 * double(scene.sh[i]);
    };
    CHECK(shown(load(coloured, "(trbf_center): all"), 1) == doctest::Approx(0.25));
    CHECK(shown(load(with(coloured, "f_dc_3", 0.0, 0.0, 0.0), "; its colours lack what a network"), 4) ==
          doctest::Approx(1.0 / (1.0 + std::exp(-0.5))));
    checkSameScene(load(with(makePly(), "motion_0", 1.0, 2.0, 3.0), "(motion_0): all are shown at once"),
                   loadScene(folder.write("still.ply", makePly().bytes())));
}

TEST_CASE_FIXTURE(InFolder, "a point cloud or a mesh is named, with where a training leaves its splats") {
    for (const Encoding encoding : kEncodings) {
        PlyText ply;
        ply.encoding = encoding;
        const auto add = [&](const std::vector<std::string>& names, const char* type, double second) {
            for (const std::string& name : names) { ply.add(name, type, {0.0, second}); }
        };
        const auto check = [&](const char* part) { checkError(part, folder, ply.bytes()); };
        add({"x", "y", "z"}, "float", 2.0);
        check("broken.ply: a point cloud (2 points), not a splat scene");
        add({"nx", "ny", "nz"}, "float", 1.0);
        add({"red", "green", "blue"}, "uchar", 255.0);
        check("a point cloud (2 points, with colours, with normals)");
        check("point_cloud/iteration_N/point_cloud.ply");
        ply.header_after = "element face 1\nproperty list uchar int vertex_indices\n";
        check("a mesh (2 vertices, with colours, with normals)");
        add({"opacity"}, "float", 1.0);  // a splat scene that lacks everything else
        check("no property f_dc_0");
    }
    PlyText anchors = makePly();
    anchors.add("f_anchor_feat_0", "float", {0.0, 1.0, 2.0});
    checkError("broken.ply: anchors of Scaffold-GS", folder, anchors.bytes());
}

}  // SUITE(ply_of_others)
