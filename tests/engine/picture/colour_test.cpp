// Facts about the colour spaces, against the figures of their standards.
#include "engine/picture/colour.h"

#include <doctest/doctest.h>

#include <cmath>
#include <initializer_list>

TEST_SUITE_BEGIN("colour");

namespace colour_test {

using namespace binosplat;

namespace {

bool near(const glm::vec3& a, const glm::vec3& b, float tolerance) {
    return std::abs(a.x - b.x) <= tolerance && std::abs(a.y - b.y) <= tolerance && std::abs(a.z - b.z) <= tolerance;
}

}  // namespace

TEST_CASE("whiteIsD65") {
    CHECK(near(xyzFromLinear(glm::vec3(1.0f)), {0.95046f, 1.0f, 1.08906f}, 1e-5f));
    CHECK(near(ycxczFromXyz(xyzFromLinear(glm::vec3(1.0f))), {100.0f, 0.0f, 0.0f}, 1e-4f));
    CHECK(near(labFromXyz(xyzFromLinear(glm::vec3(1.0f))), {100.0f, 0.0f, 0.0f}, 1e-4f));
    CHECK(near(labFromXyz(glm::vec3(0.0f)), glm::vec3(0.0f), 1e-4f));
    CHECK(near(ycxczFromXyz(glm::vec3(0.0f)), {-16.0f, 0.0f, 0.0f}, 1e-6f));
}

TEST_CASE("primariesAreThoseOfTheStandard") {
    // The four decimals of IEC 61966-2-1.
    CHECK(near(xyzFromLinear({1.0f, 0.0f, 0.0f}), {0.4124f, 0.2126f, 0.0193f}, 5.1e-5f));
    CHECK(near(xyzFromLinear({0.0f, 1.0f, 0.0f}), {0.3576f, 0.7152f, 0.1192f}, 5.1e-5f));
    CHECK(near(xyzFromLinear({0.0f, 0.0f, 1.0f}), {0.1805f, 0.0722f, 0.9505f}, 5.1e-5f));
    CHECK(near(labFromXyz(xyzFromLinear({1.0f, 0.0f, 0.0f})), {53.24f, 80.09f, 67.20f}, 0.02f));
    CHECK(near(labFromXyz(xyzFromLinear({0.0f, 1.0f, 0.0f})), {87.735f, -86.183f, 83.180f}, 0.02f));
    CHECK(near(labFromXyz(xyzFromLinear({0.0f, 0.0f, 1.0f})), {32.30f, 79.19f, -107.86f}, 0.02f));
}

TEST_CASE("theDisplayCurveHasItsKnownValues") {
    // Encoded 0.5 is linear 0.21404; middle grey 119/255 is 0.1845; the straight part ends at 0.04045 / 12.92.
    CHECK(near(linearFromEncoded({0.0f, 0.5f, 1.0f}), {0.0f, 0.21404f, 1.0f}, 1e-5f));
    CHECK(near(linearFromEncoded({0.04045f, 0.04046f, 119.0f / 255.0f}), {0.0031308f, 0.0031316f, 0.18447f}, 1e-5f));
}

TEST_CASE("colourSpacesReturnWhatTheyWereGiven") {
    for (const glm::vec3& rgb : {glm::vec3(0.1f, 0.5f, 0.9f), {1.0f, 0.0f, 0.3f}, {0.0f, 0.0f, 0.0f}}) {
        const glm::vec3 xyz = xyzFromLinear(rgb);
        CHECK(near(linearFromXyz(xyz), rgb, 1e-6f));
        CHECK(near(xyzFromYcxcz(ycxczFromXyz(xyz)), xyz, 1e-6f));
    }
}

}  // namespace colour_test
