// Written SOG: codebooks and palettes that come close, and what a bundle preserves of a scene.
#include "engine/files/codebook.h"
#include "engine/files/sh_palette.h"
#include "engine/files/sog.h"
#include "engine/files/sog_pack.h"
#include "tests/engine/scene/scene_measures.h"

SUITE(sog_write) {

Scene throughSog(const Folder& folder, const Scene& scene, LoadNotes* notes = nullptr) {
    writeSog(scene, folder.file("a.sog"));
    Scene back = loadScene(folder.file("a.sog"), 0, notes);
    fs::remove(folder.file("a.sog"));
    return back;
}

TEST_CASE("a codebook keeps few numbers as they are, and of many it keeps what is nearest in squares") {
    const std::vector<float> few{3.0f, -1.0f, 3.0f, 1e9f, 0.25f};
    const Codebook exact(few);
    for (const float number : few) { CHECK(exact.values()[exact.nearest(number)] == number); }
    CHECK(std::ranges::is_sorted(exact.values()));
    CHECK(Codebook(std::vector<float>{}).values()[255] == 0.0f);

    const Codebook apart(few, -200.0f);
    CHECK(these(apart.values()[0], apart.nearest(-200.0f), apart.values()[apart.nearest(-1.0f)]) ==
          these(-200.0f, 0, -1.0f));
    CHECK(Codebook(std::vector<float>{}, -20.0f).values()[255] == -20.0f);

    std::mt19937 random(5);
    std::normal_distribution<float> bell(0.0f, 1.0f);
    std::vector<float> numbers(100'000);
    for (float& number : numbers) { number = bell(random); }
    const Codebook book(numbers);
    double error = 0.0;
    for (const float number : numbers) {
        error += std::pow(double{number - book.values()[book.nearest(number)]}, 2) / 100'000.0;
    }
    // By Panter and Dite: sqrt(3) pi / 2 / 256^2 for a normal distribution with variance 1. Even steps have
    // three times this, and a neighbour of the nearest has more.
    CHECK(error < 1.1 * 2.7207 / 65536.0);

    // An outlier does not take entries of the codebook away from the other numbers.
    numbers.assign(1, 1e12f);
    for (int i = 0; i < 50'000; ++i) { numbers.push_back(static_cast<float>(i) / 50'000.0f); }
    const Codebook with_outlier(numbers);
    CHECK(with_outlier.values()[with_outlier.nearest(1e12f)] == 1e12f);
    for (const float number : {0.0f, 0.1f, 0.77f, 0.99f}) {
        CHECK(std::abs(with_outlier.values()[with_outlier.nearest(number)] - number) < 0.004f);
    }
}

TEST_CASE("a palette keeps rows of zeros and as many different rows as it has entries") {
    Scene scene = randomScene(2, 2000);
    for (std::size_t i = 0; i < scene.size(); ++i) {
        for (std::size_t k = 3; k < 27; ++k) {
            scene.sh[27 * i + k] = i % 3 == 0 ? 0.0f : static_cast<float>((i % 40) * k % 17) / 17.0f;
        }
    }
    const ShPalette palette = makeShPalette(scene, 64, {});
    CHECK(palette.coefficients == 8);
    CHECK(palette.size() <= 41);
    REQUIRE(palette.labels.size() == scene.size());
    for (std::size_t i = 0; i < scene.size(); ++i) {
        for (std::size_t k = 3; k < 27; ++k) {
            const float kept = palette.entries[24 * palette.labels[i] + k - 3];
            CHECK((i % 3 == 0 ? kept == 0.0f : std::abs(kept - scene.sh[27 * i + k]) < 1e-6f));
        }
    }
}

TEST_CASE("a palette's rows come nearer to the harmonics the more there are") {
    const Scene scene = randomScene(1, 4000);
    double before = 1e9;
    for (const std::size_t most : {1u, 2u, 16u, 300u, 2048u, 4096u}) {
        CAPTURE(most);
        const ShPalette palette = makeShPalette(scene, most, {});
        CHECK(palette.size() <= most);
        double squares = 0.0;
        for (std::size_t i = 0; i < scene.size(); ++i) {
            REQUIRE(palette.labels[i] < palette.size());
            const float* kept = palette.entries.data() + 9 * palette.labels[i];
            for (int k = 0; k < 9; ++k) { squares += std::pow(kept[k] - scene.sh[12 * i + 3 + k], 2); }
        }
        CHECK(squares < 0.95 * before);
        before = squares;
    }
    CHECK(before < 1e-9);  // each has its own entry
}

TEST_CASE_FIXTURE(InFolder, "writing keeps every attribute within its quantum, along a curve") {
    for (const int degree : {0, 1, 3}) {
        CAPTURE(degree);
        const Scene scene = randomScene(degree, 5000);
        const std::vector<std::uint32_t> order = mortonOrder(findSogPlaces(scene));
        CHECK(std::set<std::uint32_t>(order.begin(), order.end()).size() == scene.size());
        writeSog(scene, folder.file("a.sog"));
        CHECK(folder.fileCount() == 1);
        const auto [notes, back] = readScene(folder.file("a.sog"));
        REQUIRE(these(back.size(), back.sh_degree, back.isGaussian3d()) == these(scene.size(), degree, true));
        CHECK(these(back.antialiased, notes.lines.empty()) == these(false, true));
        float position = 0.0f, opacity = 0.0f;
        double shape = 0.0;
        for (std::size_t i = 0; i < scene.size(); ++i) {
            const std::size_t from = order[i];
            for (int axis = 0; axis < 3; ++axis) {
                const float step = (1.0f + std::abs(scene.positions[from][axis])) * 2.0f *
                                   std::log1p(axis == 2 ? 50.0f : 3.0f) / 65535.0f;
                position = std::max(position,
                                    std::abs(scene.positions[from][axis] - back.positions[i][axis]) / step);
            }
            opacity = std::max(opacity, std::abs(scene.opacities[from] - back.opacities[i]));
            const double longest = std::max(scene.scales[from].x, scene.scales[from].y);
            shape = std::max(
                shape, largest(covarianceOf(scene, from) - covarianceOf(back, i)) / (longest * longest));
        }
        const auto [colour, sh] = shDifferences(scene, back, order);
        CHECK(position < 0.6f);
        CHECK(opacity < 0.5f / 255.0f + 1e-5f);
        // 256 scales within a factor of 100, plus half a step of 1/(255 sqrt(2)) in three components
        CHECK(shape < 0.05);
        CHECK(colour < 0.02f);
        CHECK(sh < (degree == 1 ? 0.11f : 0.25f));  // 4096 rows for 5000 splats of noise
        writeSog(scene, folder.file("b.sog"));
        CHECK(textIn(folder.file("a.sog")) == textIn(folder.file("b.sog")));
        fs::remove(folder.file("b.sog"));
    }
}

TEST_CASE_FIXTURE(InFolder, "discs, antialiasing and scales without extent are kept") {
    LoadNotes notes;
    CHECK_FALSE(throughSog(folder, randomScene(0, 100, false), &notes).isGaussian3d());
    CHECK_FALSE(notes.three_scales);
    Scene scene = randomScene(0, 1000);
    scene.antialiased = true;
    for (std::size_t i = 0; i < 1000; i += 2) { scene.thicknesses[i] = 0.0f; }
    const std::vector<std::uint32_t> order = mortonOrder(findSogPlaces(scene));
    const Scene back = throughSog(folder, scene);
    CHECK(back.antialiased);
    REQUIRE(back.isGaussian3d());
    for (std::size_t i = 0; i < 1000; ++i) {
        CHECK((back.thicknesses[i] < 1e-8f) == (order[i] % 2 == 0));
        CHECK(std::min(back.scales[i].x, back.scales[i].y) > 1e-3f);
    }
}

TEST_CASE_FIXTURE(InFolder, "scenes of no splat, one, on one plane and far away are written and read") {
    CHECK(throughSog(folder, {}).size() == 0);
    const Scene one = randomScene(3, 1);
    const Scene back = throughSog(folder, one);
    REQUIRE(these(back.size(), back.sh) == these(1, one.sh));
    CHECK(glm::distance(back.positions[0], one.positions[0]) < 1e-4f);
    Scene plane = randomScene(0, 300);
    for (glm::vec3& position : plane.positions) { position.y = -7.0f; }
    plane.positions[5].x = -3e38f, plane.positions[6].z = 3e38f;
    const std::vector<std::uint32_t> order = mortonOrder(findSogPlaces(plane));
    const Scene flat = throughSog(folder, plane);
    REQUIRE(flat.size() == 300);
    for (std::size_t i = 0; i < 300; ++i) {
        CHECK(flat.positions[i].y == doctest::Approx(-7.0f));
        if (order[i] == 5) { CHECK(flat.positions[i].x == doctest::Approx(-3e38f).epsilon(1e-4)); }
    }
}

TEST_CASE_FIXTURE(InFolder, "writing tells how far it is, may be stopped, and leaves nothing half-written") {
    const Scene scene = randomScene(1, 3000);
    checkProgress(8, [&](const Progress& progress) {
        CHECK(folder.fileCount() == 0);
        writeSog(scene, folder.file("a.sog"), progress);
        fs::remove(folder.file("a.sog"));
    });
    Scene light = randomScene(0, 10);
    CHECK_THROWS_AS(writeSog(light, folder.file("nowhere/a.sog")), Error);
    CHECK_THROWS_AS(writeSog(light, folder.file(".")), Error);
    light.is_linear = true;
    CHECK_THROWS_AS(writeSog(light, folder.file("a.sog")), Error);
    CHECK(folder.fileCount() == 0);
}

}  // SUITE(sog_write)
