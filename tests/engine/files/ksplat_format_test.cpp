// .ksplat: values at every level and degree, buckets and sections, and what is refused.
#include "tests/engine/files/ksplat_files.h"
#include "tests/shared_data.h"

SUITE(ksplat_format) {

void checkContents(const Scene& scene, const KsplatText& text, int sh_degree) {
    REQUIRE(these(scene.size(), scene.sh_degree) ==
            these(KsplatText::kSplats * text.degrees.size(), sh_degree));
    const int coefficients = shCoefficientCount(sh_degree);
    for (int splat = 0; splat < KsplatText::kSplats * static_cast<int>(text.degrees.size()); ++splat) {
        const int section = splat / KsplatText::kSplats, i = splat % KsplatText::kSplats;
        CAPTURE(splat);
        for (int axis = 0; axis < 3; ++axis) {
            CHECK(scene.positions[splat][axis] ==
                  doctest::Approx(KsplatText::coordinate(section, i, axis)).epsilon(1e-5));
        }
        // The first of three growing scales becomes the last, and the others move up.
        CHECK(these(scene.scales[splat].x, scene.scales[splat].y, scene.thicknesses[splat]) ==
              these(doctest::Approx(KsplatText::scale(i, 1)), doctest::Approx(KsplatText::scale(i, 2)),
                    doctest::Approx(KsplatText::scale(i, 0))));
        const glm::mat3 stored = glm::mat3_cast(glm::quat(0.5f, -0.5f, 0.5f, i == 0 ? -0.5f : 0.5f));
        CHECK(glm::length(glm::mat3_cast(scene.rotations[splat])[2] - stored[0]) < 1e-5f);
        CHECK(scene.opacities[splat] == doctest::Approx(1.0 - 0.2 * i));
        const double shown[] = {0.2 * i, 1.0 - 0.2 * i, 0.4};
        for (int channel = 0; channel < 3; ++channel) {
            const float* sh = scene.sh.data() + 3 * splat * coefficients + channel;
            CHECK(0.5 + 0.28209479177387814 * sh[0] == doctest::Approx(shown[channel]));
            for (int k = 1; k < coefficients; ++k) {
                const bool has_it = k < shCoefficientCount(text.degrees[section]);
                const double stored_value = has_it ? KsplatText::harmonic(i, k, channel) : 0.0;
                // In bytes, within bounds.
                const double expected = text.level == 2 ? std::clamp(stored_value, -2.0, 2.0) : stored_value;
                CHECK(std::abs(sh[3 * k] - expected) <= (text.level == 2 ? 4.0 / 255.0 * 0.51 : 1e-5));
            }
        }
    }
}

TEST_CASE("a .ksplat of each level and degree gives what its bytes mean, without its unused room") {
    const Folder folder;
    for (const int level : {0, 1, 2}) {
        for (const std::vector<int>& degrees : {std::vector<int>{0}, {1}, {2}, {0, 2, 1}}) {
            INFO("level ", level, ", degrees.front() ", degrees.front());
            const KsplatText text{.level = level, .degrees = degrees};
            const auto [notes, scene] = readScene(folder.write("named otherwise", text.bytes()));
            checkContents(scene, text, std::ranges::max(degrees));
            CHECK(these(notes.lines.empty(), notes.three_scales) == these(true, true));
            if (degrees.size() == 1) { continue; }
            std::string shorter = text.bytes();
            shorter[4096 + 1024] = 3;  // instead of five splats in the second section
            CHECK(loadScene(folder.write("shorter", shorter)).size() == 13);
        }
    }
    // Without bounds, harmonics in bytes lie between -1.5 and 1.5.
    std::string bytes = KsplatText{.level = 2, .least_harmonic = 0.0f, .most_harmonic = 0.0f}.bytes();
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
    const std::tuple<std::size_t, std::string, const char*> faults[]{
        {20, "\3", "broken.ply: header: compression level 3, expected 0, 1 or 2"},
        {5, "\1", "header: 257 sections, but only"},
        {4096 + 40, "\3", "section 0: header: SH degree 3, expected 0 to 2"},
        {4096 + 3, "\1", "splats with room for 5"},
        {4096 + 7, "\x7f", "section 0: data:"},
        {4096 + 15, "\x7f", "section 0: data:"},
        {4096 + 20, "\x10", "section 0: "},
        {4096 + 32, "\1", "1 full and 1 other buckets, expected 3 in all"},
        {4096 + 8, "\1", "3 buckets hold 3 splats, expected 5"},
        {1, "\2", "not a scene file"}};
    for (const auto& [at, bytes, message] : faults) {
        std::string broken = good;
        checkError(message, folder, broken.replace(at, 1, bytes));
    }
    for (const std::size_t length : {24u, 44u, 4095u, 4096u, 5119u, 5120u, 5130u}) {
        checkError("broken.ply: ", folder, good.substr(0, length));
    }
    checkError("bytes are left of", folder, good.substr(0, good.size() - 1));
}

}  // SUITE(ksplat_format)
