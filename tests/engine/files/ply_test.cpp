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
        CHECK(these(scene.sh_degree, scene.positions[2], scene.sh, scene.scales[0].x) ==
              these(0, glm::vec3(-3.0f, 0.125f, 6.0f),
                    std::vector<float>{0.0f, 0.25f, 0.5f, 0.0f, 0.5f, 1.0f, 0.0f, -0.5f, -1.0f}, 1.0f));
        CHECK(these(scene.opacities[0], scene.opacities[1], scene.scales[0].y) ==
              these(0.5f, doctest::Approx(1.0 / (1.0 + std::exp(-2.0))).epsilon(1e-6),
                    doctest::Approx(std::exp(-3.0)).epsilon(1e-6)));
        CHECK(scene.rotations ==
              std::vector<glm::quat>{{1, 0, 0, 0}, {0.5f, 0.5f, 0.5f, 0.5f}, {0, 0, -1, 0}});
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
    const auto [notes, flat] = readScene(folder.write("flat.ply", ply.bytes()));
    CHECK(these(flat.sh_degree, notes.sh_degree_in_file) == these(0, 3));
    checkSays(notes.lines, "SH bands above degree 0");

    // 700 splats make three blocks. Only the last splat has a coefficient of band 2, so rows that were stored
    // before must be widened.
    ply.resize(700);
    ply["f_rest_0"].values[3] = 7.0;     // channel 0, k = 1
    ply["f_rest_21"].values[699] = 9.0;  // channel 1, k = 7
    const Scene scene = loadScene(folder.write("late.ply", ply.bytes()));
    REQUIRE(these(scene.sh_degree, scene.sh.size()) == these(2, 700 * 27));
    CHECK(these(scene.sh[3 * 27 + 3 * 1 + 0], scene.sh[699 * 27 + 3 * 7 + 1]) == these(7.0f, 9.0f));
    CHECK(std::ranges::count(scene.sh, 0.0f) == 700 * 25 - 2);  // f_dc_1 and f_dc_2 are not zero
}

TEST_CASE_FIXTURE(InFolder, "blocks that are read ahead come all and in order, also what is wrong in one") {
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
        checkError(fmt::format("splat {} of 20000: property x is 'x'", broken), folder, text);
    }
    // A reader that stops taking blocks waits for nothing.
    checkProgress(2, [&, path = folder.write("whole.ply", whole)](const Progress& progress) {
        (void)loadScene(path, 0, nullptr, progress);
    });
}

TEST_CASE_FIXTURE(InFolder, "of three scales the shortest becomes the last, and flattening drops it") {
    const double logs[] = {-1.0, -2.0, -0.5};
    const glm::quat rotation(0.3f, -0.5f, 0.7f, 0.2f);
    const glm::mat3 trained = glm::mat3_cast(glm::normalize(rotation));
    for (const int shortest : {0, 1, 2}) {
        PlyText ply = makePly(0, true);
        for (int axis = 0; axis < 3; ++axis) {
            setAll(ply, fmt::format("scale_{}", axis), axis == shortest ? -7.0 : logs[axis]);
            setAll(ply, fmt::format("rot_{}", axis + 1), rotation[axis]);
        }
        setAll(ply, "rot_0", rotation.w);
        auto [notes, scene] = readScene(folder.write("three.ply", ply.bytes()));
        const int u = (shortest + 1) % 3, v = (shortest + 2) % 3;
        // The normal lies along the shortest axis.
        const glm::mat3 kept = glm::mat3_cast(scene.rotations[0]);
        CHECK(largest(glm::dmat3(kept) - glm::dmat3(trained[u], trained[v], trained[shortest])) < 1e-6);
        REQUIRE(scene.isGaussian3d());
        CHECK(these(scene.scales[0].x, scene.scales[0].y, scene.thicknesses[0]) ==
              these(doctest::Approx(std::exp(logs[u])), doctest::Approx(std::exp(logs[v])),
                    doctest::Approx(std::exp(-7.0))));
        CHECK(these(notes.three_scales, notes.median_flatness, notes.lines.empty()) ==
              these(true, doctest::Approx(std::exp(-7.0 - std::min(logs[u], logs[v]))), true));
        checkSameScene(writtenAndRead(folder, scene), scene);
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
                CHECK(these(scene.positions[1].x, scene.sh.size(), notes.skipped_not_finite,
                            notes.skipped_zero_rotation) == these(-3.0f, 2 * 12, 1, 0));
                checkSays(notes.lines, "1 of 3 splats skipped");
            }
        }
    }
    PlyText ply = makePly(9);
    ply["scale_0"].values[0] = 89.0;  // exp(89) exceeds float32
    ply["rot_2"].values[2] = 0.0;
    ply["nx"].values[1] = kNan;  // normals are not read
    const auto [notes, scene] = readScene(folder.write("bad.ply", ply.bytes()));
    CHECK(these(scene.size(), notes.skipped_not_finite, notes.skipped_zero_rotation, notes.lines.size()) ==
          these(1, 1, 1, 2));
}

TEST_CASE_FIXTURE(InFolder, "a logit of infinity is opacity 1; only the shortest axis may have no extent") {
    const auto read = [&](const PlyText& ply) { return readScene(folder.write("a.ply", ply.bytes())); };
    const auto checkSkipped = [&](const PlyText& ply) {
        const auto [notes, scene] = read(ply);
        CHECK(these(scene.size(), notes.skipped_not_finite) == these(2, 1));
    };
    for (const Encoding encoding : kEncodings) {
        for (const bool three_scales : {false, true}) {
            PlyText ply = makeIn(encoding, 9, three_scales);
            ply["opacity"].values[1] = kInfinity;
            const auto [notes, scene] = read(ply);
            CHECK(these(scene.size(), scene.opacities.at(1), notes.lines.empty()) == these(3, 1.0f, true));
        }
        for (int axis = 0; axis < 3; ++axis) {
            CAPTURE(axis);
            PlyText ply = makeIn(encoding, 0, true);
            ply[fmt::format("scale_{}", axis)].values[0] = -kInfinity;
            const auto [notes, disc] = read(ply);
            const double kept = axis == 0 ? -3.0 : axis == 1 ? -5.0 : 0.0;  // the next axis in cyclic order
            CHECK(these(disc.size(), disc.thicknesses.at(0), disc.scales[0].x, notes.lines.empty()) ==
                  these(3, 0.0f, doctest::Approx(std::exp(kept)), true));
            CHECK(writtenAndRead(folder, disc).thicknesses[0] == 0.0f);
            ply[fmt::format("scale_{}", (axis + 1) % 3)].values[0] = -kInfinity;  // a needle without width
            checkSkipped(ply);
        }
        PlyText flat = makeIn(encoding);
        flat["scale_1"].values[0] = -kInfinity;
        checkSkipped(flat);
    }
}

TEST_CASE_FIXTURE(InFolder, "an empty scene is a scene") {
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding, 9, true);
        ply.resize(0);
        const auto [notes, scene] = readScene(folder.write("empty.ply", ply.bytes()));
        CHECK(these(scene.size(), notes.median_flatness, describeScene(scene, &notes).splats,
                    writtenAndRead(folder, scene).size()) == these(0, 0.0, 0, 0));
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

TEST_CASE_FIXTURE(InFolder, "loading and writing report progress, and leave nothing half-written") {
    const Scene scene = makeBuiltin("builtin:one-splat"), large = randomScene(0, 100'000);
    const std::string kept = folder.file("kept.ply");
    const auto errorTo = [&](const std::string& name) {
        return errorOf([&] { writePly(scene, folder.file(name)); });
    };
    CHECK(contains(errorTo("absent/scene.ply"), "cannot be written"));
    CHECK(contains(errorTo("."), "is a directory"));
#ifndef _WIN32
    fs::create_symlink("/dev/null", folder.file("device.ply"));
    CHECK(contains(errorTo("device.ply"), "not a regular file"));
    fs::remove(folder.file("device.ply"));
#endif
    // An old file stays as it was if the new one is not completed.
    checkProgress(4, [&](const Progress& progress) {
        writePly(scene, kept);
        writePly(large, kept, progress);
    });
    CHECK(these(loadScene(kept).size(), folder.fileCount()) == these(1, 1));
    writePly(large, kept);
    checkProgress(4, [&](const Progress& progress) { (void)loadScene(kept, 0, nullptr, progress); });
}

SCRIPT(ply, "engine/files/ply") {
    const Folder folder;
    const auto readSaid = [&](const std::string& comments, bool three_scales) {
        return readScene(folder.write(
            "said.ply",
            replaced(makePly(0, three_scales).bytes(), "comment made for a test\n", unescaped(comments))));
    };
    std::map<std::string, std::function<void(const std::string&)>> verbs;
    for (const bool asks : {false, true}) {
        verbs[asks ? "mip" : "plain"] = [&, asks](const std::string& comments) {
            const Scene scene = readSaid(comments, true).scene;
            CHECK(these(scene.antialiased, writtenAndRead(folder, scene).antialiased) == these(asks, asks));
            CHECK_FALSE(readSaid(comments, false).scene.antialiased);  // discs do not dim
        };
    }
    verbs["vertical"] = [&](const std::string& line) {
        const auto [notes, scene] = readSaid(line.substr(2), false);
        const int axis = line[0] == '-' ? -1 : line[0] - 'x';
        CHECK(these(scene.vertical_axis, writtenAndRead(folder, scene).vertical_axis) == these(axis, axis));
        CHECK(notes.axes == (axis < 0 ? "" : line.substr(0, 1) + " is vertical (named by the file)"));
    };
    const auto readBroken = [&](const std::string& broken) {
        const std::string message = loadError(folder, broken);
        CHECK(contains(message, "broken.ply: header"));
        return message;
    };
    runFaults(makePly(9).bytes(), readBroken, verbs);
}

TEST_CASE_FIXTURE(InFolder, "absurd counts are refused before anything is allocated") {
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makeIn(encoding);
        for (const std::string count : {"4", "1000000000", "18446744073709551615"}) {
            const std::string message =
                loadError(folder, replaced(ply.bytes(), "element vertex 3", "element vertex " + count));
            CHECK(contains(message, "broken.ply: data: ends"));
            CHECK(contains(message, "of " + count));
        }
        for (const char* element : {"list 18446744073709551615\nproperty list uint int values\n",
                                    "pair 18446744073709551615\nproperty double a\nproperty double b\n"}) {
            ply.header_before = std::string("element ") + element;
            CHECK_FALSE(loadError(folder, ply.bytes()).empty());
        }
    }
}

TEST_CASE_FIXTURE(InFolder, "ascii values that are no numbers, and where a file ends, are named") {
    const std::string good = makeIn(Encoding::kAscii).bytes(), binary = makePly().bytes();
    for (const auto& [values, message] : {std::pair("\n2 zwei", "splat 1 of 3: property y is 'zwei'"),
                                          {"\n2", "splat 1 of 3: property rot_3 is ''"},
                                          {"\n2 0.25 1", "splat 1 of 3: more than the expected 16 values"}}) {
        checkError(message, folder, replaced(good, "\n2 0.25", values));
    }
    CHECK(loadError(folder, replaced(good, "\n2 0.25", "\n\n+2 \t 2.5e-1")).empty());
    checkError("ends in splat 2 of 3", folder, binary.substr(0, binary.size() - 1));
}

TEST_CASE_FIXTURE(InFolder, "read in parts, a file is what it is as a whole, and is noted so") {
    Scene scene = makeBuiltin("builtin:atelier", 1500);
    for (const std::size_t splat : {3, 900}) {
        scene.positions[splat].x = std::numeric_limits<float>::quiet_NaN();
    }
    writePly(scene, folder.file("a.ply"));
    const auto [whole_notes, whole] = readScene(folder.file("a.ply"));
    LoadNotes notes;
    InputFile file(folder.file("a.ply")), again(folder.file("a.ply"));
    CHECK(countPly(file) == 1500);
    Scene all;
    std::vector<std::size_t> sizes;
    readPlyParts(again, 500, notes, [&](Scene part) {
        sizes.push_back(part.size());
        if (sizes.size() == 1) { all = pickSplats(part, {}); }
        appendSplats(all, part);
    });
    CHECK(sizes == std::vector<std::size_t>{511, 511, 476});
    checkSameScene(all, whole);
    CHECK(these(all.name, notes.splats_in_file, notes.skipped_not_finite) ==
          these(whole.name, whole_notes.splats_in_file, whole_notes.skipped_not_finite));
}

}  // SUITE(ply)
