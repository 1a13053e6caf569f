// What a PLY file means: values, encodings, orders, types; that written files read back; and what is reported
// about broken ones.
#include "engine/files/ply.h"
#include "app/summary/describe.h"
#include "engine/builtin/procedural.h"
#include "engine/scene/pick_splats.h"
#include "tests/engine/scene/scene_measures.h"

SUITE(ply) {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN(),
                 kInfinity = std::numeric_limits<double>::infinity();

void setAll(PlyText& ply, const std::string& name, double value) {
    std::ranges::fill(ply[name].values, value);
}

TEST_CASE_FIXTURE(InFolder, "a PLY's numbers arrive activated, in every encoding") {
    for (const Encoding encoding : kEncodings) {
        const auto [notes, scene] = readScene(folder.write("known.ply", makeIn(encoding).bytes()));
        REQUIRE(scene.size() == 3);
        CHECK(these(scene.sh_degree, scene.positions[2], scene.sh, scene.opacities[0]) ==
              these(0, glm::vec3(-3.0f, 0.125f, 6.0f),
                    std::vector<float>{0.0f, 0.25f, 0.5f, 0.0f, 0.5f, 1.0f, 0.0f, -0.5f, -1.0f}, 0.5f));
        CHECK(these(scene.opacities[1], scene.scales[0].x, scene.scales[0].y) ==
              these(doctest::Approx(1.0 / (1.0 + std::exp(-2.0))).epsilon(1e-6), 1.0f,
                    doctest::Approx(std::exp(-3.0)).epsilon(1e-6)));
        CHECK(these(scene.rotations[0], scene.rotations[1], scene.rotations[2]) ==
              these(glm::quat(1.0f, 0.0f, 0.0f, 0.0f), glm::quat(0.5f, 0.5f, 0.5f, 0.5f),
                    glm::quat(0.0f, 0.0f, -1.0f, 0.0f)));
        CHECK(these(notes.splats_in_file, notes.three_scales, notes.lines.empty()) == these(3, false, true));
    }
    for (const double length : {1e-30, 1e30}) {
        PlyText ply = makePly();
        for (const char* name : {"rot_0", "rot_1", "rot_2", "rot_3"}) { ply[name].values[0] = length; }
        CHECK(loadScene(folder.write("length.ply", ply.bytes())).rotations[0] ==
              glm::quat(0.5f, 0.5f, 0.5f, 0.5f));
    }
}

TEST_CASE_FIXTURE(InFolder, "SH bands that are all zero are left out, even if a band below is used late") {
    PlyText ply = makePly(45);
    for (int i = 0; i < 45; ++i) { setAll(ply, fmt::format("f_rest_{}", i), 0.0); }
    LoadNotes notes;
    CHECK(loadScene(folder.write("flat.ply", ply.bytes()), 0, &notes).sh_degree == 0);
    CHECK(notes.sh_degree_in_file == 3);
    checkSays(notes.lines, "SH bands above degree 0");

    // 700 splats make three blocks. Only the last splat has a coefficient of band 2, so rows that were stored
    // before must be widened.
    for (Column& column : ply.columns) { column.values.resize(700, column.values[0]); }
    ply["f_rest_0"].values[3] = 7.0;     // channel 0, k = 1
    ply["f_rest_21"].values[699] = 9.0;  // channel 1, k = 7
    const Scene scene = loadScene(folder.write("late.ply", ply.bytes()));
    REQUIRE(scene.sh_degree == 2);
    REQUIRE(scene.sh.size() == 700 * 27);
    CHECK(these(scene.sh[3 * 27 + 3 * 1 + 0], scene.sh[699 * 27 + 3 * 7 + 1]) == these(7.0f, 9.0f));
    // f_dc_1 and f_dc_2 are not zero
    CHECK(std::count(scene.sh.begin(), scene.sh.end(), 0.0f) == 700 * 25 - 2 + 0);
}

TEST_CASE_FIXTURE(
    InFolder,
    "blocks that are read ahead on a thread of their own come all and in order, and what goes wrong in one "
    "is said") {
    LoadNotes notes;
    // Around one block, one batch of eight, and two batches, from which on a thread is used.
    for (const std::size_t splats : {1u, 255u, 256u, 257u, 2048u, 2049u, 4096u, 4097u, 6145u, 20'000u}) {
        for (const std::size_t without_sh : {splats / 5, splats - 1, splats}) {
            INFO("splats ", splats, ", without_sh ", without_sh);
            Scene scene = randomScene(3, splats, false);
            for (std::size_t i = 0; i < 48 * without_sh; ++i) {
                scene.sh[i] = i % 48 < 3 ? scene.sh[i] : 0.0f;
            }
            if (without_sh == splats) { limitShDegree(scene, 0, notes); }
            const Scene loaded = writtenAndRead(folder, scene);
            REQUIRE(loaded.sh_degree == scene.sh_degree);
            CHECK(these(loaded.positions, loaded.sh) == these(scene.positions, scene.sh));
        }
    }
    PlyText ply = makeIn(Encoding::kAscii);
    for (Column& column : ply.columns) { column.values.assign(20'000, 1.0); }
    const std::string whole = ply.bytes();
    const std::size_t rows = whole.find("end_header\n") + 11, row = (whole.size() - rows) / 20'000;
    for (const std::size_t broken : {0u, 255u, 256u, 2048u, 9000u, 19'999u}) {
        std::string text = whole;
        text[rows + broken * row] = 'x';
        CHECK(contains(loadError(folder, text), fmt::format("splat {} of 20000: property x is 'x'", broken)));
    }
    // A reader that stops taking blocks waits for nothing.
    (void)folder.write("whole.ply", whole);
    checkProgress(2, [&](const Progress& progress) {
        (void)loadScene(folder.file("whole.ply"), 0, nullptr, progress);
    });
}

TEST_CASE_FIXTURE(
    InFolder,
    "of three scales the shortest becomes the last, the frame stays right-handed, and flattening drops it") {
    for (std::size_t shortest = 0; shortest < 3; ++shortest) {
        PlyText ply = makePly(0, true);
        const double logs[] = {-1.0, -2.0, -0.5}, rotation[] = {0.3, -0.5, 0.7, 0.2};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            setAll(ply, fmt::format("scale_{}", axis), axis == shortest ? -7.0 : logs[axis]);
        }
        for (std::size_t i = 0; i < 4; ++i) { setAll(ply, fmt::format("rot_{}", i), rotation[i]); }
        LoadNotes notes;
        Scene scene = loadScene(folder.write("three.ply", ply.bytes()), 0, &notes);
        const glm::mat3 trained = glm::mat3_cast(glm::normalize(glm::quat(0.3f, -0.5f, 0.7f, 0.2f)));
        const glm::mat3 kept = glm::mat3_cast(scene.rotations[0]);
        const int u = static_cast<int>((shortest + 1) % 3), v = static_cast<int>((shortest + 2) % 3);
        CHECK(glm::length(kept[0] - trained[u]) < 1e-6f);
        CHECK(glm::length(kept[1] - trained[v]) < 1e-6f);
        // The normal lies along the shortest axis.
        CHECK(glm::length(kept[2] - trained[static_cast<int>(shortest)]) < 1e-6f);
        CHECK(glm::determinant(kept) == doctest::Approx(1.0));
        CHECK(these(scene.scales[0].x, scene.scales[0].y) ==
              these(doctest::Approx(std::exp(logs[u])), doctest::Approx(std::exp(logs[v]))));
        CHECK(notes.three_scales);
        CHECK(notes.median_flatness == doctest::Approx(std::exp(-7.0 - std::min(logs[u], logs[v]))));
        REQUIRE(scene.isGaussian3d());
        CHECK(scene.thicknesses[0] == doctest::Approx(std::exp(-7.0)));
        checkSameScene(writtenAndRead(folder, scene), scene);
        CHECK(notes.lines.empty());
        flatten(scene, notes);
        CHECK_FALSE(scene.isGaussian3d());
        checkSays(notes.lines, "shortest axis");
    }
}

TEST_CASE_FIXTURE(InFolder, "splats with NaN, infinity, overflow or no rotation are skipped and counted") {
    for (const Encoding encoding : kEncodings) {
        for (const std::string name : {"x", "z", "f_dc_1", "f_rest_8", "opacity", "scale_1", "rot_3"}) {
            for (const double bad : {kNan, kInfinity, -kInfinity}) {
                if (name == "opacity" && bad == kInfinity) { continue; }  // this means opacity 1
                PlyText ply = makeIn(encoding, 9);
                ply[name].values[1] = bad;
                const auto [notes, scene] = readScene(folder.write("nan.ply", ply.bytes()));
                REQUIRE(scene.size() == 2);
                CHECK(these(scene.positions[1].x, scene.sh.size()) == these(-3.0f, 2 * 12));
                CHECK(these(notes.skipped_not_finite, notes.skipped_zero_rotation) == these(1, 0));
                checkSays(notes.lines, "1 of 3 splats skipped");
            }
        }
    }
    PlyText ply = makePly(9);
    ply["scale_0"].values[0] = 89.0;  // exp(89) exceeds float32
    ply["rot_2"].values[2] = 0.0;
    ply["nx"].values[1] = kNan;  // normals are not read
    LoadNotes notes;
    CHECK(loadScene(folder.write("bad.ply", ply.bytes()), 0, &notes).size() == 1);
    CHECK(these(notes.skipped_not_finite, notes.skipped_zero_rotation, notes.lines.size()) == these(1, 1, 2));
}

TEST_CASE_FIXTURE(
    InFolder,
    "a logit of infinity is opacity 1; the shortest of three axes may have no extent, any other may not") {
    for (const Encoding encoding : kEncodings) {
        for (const bool three_scales : {false, true}) {
            PlyText ply = makeIn(encoding, 9, three_scales);
            ply["opacity"].values[1] = kInfinity;
            const auto [notes, scene] = readScene(folder.write("opaque.ply", ply.bytes()));
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
            const double kept = axis == 0 ? -3.0 : axis == 1 ? -5.0 : 0.0;  // the next axis in cyclic order
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

TEST_CASE_FIXTURE(InFolder, "a comment asks for antialiasing, the last one counts, and writing keeps it") {
    const auto loadWith = [&](const std::string& comments, bool three_scales = true) {
        return loadScene(folder.write(
            "said.ply", replaced(makePly(0, three_scales).bytes(), "comment made for a test\n", comments)));
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
    CHECK_FALSE(loadWith("comment SplatRenderMode: mip\n", false).antialiased);  // discs do not dim
}

TEST_CASE_FIXTURE(InFolder, "an empty scene is a scene") {
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding, 9, true);
        for (Column& column : ply.columns) { column.values.clear(); }
        const auto [notes, scene] = readScene(folder.write("empty.ply", ply.bytes()));
        CHECK(scene.size() == 0);
        CHECK(notes.median_flatness == 0.0);
        CHECK(describeScene(scene, &notes).splats == 0);
        CHECK(writtenAndRead(folder, scene).size() == 0);
    }
}

TEST_CASE_FIXTURE(InFolder, "what is written reads back the same, opacity 0 and 1 and scale 0 exactly") {
    for (const int rest_count : {0, 9, 24, 45}) {
        Scene scene = loadScene(folder.write("in.ply", makePly(rest_count).bytes()));
        scene.opacities = {0.0f, 1.0f, 0.999999f};
        scene.scales = {{0.0f, 1e-6f}, {1.0f, 2.0f}, {3.0f, 1e6f}};
        const Scene again = writtenAndRead(folder, scene);
        CHECK(these(again.positions, again.sh, again.opacities[0], again.opacities[1], again.opacities[2],
                    again.scales[0].x) ==
              these(scene.positions, scene.sh, 0.0f, 1.0f, doctest::Approx(0.999999).epsilon(1e-6), 0.0f));
        CHECK(again.scales[0].y == doctest::Approx(1e-6).epsilon(1e-5));
        for (std::size_t i = 0; i < scene.size(); ++i) {
            CHECK(glm::length(again.rotations[i] - scene.rotations[i]) < 1e-6f);
            if (i > 0) { CHECK(glm::length(again.scales[i] / scene.scales[i] - 1.0f) < 1e-6f); }
        }
        scene.opacities.assign(3, 1e-6f);
        CHECK(writtenAndRead(folder, scene).opacities[0] == doctest::Approx(1e-6).epsilon(1e-5));
    }
}

TEST_CASE_FIXTURE(
    InFolder, "loading and writing report progress from 0 to 1, and writing leaves nothing half-written") {
    const Scene scene = makeBuiltin("builtin:one-splat"), large = randomScene(0, 100'000);
    const auto errorTo = [&](const std::string& path) { return errorOf([&] { writePly(scene, path); }); };
    CHECK(contains(errorTo(folder.file("absent/scene.ply")), "cannot be written"));
    CHECK(contains(errorTo(folder.file(".")), "is a directory"));
#ifndef _WIN32
    std::filesystem::create_symlink("/dev/null", folder.file("device.ply"));
    CHECK(contains(errorTo(folder.file("device.ply")), "not a regular file"));
    std::filesystem::remove(folder.file("device.ply"));
#endif
    // An old file stays as it was if the new one is not completed.
    checkProgress(4, [&](const Progress& progress) {
        writePly(scene, folder.file("kept.ply"));
        writePly(large, folder.file("kept.ply"), progress);
    });
    CHECK(loadScene(folder.file("kept.ply")).size() == 1);
    CHECK(folder.fileCount() == 1);
    writePly(large, folder.file("kept.ply"));
    checkProgress(
        4, [&](const Progress& progress) { (void)loadScene(folder.file("kept.ply"), 0, nullptr, progress); });
}

TEST_CASE_FIXTURE(InFolder, "errors of the source itself say what it is") {
    CHECK(contains(loadError(folder.file("absent.ply")), "absent.ply: no such file"));
    CHECK(contains(loadError(folder.write("zero.ply", "")), "is empty"));
#ifndef _WIN32
    CHECK(contains(loadError("/dev/null"), "not a regular file"));
    CHECK(contains(loadError(std::string(5000, 'x')), "cannot be read"));
#endif
    CHECK(contains(loadError(folder.write("picture.ply", "P6 not a scene")), "not a scene file"));
    CHECK(loadScene(folder.write("named_otherwise.txt", makePly().bytes())).size() == 3);

    const std::string pointer =
        "version https://git-lfs.github.com/spec/v1\noid sha256:" + std::string(64, 'a') + "\nsize 12345\n";
    for (const char* name :
         {"scene.ply", "scene.splat", "scene.spz", "scene.sog", "meta.json", "lod-meta.json"}) {
        CHECK(contains(loadError(folder.write(name, pointer)), std::string(name) + ": is a Git LFS pointer"));
    }
    CHECK(contains(loadError(folder.write("short", pointer.substr(0, 30))), "not a scene file"));
    CHECK(contains(loadError(folder.write("long", pointer + std::string(2000, 'x'))), "not a scene file"));
}

SCRIPT(ply, "engine/files/ply") {
    const Folder folder;
    runFaults(makePly(9).bytes(), [&](const std::string& broken) {
        const std::string message = loadError(folder, broken);
        CHECK(contains(message, "broken.ply: header"));
        return message;
    });
}

TEST_CASE_FIXTURE(InFolder, "absurd counts are refused before anything is allocated") {
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding);
        for (const char* count : {"4", "1000000000", "18446744073709551615"}) {
            const std::string message = loadError(
                folder, replaced(ply.bytes(), "element vertex 3", fmt::format("element vertex {}", count)));
            CHECK(contains(message, "broken.ply: data: ends"));
            CHECK(contains(message, fmt::format("of {}", count)));
        }
        ply.header_before = "element list 18446744073709551615\nproperty list uint int values\n";
        CHECK_FALSE(loadError(folder, ply.bytes()).empty());
        ply.header_before = "element pair 18446744073709551615\nproperty double a\nproperty double b\n";
        CHECK_FALSE(loadError(folder, ply.bytes()).empty());
    }
}

TEST_CASE_FIXTURE(InFolder,
                  "ascii values that are no numbers are named, with their splat, and a file that ends in a "
                  "splat says in which") {
    const std::string good = makeIn(Encoding::kAscii).bytes(), binary = makePly().bytes();
    CHECK(contains(loadError(folder, replaced(good, "\n2 0.25", "\n2 zwei")),
                   "splat 1 of 3: property y is 'zwei'"));
    CHECK(
        contains(loadError(folder, replaced(good, "\n2 0.25", "\n2")), "splat 1 of 3: property rot_3 is ''"));
    CHECK(contains(loadError(folder, replaced(good, "\n2 0.25", "\n2 0.25 1")),
                   "splat 1 of 3: more than the expected 16 values"));
    CHECK(loadError(folder, replaced(good, "\n2 0.25", "\n\n+2 \t 2.5e-1")).empty());
    CHECK(contains(loadError(folder, binary.substr(0, binary.size() - 1)), "ends in splat 2 of 3"));
}

TEST_CASE_FIXTURE(InFolder, "read in parts, a file is what it is as a whole, and is noted so") {
    Scene scene = makeBuiltin("builtin:atelier", 1500);
    scene.positions[3].x = std::numeric_limits<float>::quiet_NaN();
    scene.positions[900].x = std::numeric_limits<float>::quiet_NaN();
    writePly(scene, folder.file("a.ply"));
    const auto [whole_notes, whole] = readScene(folder.file("a.ply"));
    LoadNotes notes;
    InputFile file(folder.file("a.ply"));
    CHECK(countPly(file) == 1500);
    InputFile again(folder.file("a.ply"));
    Scene all;
    std::vector<std::size_t> sizes;
    readPlyParts(again, 500, notes, [&](Scene part) {
        sizes.push_back(part.size());
        if (sizes.size() == 1) { all = pickSplats(part, {}); }
        appendSplats(all, part);
    });
    CHECK(sizes == std::vector<std::size_t>{511, 511, 476});
    checkSameScene(all, whole);
    CHECK(all.name == whole.name);
    CHECK(these(notes.splats_in_file, notes.skipped_not_finite) ==
          these(whole_notes.splats_in_file, whole_notes.skipped_not_finite));
}

}  // SUITE(ply)
