// .ksplat: values at every level and degree, buckets and sections, and what is refused.
#include "tests/engine/files/ksplat_files.h"
#include "tests/shared_data.h"

SUITE(ksplat_format) {

void checkContents(const Scene& scene, const KsplatText& text, int sh_degree) {
    REQUIRE(scene.size() == KsplatText::kSplats * text.degrees.size());
    REQUIRE(scene.sh_degree == sh_degree);
    const auto coefficients = static_cast<std::size_t>(shCoefficientCount(sh_degree));
    for (std::size_t splat = 0; splat < scene.size(); ++splat) {
        const int section = static_cast<int>(splat) / KsplatText::kSplats,
                  i = static_cast<int>(splat) % KsplatText::kSplats;
        CAPTURE(splat);
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(scene.positions[splat][axis] ==
                  doctest::Approx(KsplatText::coordinate(section, i, axis)).epsilon(1e-5));
        }
        // The first of three growing scales becomes the last, and the others move up.
        CHECK(scene.scales[splat].x == doctest::Approx(KsplatText::scale(i, 1)));
        CHECK(scene.scales[splat].y == doctest::Approx(KsplatText::scale(i, 2)));
        CHECK(scene.thicknesses[splat] == doctest::Approx(KsplatText::scale(i, 0)));
        const glm::mat3 stored = glm::mat3_cast(glm::quat(0.5f, -0.5f, 0.5f, i == 0 ? -0.5f : 0.5f));
        CHECK(glm::length(glm::mat3_cast(scene.rotations[splat])[2] - stored[0]) < 1e-5f);
        CHECK(scene.opacities[splat] == doctest::Approx(1.0 - 0.2 * i));
        const double shown[] = {0.2 * i, 1.0 - 0.2 * i, 0.4};
        for (std::size_t channel = 0; channel < 3; ++channel) {
            const float* sh = scene.sh.data() + 3 * splat * coefficients + channel;
            CHECK(0.5 + 0.28209479177387814 * static_cast<double>(sh[0]) == doctest::Approx(shown[channel]));
            for (std::size_t k = 1; k < coefficients; ++k) {
                const bool has_it = k < static_cast<std::size_t>(shCoefficientCount(
                                            text.degrees[static_cast<std::size_t>(section)]));
                double expected =
                    has_it ? KsplatText::harmonic(i, static_cast<int>(k), static_cast<int>(channel)) : 0.0;
                if (text.level == 2 && has_it) { expected = std::clamp(expected, -2.0, 2.0); }
                CHECK(std::abs(static_cast<double>(sh[3 * k]) - expected) <=
                      (text.level == 2 ? 4.0 / 255.0 * 0.51 : 1e-5));
            }
        }
    }
}

TEST_CASE(
    "a .ksplat of each level gives what its bytes mean: sections of each degree, and room that is not used "
    "is passed over") {
    const Folder folder;
    for (const int level : {0, 1, 2}) {
        for (const std::vector<int>& degrees : {std::vector<int>{0}, {1}, {2}, {0, 2, 1}}) {
            INFO("level ", level, ", degrees.front() ", degrees.front());
            KsplatText text;
            text.level = level;
            text.degrees = degrees;
            LoadNotes notes;
            checkContents(loadScene(folder.write("named otherwise", text.bytes()), 0, &notes), text,
                          *std::ranges::max_element(degrees));
            CHECK(these(notes.lines.empty(), notes.three_scales) == these(true, true));
            if (degrees.size() == 1) { continue; }
            std::string shorter = text.bytes();
            shorter[4096 + 1024] = 3;  // instead of five splats in the second section
            CHECK(loadScene(folder.write("shorter", shorter)).size() == 13);
        }
    }
    // Without bounds, harmonics in bytes lie between -1.5 and 1.5.
    KsplatText text;
    text.level = 2;
    text.least_harmonic = text.most_harmonic = 0.0f;
    std::string bytes = text.bytes();
    bytes.replace(bytes.size() - 3, 3, "\xff\x80\x01");
    const Scene scene = loadScene(folder.write("bounds", bytes));
    CHECK(scene.sh[scene.sh.size() - 3 * 2 - 1] == doctest::Approx(1.5));
    CHECK(scene.sh[scene.sh.size() - 1] == doctest::Approx(-1.5 + 3.0 / 255.0));
}

TEST_CASE("the same four splats as .splat and as .ksplat are the same scene" * needsSharedData()) {
    const auto data = sharedData();
    if (!data) { return; }
    const Scene plain = loadScene((*data / "formats/minimal.splat").string()),
                scene = loadScene((*data / "formats/minimal.ksplat").string());
    REQUIRE(scene.size() == 4);
    CHECK(these(scene.positions, scene.scales, scene.thicknesses, scene.opacities, scene.sh) ==
          these(plain.positions, plain.scales, plain.thicknesses, plain.opacities, plain.sh));
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(glm::length(scene.rotations[i] - plain.rotations[i]) < 1e-2f);
    }
}

TEST_CASE_FIXTURE(InFolder, "a .ksplat that does not fit is named") {
    const std::string good = KsplatText{}.bytes();
    const auto errorWith = [&](std::size_t at, const std::string& bytes) {
        std::string broken = good;
        return loadError(folder.write("broken.ksplat", broken.replace(at, bytes.size(), bytes)));
    };
    CHECK(contains(errorWith(20, "\3"), "broken.ksplat: header: compression level 3, expected 0, 1 or 2"));
    CHECK(contains(errorWith(5, "\1"), "header: 257 sections, but only"));
    CHECK(contains(errorWith(4096 + 40, "\3"), "section 0: header: SH degree 3, expected 0 to 2"));
    CHECK(contains(errorWith(4096 + 3, "\1"), "splats with room for 5"));
    CHECK(contains(errorWith(4096 + 7, "\x7f"), "section 0: data:"));
    CHECK(contains(errorWith(4096 + 15, "\x7f"), "section 0: data:"));
    CHECK(contains(errorWith(4096 + 20, "\x10"), "section 0: "));
    CHECK(contains(errorWith(4096 + 32, "\1"), "1 full and 1 other buckets, expected 3 in all"));
    CHECK(contains(errorWith(4096 + 8, "\1"), "3 buckets hold 3 splats, expected 5"));
    CHECK(contains(errorWith(1, "\2"), "not a scene file"));
    for (const std::size_t length : {24u, 44u, 4095u, 4096u, 5119u, 5120u, 5130u}) {
        CHECK(contains(loadError(folder.write("cut.ksplat", good.substr(0, length))), "cut.ksplat: "));
    }
    CHECK(contains(loadError(folder.write("cut.ksplat", good.substr(0, good.size() - 1))),
                   "bytes are left of"));
}

}  // SUITE(ksplat_format)
