// What a PLY file means: values, encodings, orders, types; what is written reads back; and what is said of a broken one.
#include "engine/scene/ply.h"
#include "engine/scene/describe.h"
#include "engine/scene/procedural.h"
#include "tests/engine/scene/scene_measures.h"
#include "tests/suite.h"

SUITE(ply) {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(), kInfinity = std::numeric_limits<double>::infinity();

PlyText makeIn(Encoding encoding, int rest_count = 0, bool three_scales = false) {
    PlyText ply = makePly(rest_count, three_scales);
    ply.encoding = encoding;
    return ply;
}

void setAll(PlyText& ply, const std::string& name, double value) { std::ranges::fill(ply[name].values, value); }

Scene writtenAndRead(const Folder& folder, const Scene& scene) {
    writePly(scene, folder.file("again.ply"));
    return loadScene(folder.file("again.ply"));
}

TEST_CASE("a PLY's numbers arrive activated, in every encoding") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("known.ply", makeIn(encoding).bytes()), 0, &notes);
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
    for (const double length : {1e-30, 1e30}) {
        PlyText ply = makePly();
        for (const char* name : {"rot_0", "rot_1", "rot_2", "rot_3"}) { ply[name].values[0] = length; }
        CHECK(loadScene(folder.write("length.ply", ply.bytes())).rotations[0] == glm::quat(0.5f, 0.5f, 0.5f, 0.5f));
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
    for (int i = 0; i < 45; ++i) { setAll(ply, fmt::format("f_rest_{}", i), 0.0); }
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

TEST_CASE("blocks that are read ahead on a thread of their own come all and in order, and what goes wrong in one is said") {
    const Folder folder;
    LoadNotes notes;
    // Around one block, one batch of eight, and the two from which on there is a thread.
    for (const std::size_t splats : {1u, 255u, 256u, 257u, 2048u, 2049u, 4096u, 4097u, 6145u, 20'000u}) {
        for (const std::size_t without_sh : {splats / 5, splats - 1, splats}) {
            CAPTURE(splats);
            CAPTURE(without_sh);
            Scene scene = randomScene(3, splats, false);
            for (std::size_t i = 0; i < 48 * without_sh; ++i) { scene.sh[i] = i % 48 < 3 ? scene.sh[i] : 0.0f; }
            if (without_sh == splats) { limitShDegree(scene, 0, notes); }
            const Scene loaded = writtenAndRead(folder, scene);
            REQUIRE(loaded.sh_degree == scene.sh_degree);
            CHECK(loaded.positions == scene.positions);
            CHECK(loaded.sh == scene.sh);
        }
    }
    const std::string row = "0 0 1 0 0 0 0 0 0 0 0 0 1 0 0 0\n", middle = "element vertex 20000\n";
    std::string rows;
    for (int i = 0; i < 20'000; ++i) { rows += row; }
    PlyText ply = makeIn(Encoding::kAscii);
    for (Column& column : ply.columns) { column.values.clear(); }
    const std::string header = replaced(ply.bytes(), "element vertex 0\n", middle);
    for (const std::size_t broken : {0u, 255u, 256u, 2048u, 9000u, 19'999u}) {
        rows[broken * row.size()] = 'x';
        CHECK(contains(loadError(folder, header + rows), fmt::format("splat {} of 20000: property x is 'x'", broken)));
        rows[broken * row.size()] = '0';
    }
    // Whoever stops taking waits for nothing.
    (void)folder.write("whole.ply", header + rows);
    checkProgress(2, [&](const Progress& progress) { (void)loadScene(folder.file("whole.ply"), 0, nullptr, progress); });
}

TEST_CASE("properties come in any order, of any type, among others") {
    const Folder folder;
    const Scene expected = loadScene(folder.write("plain.ply", makePly(9).bytes()));
    std::uint32_t state = 1;
    for (int round = 0; round < 12; ++round) {
        PlyText ply = makeIn(kEncodings[round % 3], 9);
        for (std::size_t i = ply.columns.size(); i > 1; --i) {
            state = state * 1664525u + 1013904223u;
            std::swap(ply.columns[i - 1], ply.columns[state % i]);
        }
        for (const char* name : {"x", "f_rest_3", "rot_1", "opacity"}) { ply[name].type = round % 2 == 0 ? "double" : "float64"; }
        for (const auto& [name, type] :
             {std::pair("f_rest_0", "short"), std::pair("f_rest_1", "uint16"), std::pair("f_rest_2", "int32"), std::pair("z", "uchar"),
              std::pair("scale_0", "int8"), std::pair("rot_2", "char"), std::pair("rot_0", "uint")}) {
            ply[name].type = type;
        }
        ply.columns.insert(ply.columns.begin() + round, {"red", "uchar", {255.0, 0.0, 17.0}});
        ply.columns.push_back({"confidence", "ushort", {1.0, 2.0, 3.0}});
        checkSameScene(loadScene(folder.write("shuffled.ply", ply.bytes())), expected);
    }
}

TEST_CASE("other elements are passed over, with and without lists, before and after the splats, as are line breaks of Windows") {
    const Folder folder;
    const Scene expected = loadScene(folder.write("plain.ply", makePly().bytes()));
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding);
        ply.line_break = "\r\n";
        checkSameScene(loadScene(folder.write("windows.ply", ply.bytes())), expected);
        ply.line_break = "\n";
        ply.header_before =
            "element camera 2\nproperty float a\nproperty uchar b\nelement strip 2\nproperty list uchar int index\nproperty double "
            "w\nelement none 5\n";
        ply.header_after = "element face 1\nproperty list uchar int vertex_indices\n";
        const std::string line_end = encoding == Encoding::kAscii ? "\n" : "";
        for (const double row : {1.0, 2.0}) {
            appendTyped(ply.data_before, "float", row, encoding);
            appendTyped(ply.data_before, "uchar", 3.0, encoding);
            ply.data_before += line_end;
        }
        for (const int count : {3, 0}) {
            appendTyped(ply.data_before, "uchar", count, encoding);
            for (int i = 0; i < count; ++i) { appendTyped(ply.data_before, "int", i, encoding); }
            appendTyped(ply.data_before, "double", 0.5, encoding);
            ply.data_before += line_end;
        }
        ply.data_after = "whatever follows";
        checkSameScene(loadScene(folder.write("more.ply", ply.bytes())), expected);
    }
}

TEST_CASE("of three scales the shortest becomes the last, the frame stays right-handed, and flattening drops it") {
    const Folder folder;
    for (std::size_t shortest = 0; shortest < 3; ++shortest) {
        PlyText ply = makePly(0, true);
        const double logs[] = {-1.0, -2.0, -0.5}, rotation[] = {0.3, -0.5, 0.7, 0.2};
        for (std::size_t axis = 0; axis < 3; ++axis) { setAll(ply, fmt::format("scale_{}", axis), axis == shortest ? -7.0 : logs[axis]); }
        for (std::size_t i = 0; i < 4; ++i) { setAll(ply, fmt::format("rot_{}", i), rotation[i]); }
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
        checkSameScene(writtenAndRead(folder, scene), scene);
        CHECK(notes.lines.empty());
        flatten(scene, notes);
        CHECK_FALSE(scene.isGaussian3d());
        REQUIRE(notes.lines.size() == 1);
        CHECK(contains(notes.lines[0], "shortest axis"));
    }
}

TEST_CASE("splats with NaN, infinity, overflow or no rotation are skipped and counted") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        for (const std::string name : {"x", "z", "f_dc_1", "f_rest_8", "opacity", "scale_1", "rot_3"}) {
            for (const double bad : {kNan, kInfinity, -kInfinity}) {
                if (name == "opacity" && bad == kInfinity) { continue; }  // is opacity 1
                PlyText ply = makeIn(encoding, 9);
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
    ply["nx"].values[1] = kNan;  // of no interest
    LoadNotes notes;
    CHECK(loadScene(folder.write("bad.ply", ply.bytes()), 0, &notes).size() == 1);
    CHECK(notes.skipped_not_finite == 1);
    CHECK(notes.skipped_zero_rotation == 1);
    CHECK(notes.lines.size() == 2);
}

TEST_CASE("a logit of infinity is opacity 1; the shortest of three axes may have no extent, any other may not") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        for (const bool three_scales : {false, true}) {
            PlyText ply = makeIn(encoding, 9, three_scales);
            ply["opacity"].values[1] = kInfinity;
            LoadNotes notes;
            const Scene scene = loadScene(folder.write("opaque.ply", ply.bytes()), 0, &notes);
            REQUIRE(scene.size() == 3);
            CHECK(scene.opacities[1] == 1.0f);
            CHECK(notes.lines.empty());
        }
        for (int axis = 0; axis < 3; ++axis) {
            CAPTURE(axis);
            PlyText ply = makeIn(encoding, 0, true);
            ply[fmt::format("scale_{}", axis)].values[0] = -kInfinity;
            LoadNotes notes;
            const Scene disc = loadScene(folder.write("disc.ply", ply.bytes()), 0, &notes);
            REQUIRE(disc.size() == 3);
            CHECK(disc.thicknesses[0] == 0.0f);
            const double kept = axis == 0 ? -3.0 : axis == 1 ? -5.0 : 0.0;  // the one that follows in cyclic order
            CHECK(disc.scales[0].x == doctest::Approx(std::exp(kept)));
            CHECK(notes.lines.empty());
            CHECK(writtenAndRead(folder, disc).thicknesses[0] == 0.0f);

            ply[fmt::format("scale_{}", (axis + 1) % 3)].values[0] = -kInfinity;  // a needle without width
            CHECK(loadScene(folder.write("needle.ply", ply.bytes()), 0, &notes).size() == 2);
            CHECK(notes.skipped_not_finite == 1);
        }
        PlyText flat = makeIn(encoding);
        flat["scale_1"].values[0] = -kInfinity;
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
    for (const auto& [comments, asks] : {std::pair("comment SplatRenderMode: mip\n", true),
                                         {"comment  splatrendermode:  MIP \r\n", true},
                                         {"comment antialiased 1\n", true},
                                         {"comment postshot.anti_aliasing=1\n", true},
                                         {"comment SplatRenderMode: default\ncomment antialiased 1\n", true},
                                         {"comment made for a test\n", false},
                                         {"comment SplatRenderMode: default\n", false},
                                         {"comment SplatRenderMode:\n", false},
                                         {"comment SplatRenderMode: mip or not\n", false},
                                         {"comment antialiased 0\n", false},
                                         {"comment antialiased 1\ncomment SplatRenderMode: default\n", false},
                                         {"obj_info SplatRenderMode: mip\n", false}}) {
        CAPTURE(comments);
        const Scene scene = loadWith(comments);
        CHECK(scene.antialiased == asks);
        CHECK(writtenAndRead(folder, scene).antialiased == asks);
    }
    CHECK_FALSE(loadWith("comment SplatRenderMode: mip\n", false).antialiased);  // discs are not dimmed
}

TEST_CASE("a comment names the vertical axis, and writing keeps it") {
    const Folder folder;
    for (const auto& [comment, axis] : {std::pair("comment Vertical axis: z\n", 2),
                                        {"comment vertical AXIS:  X\n", 0},
                                        {"comment Vertical axis: y\n", -1},
                                        {"comment Vertical axis: w\n", -1},
                                        {"comment Vertical axis:\n", -1},
                                        {"comment the Vertical axis: z\n", -1}}) {
        CAPTURE(comment);
        LoadNotes notes;
        const Scene scene =
            loadScene(folder.write("said.ply", replaced(makePly(0).bytes(), "comment made for a test\n", comment)), 0, &notes);
        CHECK(scene.vertical_axis == axis);
        CHECK(writtenAndRead(folder, scene).vertical_axis == axis);
        CHECK(notes.axes == (axis < 0 ? "" : fmt::format("{} is vertical (named by the file)", "xyz"[axis])));
    }
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
            const double before = std::exchange(ply[name].values[650], usual);  // one splat in the last block
            CHECK(linesOf() == 0);
            ply[name].values[650] = before;
        }
    }
}

TEST_CASE("a byte order mark, CloudCompare's names and harmonics of degree 4 are passed over") {
    const Folder folder;
    LoadNotes notes;
    const Scene plain = loadScene(folder.write("plain.ply", makePly(45, true).bytes()));
    checkSameScene(loadScene(folder.write("marked.ply", "\xef\xbb\xbf" + makePly(45, true).bytes())), plain);
    PlyText renamed = makePly(45, true);
    for (Column& column : renamed.columns) { column.name.insert(0, column.name.size() > 2 ? "scalar_" : ""); }
    renamed.columns.push_back({"scalar_x", "float", {7.0, 8.0, 9.0}});  // not the position
    checkSameScene(loadScene(folder.write("renamed.ply", renamed.bytes()), 0, &notes), plain);
    CHECK(notes.lines.empty());
    // Of each channel's 24 values the first 15.
    PlyText larger = makePly(72, true);
    for (int i = 0; i < 72; ++i) {
        std::vector<double>& values = larger[fmt::format("f_rest_{}", i)].values;
        values = i % 24 < 15 ? makePly(45)[fmt::format("f_rest_{}", i / 24 * 15 + i % 24)].values : std::vector<double>{kNan, 1.0, 2.0};
    }
    checkSameScene(loadScene(folder.write("larger.ply", larger.bytes()), 0, &notes), plain);
    REQUIRE(notes.lines.size() == 1);
    CHECK(contains(notes.lines[0], "larger.ply: SH of degree 4 were left out, degree 3 is kept"));
}

TEST_CASE("positions of float64 far from 0 keep their detail, and are written back to where they were") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding, 9, true);
        for (const char* name : {"x", "y", "z"}) { ply[name].type = "double"; }
        ply["x"].values = {431250.001, 431250.002, 431249.5};
        ply["y"].values = {-5412000.1, -5412000.1001, -5412001.0};
        ply["z"].values = {210.5, 211.25, 209.0};
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("far.ply", ply.bytes()), 0, &notes);
        CHECK(scene.origin == glm::dvec3(431250.0, -5412000.0, 0.0));
        REQUIRE(notes.lines.size() == 1);
        CHECK(contains(notes.lines[0], "count from 431250,-5412000,0"));
        writePly(scene, folder.file("again.ply"));
        const Scene again = loadScene(folder.file("again.ply"));
        CHECK(again.origin == scene.origin);
        CHECK(again.rotations == scene.rotations);
        CHECK(again.sh == scene.sh);
        REQUIRE(again.size() == 3);
        for (std::size_t i = 0; i < 3; ++i) {
            const glm::dvec3 expected = glm::dvec3(ply["x"].values[i], ply["y"].values[i], ply["z"].values[i]) - scene.origin;
            CHECK(glm::distance(glm::dvec3(scene.positions[i]), expected) < 1e-7);
            CHECK(glm::distance(glm::dvec3(again.positions[i]), expected) < 1e-7);
        }
        // What is float32 in the file has lost its detail already, and stays where it is.
        for (const char* name : {"x", "y", "z"}) { ply[name].type = "float"; }
        const Scene near = loadScene(folder.write("float.ply", ply.bytes()));
        CHECK(near.origin == glm::dvec3(0.0));
        CHECK(near.positions[2] == glm::vec3(431249.5f, -5412001.0f, 209.0f));
    }
}

TEST_CASE("of splats that move and fade the still of one moment is shown, and a note says which") {
    const Folder folder;
    const auto load = [&](const PlyText& ply, const std::string& note) {
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("moving.ply", ply.bytes()), 0, &notes);
        REQUIRE(notes.lines.size() == 1);
        CHECK(contains(notes.lines[0], note));
        return scene;
    };
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding, 9, true);
        const auto add = [&](const std::string& name, double a, double b, double c) { ply.columns.push_back({name, "float", {a, b, c}}); };
        add("trbf_center", 0.25, 0.5, 1.0);  // shown at the median
        add("trbf_scale", std::log(0.25), 0.0, 0.0);
        add("motion_0", 2.0, 9.0, 4.0);  // the speed along x, the square along z, the cube along y
        add("motion_5", 16.0, 9.0, 0.0);
        add("motion_7", 0.0, 9.0, 8.0);
        add("omega_1", 8.0, 9.0, 0.0);
        const Scene scene =
            load(ply, "(trbf_center, trbf_scale, motion_0, motion_5, motion_7, omega_1): shown as the still of one moment, 0.5");
        const auto opacity = [](double logit, double seen) { return doctest::Approx(seen / (1.0 + std::exp(-logit))).epsilon(1e-5); };
        CHECK(scene.positions == std::vector<glm::vec3>{{1.5f, 0.5f, 5.0f}, {2.0f, 0.25f, 5.0f}, {-5.0f, -0.875f, 6.0f}});
        CHECK(scene.opacities[0] == opacity(0.0, std::exp(-1.0)));
        CHECK(scene.opacities[1] == opacity(2.0, 1.0));
        CHECK(scene.opacities[2] == opacity(-2.0, std::exp(-0.25)));
        CHECK(scene.sh == loadScene(folder.write("still.ply", makeIn(encoding, 9, true).bytes())).sh);
        CHECK(scene.rotations[1] == loadScene(folder.file("still.ply")).rotations[1]);
        CHECK(std::abs(glm::dot(scene.rotations[0], loadScene(folder.file("still.ply")).rotations[0])) == doctest::Approx(std::sqrt(0.5)));
    }
    PlyText fading = makePly();
    fading.columns.push_back({"t", "float", {0.0, 1.0, 3.0}});
    fading.columns.push_back({"scale_t", "float", {0.0, 0.0, std::log(2.0)}});
    const Scene faded = load(fading, "(t, scale_t): shown as the still of one moment, 1");
    CHECK(faded.opacities[0] == doctest::Approx(0.5 * std::exp(-0.5)));
    CHECK(faded.opacities[2] == doctest::Approx(std::exp(-0.5) / (1.0 + std::exp(2.0))));
    // Without harmonics Spacetime Gaussians store colours, or their logits.
    PlyText coloured = makePly();
    coloured.columns.push_back({"trbf_center", "float", {0.0, 0.0, 0.0}});
    const auto shown = [](const Scene& scene, std::size_t i) { return 0.5 + 0.28209479177387814 * double(scene.sh[i]); };
    CHECK(shown(load(coloured, "(trbf_center): all"), 1) == doctest::Approx(0.25));
    coloured.columns.push_back({"f_dc_3", "float", {0.0, 0.0, 0.0}});
    CHECK(shown(load(coloured, "; its colours lack what a network"), 4) == doctest::Approx(1.0 / (1.0 + std::exp(-0.5))));
    PlyText unknown = makePly();
    unknown.columns.push_back({"motion_0", "float", {1.0, 2.0, 3.0}});
    checkSameScene(load(unknown, "(motion_0): all are shown at once"), loadScene(folder.write("still.ply", makePly().bytes())));
}

TEST_CASE("an empty scene is a scene") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding, 9, true);
        for (Column& column : ply.columns) { column.values.clear(); }
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("empty.ply", ply.bytes()), 0, &notes);
        CHECK(scene.size() == 0);
        CHECK(notes.median_flatness == 0.0);
        CHECK(describeScene(scene, &notes).splats == 0);
        CHECK(writtenAndRead(folder, scene).size() == 0);
    }
}

TEST_CASE("what is written reads back the same, opacity 0 and 1 and scale 0 exactly") {
    const Folder folder;
    for (const int rest_count : {0, 9, 24, 45}) {
        Scene scene = loadScene(folder.write("in.ply", makePly(rest_count).bytes()));
        scene.opacities = {0.0f, 1.0f, 0.999999f};
        scene.scales = {{0.0f, 1e-6f}, {1.0f, 2.0f}, {3.0f, 1e6f}};
        const Scene again = writtenAndRead(folder, scene);
        CHECK(again.positions == scene.positions);
        CHECK(again.sh == scene.sh);
        CHECK(again.opacities[0] == 0.0f);
        CHECK(again.opacities[1] == 1.0f);
        CHECK(again.opacities[2] == doctest::Approx(0.999999).epsilon(1e-6));
        CHECK(again.scales[0].x == 0.0f);
        CHECK(again.scales[0].y == doctest::Approx(1e-6).epsilon(1e-5));
        for (std::size_t i = 0; i < scene.size(); ++i) {
            CHECK(glm::length(again.rotations[i] - scene.rotations[i]) < 1e-6f);
            if (i > 0) { CHECK(glm::length(again.scales[i] / scene.scales[i] - 1.0f) < 1e-6f); }
        }
        scene.opacities.assign(3, 1e-6f);
        CHECK(writtenAndRead(folder, scene).opacities[0] == doctest::Approx(1e-6).epsilon(1e-5));
    }
}

TEST_CASE("loading and writing report progress from 0 to 1, and writing leaves nothing half-written") {
    const Folder folder;
    const Scene scene = makeBuiltin("builtin:one-splat"), large = randomScene(0, 100'000);
    const auto errorTo = [&](const std::string& path) { return errorOf([&] { writePly(scene, path); }); };
    CHECK(contains(errorTo(folder.file("absent/scene.ply")), "cannot be written"));
    CHECK(contains(errorTo(folder.file(".")), "is a directory"));
#ifndef _WIN32
    std::filesystem::create_symlink("/dev/null", folder.file("device.ply"));
    CHECK(contains(errorTo(folder.file("device.ply")), "not a regular file"));
    std::filesystem::remove(folder.file("device.ply"));
#endif
    // An old file stays as it was if the new one does not come to its end.
    checkProgress(4, [&](const Progress& progress) {
        writePly(scene, folder.file("kept.ply"));
        writePly(large, folder.file("kept.ply"), progress);
    });
    CHECK(loadScene(folder.file("kept.ply")).size() == 1);
    CHECK(folder.fileCount() == 1);
    writePly(large, folder.file("kept.ply"));
    checkProgress(4, [&](const Progress& progress) { (void)loadScene(folder.file("kept.ply"), 0, nullptr, progress); });
}

TEST_CASE("errors of the source itself say what it is") {
    const Folder folder;
    CHECK(contains(loadError(folder.file("absent.ply")), "absent.ply: no such file"));
    CHECK(contains(loadError(folder.write("zero.ply", "")), "is empty"));
#ifndef _WIN32
    CHECK(contains(loadError("/dev/null"), "not a regular file"));
    CHECK(contains(loadError(std::string(5000, 'x')), "cannot be read"));
#endif
    CHECK(contains(loadError(folder.write("picture.ply", "P6 not a scene")), "not a scene file"));
    CHECK(loadScene(folder.write("named_otherwise.txt", makePly().bytes())).size() == 3);

    const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:" + std::string(64, 'a') + "\nsize 12345\n";
    for (const char* name : {"scene.ply", "scene.splat", "scene.spz", "scene.sog", "meta.json", "lod-meta.json"}) {
        CHECK(contains(loadError(folder.write(name, pointer)), std::string(name) + ": is a Git LFS pointer"));
    }
    CHECK(contains(loadError(folder.write("short", pointer.substr(0, 30))), "not a scene file"));
    CHECK(contains(loadError(folder.write("long", pointer + std::string(2000, 'x'))), "not a scene file"));
}

TEST_CASE("a point cloud or a mesh is named as what it is, with the place where a training leaves its splats") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply;
        ply.encoding = encoding;
        for (const char* name : {"x", "y", "z"}) { ply.columns.push_back({name, "float", {1.0, 2.0}}); }
        const auto error = [&] { return loadError(folder.write("points3D.ply", ply.bytes())); };
        CHECK(contains(error(), "points3D.ply: a point cloud (2 points), not a splat scene"));
        for (const char* name : {"nx", "ny", "nz"}) { ply.columns.push_back({name, "float", {0.0, 1.0}}); }
        for (const char* name : {"red", "green", "blue"}) { ply.columns.push_back({name, "uchar", {0.0, 255.0}}); }
        CHECK(contains(error(), "a point cloud (2 points, with colours, with normals)"));
        CHECK(contains(error(), "point_cloud/iteration_N/point_cloud.ply"));
        ply.header_after = "element face 1\nproperty list uchar int vertex_indices\n";
        CHECK(contains(error(), "a mesh (2 vertices, with colours, with normals)"));
        ply.columns.push_back({"opacity", "float", {0.0, 1.0}});  // a splat scene that lacks the rest
        CHECK(contains(error(), "no property f_dc_0"));
    }
    PlyText anchors = makePly();
    anchors.columns.push_back({"f_anchor_feat_0", "float", {0.0, 1.0, 2.0}});
    CHECK(contains(loadError(folder, anchors.bytes()), "broken.ply: anchors of Scaffold-GS"));
}

TEST_CASE("errors in a header name the file, the line and what was expected") {
    const Folder folder;
    const std::string good = makePly(9).bytes(), magic = "format binary_little_endian 1.0\n";
    const std::vector<Fault> faults{{"end_header\n", "comment x\n", "end_header"},
                                    {"property float x", "property half x", " line 5: unknown type 'half'"},
                                    {"property float x", "property float", "expected 'property TYPE NAME'"},
                                    {"property float x", "property list float int x", "counted by 'float'"},
                                    {"property float nx", "property list uchar int nx", "nx of element vertex is a list"},
                                    {"property float nx", "property float x", "property x of element vertex twice"},
                                    {"property float opacity", "property float opaque", "no property opacity"},
                                    {"property float scale_1", "property float scale", "no property scale_1"},
                                    {"property float f_rest_8", "property float other", "8 f_rest properties, expected 0, 9, 24, 45 or 72"},
                                    {"property float f_rest_8", "property float f_rest_9", "no f_rest_8"},
                                    {"element vertex 3", "element vertex -3", "count of element vertex is '-3'"},
                                    {"element vertex 3", "element vertex many", "count of element vertex is 'many'"},
                                    {"element vertex 3", "element vertex 99999999999999999999999", "count of element vertex"},
                                    {"element vertex 3", "element vertex", "expected 'element NAME COUNT'"},
                                    {"element vertex 3", "element points 3", "no element vertex"},
                                    {"element vertex 3", "element vertex 0\nelement vertex 3", "element vertex twice"},
                                    {"element vertex 3", "vertices 3", "unknown keyword 'vertices'"},
                                    {"comment made for a test", "property float x", "a property before any element"},
                                    {"binary_little_endian", "binary_middle_endian", "unknown encoding"},
                                    {"1.0", "2.0", "version is '2.0'"},
                                    {magic, "", "no format line"},
                                    {"comment made for a test", "format ascii 1.0", "second format line"}};
    checkFaults(faults, [&](const Fault& fault) {
        const std::string message = loadError(folder, replaced(good, fault.from, fault.to));
        CHECK(contains(message, "broken.ply: header"));
        return message;
    });
}

TEST_CASE("absurd counts are refused before anything is allocated") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding);
        for (const char* count : {"4", "1000000000", "18446744073709551615"}) {
            const std::string message =
                loadError(folder, replaced(ply.bytes(), "element vertex 3", fmt::format("element vertex {}", count)));
            CHECK(contains(message, "broken.ply: data: ends"));
            CHECK(contains(message, fmt::format("of {}", count)));
        }
        ply.header_before = "element list 18446744073709551615\nproperty list uint int values\n";
        CHECK_FALSE(loadError(folder, ply.bytes()).empty());
        ply.header_before = "element pair 18446744073709551615\nproperty double a\nproperty double b\n";
        CHECK_FALSE(loadError(folder, ply.bytes()).empty());
    }
}

TEST_CASE("ascii values that are no numbers are named, with their splat, and a file that ends in a splat says in which") {
    const Folder folder;
    const std::string good = makeIn(Encoding::kAscii).bytes(), binary = makePly().bytes();
    CHECK(contains(loadError(folder, replaced(good, "\n2 0.25", "\n2 zwei")), "splat 1 of 3: property y is 'zwei'"));
    CHECK(contains(loadError(folder, replaced(good, "\n2 0.25", "\n2")), "splat 1 of 3: property rot_3 is ''"));
    CHECK(contains(loadError(folder, replaced(good, "\n2 0.25", "\n2 0.25 1")), "splat 1 of 3: more than the expected 16 values"));
    CHECK(loadError(folder, replaced(good, "\n2 0.25", "\n\n+2 \t 2.5e-1")).empty());
    CHECK(contains(loadError(folder, binary.substr(0, binary.size() - 1)), "ends in splat 2 of 3"));
}

}  // SUITE(ply)
