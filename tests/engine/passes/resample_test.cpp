// Facts about resample: what a moved picture looks like, and the error that is expected of it, each started from what the twin's reproject
// left.
#include "tests/engine/passes/stereo_cases.h"
#include "tests/engine/passes/stereo_stages.h"

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <tuple>

TEST_SUITE_BEGIN("resample");

namespace resample_test {

using namespace binosplat;
using reference::PixelClass;
using reference::TileKind;
using test::Arrived;
using test::Gpu;
using test::Rows;
using test::StereoCase;
using test::StereoOnDevice;
using test::toDevice;

namespace {

bool isSamePixel(const std::vector<gpu::uint>& before, const std::vector<gpu::uint>& after, std::size_t pixel,
                 const StereoOnDevice& device) {
    const std::size_t words = device.wordsPerPixel();
    return std::equal(&after[words * pixel], &after[words * pixel] + words, &before[words * pixel]);
}

// The difference of two colours, less half of a half float's last place where they are kept as such.
double beyondRounding(const gpu::vec4& got, const glm::dvec4& expected, int channel, Rows rows) {
    const double difference = std::abs(static_cast<double>(got[channel]) - expected[channel]);
    return difference - (areHalves(rows) ? std::max(expected[channel] * 0x1.01p-11, 0x1p-25) : 0.0);
}

}  // namespace

TEST_CASE_FIXTURE(Gpu, "resample finds the twin's colours, depths and classes in tiles that are moved, and leaves the others alone") {
    const glm::vec3 background(0.25f, 0.5f, 0.75f);
    double worst = 0.0, worst_depth = 0.0;
    for (const StereoCase& whole : test::makeStereoCases()) {
        for (const auto& [gap_px, forward] :
             {std::pair(0, false), std::pair(2, false), std::pair(5, false), std::pair(0, true), std::pair(2, true)}) {
            for (const Rows rows : {Rows::kOwn, Rows::kShared, Rows::kOwnHalves, Rows::kSharedHalves}) {
                CAPTURE(whole.name);
                CAPTURE(gap_px);
                CAPTURE(forward);
                CAPTURE(static_cast<int>(rows));
                StereoCase c = whole;
                if (areHalves(rows)) { test::roundToHalves(c.dominant); }
                c.settings.forward = forward;
                // Gaps that reproject has not closed are left for this pass.
                c.settings.gap_px = gap_px == 5 ? 0 : gap_px;
                const Arrived arrived(c);
                c.settings.gap_px = gap_px;
                const auto resolved = reference::resolve(arrived.arrivals, c.eyes, c.settings);
                StereoOnDevice device = toDevice(*this, c, rows);
                const auto kinds = test::markSome(device.tileCount());
                device.writeArrivals(arrived.words);
                device.writeTileKinds(test::kindsOf(kinds));
                const auto before = device.readAffiliatedWords();
                device.resample({.depths = true, .classes = true, .forward = forward, .background = background});
                const auto after = device.readAffiliatedWords();
                const auto colours = device.readAffiliated();
                const auto depths = device.readDepths();
                const auto classes = device.readClasses();
                const glm::dvec3 behind(background);
                const auto expected = forward ? reference::copyColours(c.dominant, arrived.arrivals, kinds, c.eyes, behind)
                                              : reference::resample(c.dominant, resolved, kinds, c.eyes, behind);
                const auto expected_depths = reference::resampleDepths(expected, resolved, kinds, c.sizePx());
                std::size_t touched = 0, other_class = 0, other_depth = 0;
                std::array<std::uint32_t, 3> counts{};
                for (std::size_t i = 0; i < expected.size(); ++i) {
                    const TileKind kind = kinds[test::tileOf(i, c.sizePx())];
                    other_class += classes[i] == (kind == TileKind::kNone ? static_cast<std::uint8_t>(resolved[i].pixel_class) : 0) ? 0 : 1;
                    if (kind == TileKind::kHidden) {
                        touched += colours[i] == gpu::vec4(background, 0.0f) && depths[i] == 0.0f ? 0 : 1;
                    } else if (kind != TileKind::kNone) {
                        touched += std::bit_cast<gpu::uint>(depths[i]) == StereoOnDevice::kUnwritten ? 0 : 1;
                        touched += isSamePixel(before, after, i, device) ? 0 : 1;
                    } else {
                        ++counts[static_cast<std::size_t>(resolved[i].pixel_class)];
                        const double depth = static_cast<double>(depths[i]);
                        other_depth += (depth == 0.0) == (expected_depths[i] == 0.0) ? 0 : 1;
                        worst_depth = std::max(worst_depth, std::abs(depth - expected_depths[i]) / std::max(expected_depths[i], 1e-9));
                        for (int channel = 0; channel < 4; ++channel) {
                            worst = std::max(worst, beyondRounding(colours[i], expected[i], channel, rows));
                        }
                    }
                }
                CHECK(touched == 0);
                CHECK(other_class == 0);
                CHECK(other_depth == 0);
                const gpu::WarpCounters counters = device.readCounters();
                CHECK(counters.covered_pixels == counts[0]);
                CHECK(counters.gap_pixels == counts[1]);
                CHECK(counters.hole_pixels == counts[2]);
                // Nobody has asked for these.
                CHECK(std::ranges::all_of(device.readTileErrors(), [](gpu::uint error) { return error == 0; }));
                if (rows == Rows::kOwn) { CHECK(device.readArrivals() == arrived.words); }
            }
        }
    }
    MESSAGE("largest difference " << worst << ", of depths " << worst_depth);
    // A place is off by float32's rounding of a column, up to 1e-5 px, and the picture's slope is up to about 1 a pixel; measured: 3.5e-6
    // and 3.5e-7.
    CHECK(worst <= 1e-5);
    CHECK(worst_depth <= 1e-6);
}

TEST_CASE_FIXTURE(Gpu, "resample moves a row itself as reproject would, all rows at once or the odd ones later, to the bit") {
    std::size_t pictures = 0;
    for (StereoCase c : test::makeStereoCases()) {
        if (toDevice(*this, c).rectified() == 0) { continue; }
        for (const auto& [gap_px, forward, hides] : {std::tuple(2, false, false), std::tuple(5, false, true), std::tuple(2, true, true)}) {
            for (const Rows rows : {Rows::kShared, Rows::kSharedHalves}) {
                CAPTURE(c.name);
                CAPTURE(gap_px);
                CAPTURE(forward);
                CAPTURE(hides);
                CAPTURE(static_cast<int>(rows));
                c.settings.gap_px = gap_px;
                c.settings.forward = forward;
                // Taken apart, odd rows are moved like even ones.
                const auto resampled = [&](bool moves_row, bool apart) {
                    StereoOnDevice device = toDevice(*this, c, rows);
                    if (hides) {
                        std::vector<std::uint8_t> hidden(device.tileCount(), 0);
                        for (std::size_t t = 1; t < hidden.size(); t += 5) { hidden[t] = 1; }
                        device.writeHidden(hidden);
                    }
                    device.writeTileKinds(test::kindsOf(test::markSome(device.tileCount())));
                    if (!moves_row) { device.reproject(hides, forward); }
                    // What is left of the two planes lies in tiles that are rendered.
                    StereoOnDevice::ResampleParts parts{.errors = !forward,
                                                        .depths = true,
                                                        .classes = !apart,
                                                        .forward = forward,
                                                        .moves_row = moves_row,
                                                        .hidden_tiles = moves_row && hides};
                    if (apart) { device.takeRowsApart(); }
                    device.resample(parts);
                    parts.odd = true;
                    parts.errors = false;
                    if (apart) { device.resample(parts); }
                    return std::tuple(device.readAffiliated(), device.readDepths(), device.readClasses(), device.readTileErrors());
                };
                for (const bool apart : {false, true}) {
                    if (apart && forward) { continue; }
                    CAPTURE(apart);
                    const auto [colours, depths, classes, errors] = resampled(false, apart);
                    const auto [own_colours, own_depths, own_classes, own_errors] = resampled(true, apart);
                    const auto kinds = test::markSome(errors.size());
                    std::size_t other = 0;
                    for (std::size_t i = 0; i < colours.size(); ++i) {
                        if (kinds[test::tileOf(i, c.sizePx())] != TileKind::kNone) { continue; }
                        const auto bitsOf = [](float depth) { return std::bit_cast<gpu::uint>(depth); };
                        other += colours[i] == own_colours[i] && bitsOf(depths[i]) == bitsOf(own_depths[i]) ? 0 : 1;
                    }
                    CHECK(other == 0);
                    CHECK(own_classes == classes);
                    CHECK(own_errors == errors);
                }
                ++pictures;
            }
        }
    }
    CHECK(pictures == 60);
}

TEST_CASE_FIXTURE(Gpu, "resample makes odd rows the means of even ones where an eye does not tell them apart, as the twin does") {
    std::size_t means = 0;
    double worst = 0.0, worst_depth = 0.0;
    for (const StereoCase& whole : test::makeStereoCases()) {
        for (const auto& [rows, moves_row] : {std::pair(Rows::kOwn, false), std::pair(Rows::kShared, false), std::pair(Rows::kShared, true),
                                              std::pair(Rows::kSharedHalves, true)}) {
            CAPTURE(whole.name);
            CAPTURE(static_cast<int>(rows));
            CAPTURE(moves_row);
            StereoCase c = whole;
            if (areHalves(rows)) { test::roundToHalves(c.dominant); }
            StereoOnDevice device = toDevice(*this, c, rows);
            if (moves_row && device.rectified() == 0) { continue; }
            const Arrived arrived(c);
            auto resolved = reference::resolve(arrived.arrivals, c.eyes, c.settings);
            if (device.rectified() != 0) { reference::moveOddRowsAlike(resolved, c.sizePx()); }
            const auto kinds = test::markSome(device.tileCount());
            if (!moves_row) { device.writeArrivals(arrived.words); }
            device.writeTileKinds(test::kindsOf(kinds));
            device.takeRowsApart();
            StereoOnDevice::ResampleParts parts{.errors = true, .depths = true, .classes = true, .moves_row = moves_row};
            device.resample(parts);
            std::vector<double> shares(device.tileCount(), 0.26);
            std::vector<gpu::uint> errors(device.tileCount(), 7);
            for (std::size_t t = 0; t < shares.size(); t += 2) {
                shares[t] = 0.25;
                errors[t] = gpu::kSeenCoarsely;
            }
            device.writeTileErrors(errors);
            parts.errors = false;
            parts.odd = true;
            device.resample(parts);
            CHECK(device.readTileErrors() == errors);

            auto expected = reference::resample(c.dominant, resolved, kinds, c.eyes);
            auto expected_depths = reference::resampleDepths(expected, resolved, kinds, c.sizePx());
            const auto without = expected;
            reference::averageRows(expected, expected_depths, resolved, kinds, shares, c.sizePx());
            const auto colours = device.readAffiliated();
            const auto depths = device.readDepths();
            const auto classes = device.readClasses();
            std::size_t other_class = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                if (kinds[test::tileOf(i, c.sizePx())] != TileKind::kNone) { continue; }
                means += expected[i] != without[i] ? 1 : 0;
                other_class += classes[i] == static_cast<std::uint8_t>(resolved[i].pixel_class) ? 0 : 1;
                worst_depth = std::max(worst_depth,
                                       std::abs(static_cast<double>(depths[i]) - expected_depths[i]) / std::max(expected_depths[i], 1e-9));
                for (int channel = 0; channel < 4; ++channel) {
                    // Two rows that were rounded, and their mean once more.
                    const double rounding = areHalves(rows) ? 2.0 * std::max(expected[i][channel] * 0x1.1p-11, 0x1p-24) : 0.0;
                    worst = std::max(worst, std::abs(static_cast<double>(colours[i][channel]) - expected[i][channel]) - rounding);
                }
            }
            CHECK(other_class == 0);
        }
    }
    MESSAGE(means << " pixels are means; largest difference " << worst << ", of depths " << worst_depth);
    CHECK(means > 10000);
    CHECK(worst <= 1e-5);
    CHECK(worst_depth <= 1e-5);  // where this pass moves rows, inverse depths are its own, to 2^-18
}

TEST_CASE_FIXTURE(Gpu, "resample expects the twin's errors of tiles that are moved, and none of the others") {
    std::size_t tiles = 0, other_tiles = 0;
    double worst = 0.0;
    for (const StereoCase& whole : test::makeStereoCases()) {
        for (const auto& [gap_px, rows] :
             {std::pair(0, Rows::kOwn), std::pair(2, Rows::kShared), std::pair(2, Rows::kSharedHalves), std::pair(5, Rows::kOwn)}) {
            CAPTURE(whole.name);
            CAPTURE(gap_px);
            StereoCase c = whole;
            if (areHalves(rows)) { test::roundToHalves(c.dominant); }
            c.settings.gap_px = gap_px == 5 ? 0 : gap_px;
            const Arrived arrived(c);
            c.settings.gap_px = gap_px;
            StereoOnDevice device = toDevice(*this, c, rows);
            const auto kinds = test::markSome(device.tileCount());
            device.writeArrivals(arrived.words);
            device.writeTileKinds(test::kindsOf(kinds));
            // On top of what is there.
            const gpu::uint newcomers = 12345;
            device.writeTileErrors(std::vector<gpu::uint>(device.tileCount(), newcomers));
            device.resample({.errors = true});
            const auto errors = device.readTileErrors();
            const auto expected = reference::expectErrors(reference::resolve(arrived.arrivals, c.eyes, c.settings), arrived.arrivals,
                                                          c.dominant, kinds, c.eyes, c.settings);
            for (std::size_t t = 0; t < errors.size(); ++t) {
                if (kinds[t] != TileKind::kNone) {
                    CHECK(errors[t] == newcomers);
                    continue;
                }
                const double error = (errors[t] - newcomers) / static_cast<double>(gpu::kErrorSteps);
                // Each of 256 pixels is rounded down to a step. One whose place rounds to the next source pixel has another gradient.
                const double beyond = std::abs(error - expected[t]) - 256.0 / static_cast<double>(gpu::kErrorSteps);
                worst = std::max(worst, beyond / std::max(expected[t], 1e-3));
                other_tiles += test::isNear(error, expected[t], 1e-4, 256.0 / static_cast<double>(gpu::kErrorSteps)) ? 0 : 1;
                ++tiles;
            }
        }
    }
    MESSAGE(other_tiles << " of " << tiles << " tiles differ, by up to " << worst);
    // Measured: 3 of 1140, by up to 7e-4.
    CHECK(other_tiles <= 6);
    CHECK(worst <= 0.002);
}

TEST_CASE_FIXTURE(Gpu, "resample copies colours as they are, and mixes those of a gap's two ends, however far each is") {
    // Nothing moves but by whole pixels: one at inverse depth 0.1 by 1 px to the left, one at 0.4 by 4 px. Colours are the columns'
    // squares.
    const glm::uvec2 size_px(16, 1);
    const auto eyes = stereoPair({Pose{}, {100.0, 100.0, 8.0, 0.5}, size_px}, 0.1);
    StereoCase c{"steps", {}, {eyes[kLeft], eyes[kRight]}, {size_px, {}, {}, {}, {}}, {}};
    c.settings.forward = true;
    for (int x = 0; x < 16; ++x) {
        const double w = x == 8 ? 0.4 : 0.1;
        c.dominant.rgba.emplace_back(x * x / 256.0, 0.5, 0.25, 1.0);
        c.dominant.depth.push_back(1.0 / w);
        c.dominant.inverse_depth.push_back(w);
        c.dominant.inverse_depth_squared.push_back(w * w);
    }
    test::roundToWords(c.dominant, c.settings);
    for (const Rows rows : {Rows::kOwn, Rows::kShared}) {
        StereoOnDevice device = toDevice(*this, c, rows);
        device.reproject(/*hidden_tiles=*/false, /*forward=*/true);
        device.resample({.classes = true, .forward = true});
        const auto colours = device.readAffiliated();
        const auto classes = device.readClasses();
        for (int x = 0; x < 16; ++x) {
            CAPTURE(x);
            // Column 8 lies in front of column 5 in pixel 4, and pixel 7, which it leaves, is between columns 7 and 9; beyond the last
            // column, in pixel 15, that one repeats.
            const int source = x == 4 ? 8 : std::min(x + 1, 15);
            const float expected = x == 7 ? (49.0f + 81.0f) / 512.0f : static_cast<float>(source * source) / 256.0f;
            CHECK(colours[static_cast<std::size_t>(x)] == gpu::vec4(expected, 0.5f, 0.25f, 1.0f));
            CHECK(classes[static_cast<std::size_t>(x)] == (x == 7 ? gpu::kGap : x == 15 ? gpu::kHole : gpu::kCovered));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "resample makes holes their own parents where they are going to be grouped") {
    for (StereoCase c : test::makeStereoCases()) {
        for (const bool forward : {false, true}) {
            CAPTURE(c.name);
            CAPTURE(forward);
            c.settings.forward = forward;
            const Rows rows = c.dominant.size_px.x % 2 == 0 ? Rows::kShared : Rows::kSharedHalves;
            if (areHalves(rows)) { test::roundToHalves(c.dominant); }
            const Arrived arrived(c);
            const auto resolved = reference::resolve(arrived.arrivals, c.eyes, c.settings);
            StereoOnDevice device = toDevice(*this, c, rows);
            const auto kinds = test::markSome(device.tileCount());
            device.writeArrivals(arrived.words);
            device.writeTileKinds(test::kindsOf(kinds));
            device.resample({.classes = true, .components = true, .forward = forward});
            const auto words = device.readAffiliatedWords();
            const auto colours = device.readAffiliated();
            const auto expected = forward ? reference::copyColours(c.dominant, arrived.arrivals, kinds, c.eyes)
                                          : reference::resample(c.dominant, resolved, kinds, c.eyes);
            std::size_t holes = 0, wrong = 0;
            for (std::size_t i = 0; i < resolved.size(); ++i) {
                if (kinds[test::tileOf(i, c.sizePx())] != TileKind::kNone) { continue; }
                const bool hole = resolved[i].pixel_class == PixelClass::kHole;
                holes += hole ? 1 : 0;
                const bool parent = words[device.wordsPerPixel() * i] == i;
                wrong += (hole ? parent : beyondRounding(colours[i], expected[i], 0, rows) <= 1e-5) ? 0 : 1;
            }
            CHECK(wrong == 0);
            const gpu::WarpCounters counters = device.readCounters();
            CHECK(counters.hole_pixels == holes);
            const gpu::DispatchSize groups = counters.component_groups;
            const glm::uvec2 tiles = (c.sizePx() + 15u) / 16u;
            CHECK(groups.x * groups.y * groups.z == (holes > 0 ? tiles.x * 2 * tiles.y : 0));
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "resample takes rows of any length, also longer ones than it keeps at a time") {
    // A ramp with steps in depth: 20 px apart for a unit of inverse depth.
    const std::uint32_t longest_shared = test::longestSharedRow(context());
    for (const std::uint32_t width : {1u, 31u, 32u, 33u, 127u, 128u, 129u, 256u, 257u, gpu::kArrivalsStep - 1, gpu::kArrivalsStep,
                                      gpu::kArrivalsStep + 1, longest_shared - 1, longest_shared, longest_shared + 1, 5000u, 16384u}) {
        const glm::uvec2 size_px(width, 2);
        const auto eyes = stereoPair({Pose{}, {200.0, 200.0, 0.5 * width, 1.0}, size_px}, 0.1);
        StereoCase c{"ramp", {}, {eyes[kLeft], eyes[kRight]}, {size_px, {}, {}, {}, {}}, {}};
        for (std::uint32_t i = 0; i < 2 * width; ++i) {
            const std::uint32_t x = i % width;
            // The last one of the longest row moves by 10.5 px: it arrives at a pixel's left end, and from the middle it came from the
            // border.
            const double w = x == 16383 ? 0.525 : (x / 50) % 3 == 1 ? 1.7 : 0.1 + 0.001 * (x % 50);
            c.dominant.rgba.emplace_back(0.5 + 0.5 * std::sin(0.1 * x), x % 7 / 7.0, i / width, 1.0);
            c.dominant.depth.push_back(1.0 / w);
            c.dominant.inverse_depth.push_back(w);
            c.dominant.inverse_depth_squared.push_back(w * w * (x % 11 == 0 ? 1.5 : 1.01));
        }
        test::roundToWords(c.dominant, c.settings);
        CAPTURE(width);
        for (const Rows rows : {Rows::kOwn, Rows::kShared}) {
            if (rows == Rows::kShared && width > longest_shared) { continue; }
            const Arrived arrived(c);
            const auto resolved = reference::resolve(arrived.arrivals, c.eyes, c.settings);
            StereoOnDevice device = toDevice(*this, c, rows);
            const std::vector<TileKind> kinds(device.tileCount(), TileKind::kNone);
            device.writeArrivals(arrived.words);
            device.resample({.errors = true, .classes = true});
            const auto expected = reference::resample(c.dominant, resolved, kinds, c.eyes);
            const auto colours = device.readAffiliated();
            const auto classes = device.readClasses();
            double worst = 0.0;
            std::size_t other_class = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                other_class += classes[i] == static_cast<std::uint8_t>(resolved[i].pixel_class) ? 0 : 1;
                for (int channel = 0; channel < 4; ++channel) {
                    worst = std::max(worst, std::abs(static_cast<double>(colours[i][channel]) - expected[i][channel]));
                }
            }
            CHECK(other_class == 0);
            // Of a column in the thousands, 2e-4 px: so much are colours off, and what lies between pixels. Beyond ten thousand, 1e-3.
            const double most = width <= 5000 ? 1e-3 : 4e-3;
            CHECK(worst <= most);
            const auto errors = device.readTileErrors();
            const auto expected_errors = reference::expectErrors(resolved, arrived.arrivals, c.dominant, kinds, c.eyes, c.settings);
            for (std::size_t t = 0; t < errors.size(); ++t) {
                if (t == 16383 / 16) { continue; }  // how a hole's pixel at the border is sampled is a matter of rounding
                CHECK(test::isNear(errors[t] / static_cast<double>(gpu::kErrorSteps), expected_errors[t], most,
                                   32.0 / static_cast<double>(gpu::kErrorSteps)));
            }
            const auto moved = [&](bool moves_row, bool apart) {
                StereoOnDevice anew = toDevice(*this, c, rows);
                if (apart) { anew.takeRowsApart(); }
                if (!moves_row) { anew.reproject(); }
                anew.resample({.errors = true, .classes = true, .moves_row = moves_row});
                if (apart) { anew.resample({.classes = true, .moves_row = moves_row, .odd = true}); }
                return std::tuple(anew.readAffiliated(), anew.readClasses(), anew.readTileErrors());
            };
            if (width <= longest_shared) {
                CHECK(moved(true, true) == moved(false, true));
                CHECK(moved(true, false) == moved(false, false));
            }
            // From what arrived at the twin: odd rows as even ones.
            StereoOnDevice apart = toDevice(*this, c, rows);
            apart.takeRowsApart();
            apart.writeArrivals(arrived.words);
            apart.resample({.classes = true});
            apart.resample({.classes = true, .odd = true});
            auto alike = resolved;
            reference::moveOddRowsAlike(alike, size_px);
            const auto expected_apart = reference::resample(c.dominant, alike, kinds, c.eyes);
            const auto colours_apart = apart.readAffiliated();
            double worst_apart = 0.0;
            for (std::size_t i = 0; i < expected_apart.size(); ++i) {
                const glm::dvec4 difference = glm::abs(glm::dvec4(colours_apart[i]) - expected_apart[i]);
                worst_apart = std::max({worst_apart, difference.r, difference.g, difference.b, difference.a});
            }
            CHECK(worst_apart <= most);
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "resample moves nothing where nothing is worth moving, but paints what is hidden") {
    const StereoCase c = test::makeStereoCases().front();
    const Arrived arrived(c);
    StereoOnDevice device = toDevice(*this, c, Rows::kShared);
    const auto kinds = test::markSome(device.tileCount());
    device.writeArrivals(arrived.words);
    device.writeTileKinds(test::kindsOf(kinds));
    device.writeCounters({});
    const auto before = device.readAffiliatedWords();
    device.resample({.errors = true, .classes = true, .background = glm::vec3(0.5f)});
    const auto after = device.readAffiliatedWords();
    const auto colours = device.readAffiliated();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const bool hidden = kinds[test::tileOf(i, c.sizePx())] == TileKind::kHidden;
        wrong += (hidden ? colours[i] == gpu::vec4(0.5f, 0.5f, 0.5f, 0.0f) : isSamePixel(before, after, i, device)) ? 0 : 1;
    }
    CHECK(wrong == 0);
    CHECK(std::ranges::all_of(device.readTileErrors(), [](gpu::uint error) { return error == 0; }));
    CHECK(std::ranges::all_of(device.readClasses(), [](std::uint8_t pixel_class) { return pixel_class == 0; }));
}

}  // namespace resample_test
