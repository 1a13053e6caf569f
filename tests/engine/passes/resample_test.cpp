// Facts about resample: what a reprojected picture looks like, and the error expected of it, given what the
// twin's reproject left.
#include "tests/engine/passes/stereo_stages.h"

SUITE(resample) {

using reference::TileKind;
using Kinds = std::vector<TileKind>;
using Parts = StereoOnDevice::ResampleParts;

constexpr double kSteps = gpu::kErrorSteps;
constexpr glm::vec3 kBackground(0.25f, 0.5f, 0.75f);
constexpr gpu::uint kNewcomers = 12345;  // errors that earlier passes left

bool isSamePixel(const std::vector<gpu::uint>& before, const std::vector<gpu::uint>& after, std::size_t pixel,
                 const StereoOnDevice& device) {
    const std::size_t words = device.wordsPerPixel();
    return std::equal(&after[words * pixel], &after[words * pixel] + words, &before[words * pixel]);
}

struct Way {
    int gap_px;
    Rows rows;
    Parts parts = {};
    // Odd rows later; the eye does not tell rows apart in every other tile.
    bool apart = false, coarse = false;
};

// What the twin makes of the arrivals.
struct Expected {
    Expected(const StereoCase& c, const Arrived& arrived, const Kinds& kinds, const Way& way, bool rectified)
        : resolved(reference::resolve(arrived.arrivals, c.eyes, c.settings)) {
        if (way.parts.errors) {
            errors =
                reference::expectErrors(resolved, arrived.arrivals, c.dominant, kinds, c.eyes, c.settings);
        }
        if (way.apart && rectified) { reference::moveOddRowsAlike(resolved, c.sizePx()); }
        const glm::dvec3 behind(kBackground);
        colours = way.parts.forward
                      ? reference::copyColours(c.dominant, arrived.arrivals, kinds, c.eyes, behind)
                      : reference::resample(c.dominant, resolved, kinds, c.eyes, behind);
        depths = reference::resampleDepths(colours, resolved, kinds, c.sizePx());
        if (!way.coarse) { return; }
        const auto without = colours;
        std::vector<double> shares(kinds.size(), 0.26);
        for (std::size_t t = 0; t < shares.size(); t += 2) { shares[t] = 0.25; }
        reference::averageRows(colours, depths, resolved, kinds, shares, c.sizePx());
        for (std::size_t i = 0; i < colours.size(); ++i) { means += colours[i] != without[i]; }
    }

    std::vector<reference::Resolved> resolved;
    std::vector<glm::dvec4> colours;
    std::vector<double> depths, errors;
    std::size_t means = 0;
};

// How far the device is from the twin: colours beyond the rounding of half floats, relative depths, errors
// beyond a step per pixel.
struct Differences {
    double colour = 0.0, depth = 0.0, error = 0.0;
    std::size_t means = 0;
    std::vector<std::size_t> other_tiles = {};  // with other errors

    // `relative` to the expected error; each of the tile's pixels is rounded down to a step.
    void count(double got, double expected, std::size_t tile, double relative, double pixels) {
        error = std::max(error, (std::abs(got - expected) - pixels / kSteps) / std::max(expected, 1e-3));
        if (!isNear(got, expected, relative, pixels / kSteps)) { other_tiles.push_back(tile); }
    }
};

void resampleApart(StereoOnDevice& device, Parts parts, bool coarse) {
    device.resample(parts);
    std::vector<gpu::uint> errors(device.tileCount(), 7);
    for (std::size_t t = 0; t < errors.size() && coarse; t += 2) { errors[t] = gpu::kSeenCoarsely; }
    device.write(device.tile_errors, errors);
    parts.errors = false;
    parts.odd = true;
    device.resample(parts);
    CHECK(device.read(device.tile_errors) == errors);
}

// Runs the pass on one case, in tiles that are reprojected; the others must not change.
void check(Gpu& gpu, StereoCase c, const Kinds& kinds, const Way& way, Differences& differences) {
    INFO(c.name, ", gap px ", way.gap_px, ", rows ", static_cast<int>(way.rows), ", forward ",
         way.parts.forward, ", moves row ", way.parts.moves_row);
    if (areHalves(way.rows)) { roundToHalves(c.dominant); }
    c.settings.forward = way.parts.forward;
    // Gaps that reproject has not closed are left to this pass.
    c.settings.gap_px = way.gap_px == 5 ? 0 : way.gap_px;
    const Arrived arrived(c);
    c.settings.gap_px = way.gap_px;
    StereoOnDevice device = toDevice(gpu, c, way.rows);
    if (way.parts.moves_row && device.rectified() == 0) { return; }
    const Expected expected(c, arrived, kinds, way, device.rectified() != 0);
    differences.means += expected.means;
    if (!way.parts.moves_row) { device.writeArrivals(arrived.words); }
    device.write(device.tile_kinds, kindsOf(kinds));
    device.write(device.tile_errors, std::vector<gpu::uint>(device.tileCount(), kNewcomers));
    if (way.apart) { device.takeRowsApart(); }
    const auto before = device.read(device.affiliated);
    Parts parts = way.parts;
    parts.background = kBackground;
    way.apart ? resampleApart(device, parts, way.coarse) : device.resample(parts);
    const auto after = device.read(device.affiliated);
    const auto colours = device.readAffiliated();
    const auto depths = device.read<float>(device.depths);
    const auto classes = device.readClasses();
    std::size_t touched = 0, other_class = 0, other_depth = 0, other_parent = 0;
    std::array<std::uint32_t, 3> counts{};
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const TileKind kind = kinds[tileOf(i, c.sizePx())];
        const auto pixel_class = static_cast<std::uint8_t>(expected.resolved[i].pixel_class);
        if (kind == TileKind::kNone) {
            ++counts[pixel_class];
            other_class += parts.classes && classes[i] != pixel_class;
            if (parts.components && pixel_class == gpu::kHole) {  // they are about to be grouped
                other_parent += after[device.wordsPerPixel() * i] != i;
                continue;
            }
            if (parts.depths) {
                const double depth = depths[i], its = expected.depths[i];
                other_depth += (depth == 0.0) != (its == 0.0);
                differences.depth = std::max(differences.depth, std::abs(depth - its) / std::max(its, 1e-9));
            }
            for (int channel = 0; channel < 4; ++channel) {
                const double its = expected.colours[i][channel];
                // Means were rounded in both rows, and once more themselves.
                const double rounding = !areHalves(way.rows) ? 0.0
                                        : way.coarse         ? 2.0 * std::max(its * 0x1.1p-11, 0x1p-24)
                                                             : std::max(its * 0x1.01p-11, 0x1p-25);
                differences.colour = std::max(
                    differences.colour, std::abs(static_cast<double>(colours[i][channel]) - its) - rounding);
            }
        } else if (!way.apart) {
            other_class += parts.classes && classes[i] != 0;
            if (kind == TileKind::kHidden) {
                touched += colours[i] != gpu::vec4(kBackground, 0.0f) || (parts.depths && depths[i] != 0.0f);
            } else {
                touched += std::bit_cast<gpu::uint>(depths[i]) != StereoOnDevice::kUnwritten ||
                           !isSamePixel(before, after, i, device);
            }
        }
    }
    CHECK(these(touched, other_class, other_depth, other_parent) == these(0u, 0u, 0u, 0u));
    if (way.apart) { return; }
    const gpu::WarpCounters counters = device.readCounters();
    if (parts.classes) {
        CHECK(std::array{counters.covered_pixels, counters.gap_pixels, counters.hole_pixels} == counts);
    }
    if (parts.components) {
        const gpu::DispatchSize groups = counters.component_groups;
        CHECK(groups.x * groups.y * groups.z == (counts[gpu::kHole] > 0 ? 2 * device.tileCount() : 0));
    }
    if (way.rows == Rows::kOwn) { CHECK(device.readArrivals() == arrived.words); }
    // Added to what is there.
    const auto errors = device.read(device.tile_errors);
    const bool are_rows = c.sizePx().y <= 2;
    const double relative = !are_rows ? 1e-4 : c.sizePx().x <= 5000 ? 1e-3 : 4e-3;
    for (std::size_t t = 0; t < errors.size(); ++t) {
        if (!parts.errors || kinds[t] != TileKind::kNone) {
            CHECK(errors[t] == kNewcomers);
        } else {
            differences.count((errors[t] - kNewcomers) / kSteps, expected.errors[t], t, relative,
                              are_rows ? 32.0 : 256.0);
        }
    }
}

Differences checkAll(Gpu& gpu, std::span<const Way> ways) {
    Differences all;
    for (const StereoCase& c : makeStereoCases()) {
        for (const Way& way : ways) { check(gpu, c, markSome(tileCount(c.sizePx())), way, all); }
    }
    // A place is off by float32's rounding of a column, up to 1e-5 px, and the picture's slope is up to about
    // 1 per pixel; measured: 3.5e-6 and 3.5e-7.
    CHECK(all.colour <= 1e-5);
    return all;
}

// The result of resample, whether it moves rows itself or reproject did; with odd rows later if they are
// taken `apart`.
auto moveRows(Gpu& gpu, const StereoCase& c, const Kinds& kinds, const Way& way, bool moves_row) {
    StereoOnDevice device = toDevice(gpu, c, way.rows);
    Parts parts = way.parts;
    const bool hides = parts.hidden_tiles;
    if (hides) {
        std::vector<std::uint8_t> hidden(device.tileCount(), 0);
        for (std::size_t t = 1; t < hidden.size(); t += 5) { hidden[t] = 1; }
        device.writeHidden(hidden);
    }
    device.write(device.tile_kinds, kindsOf(kinds));
    if (!moves_row) { device.reproject(hides, parts.forward); }
    parts.hidden_tiles = moves_row && hides;
    parts.moves_row = moves_row;
    if (way.apart) { device.takeRowsApart(); }
    device.resample(parts);
    parts.odd = true;
    parts.errors = false;
    if (way.apart) { device.resample(parts); }
    // What remains of the two planes lies in tiles that are rendered.
    auto colours = device.readAffiliated();
    auto depths = device.read<float>(device.depths);
    for (std::size_t i = 0; i < colours.size(); ++i) {
        if (kinds[tileOf(i, c.sizePx())] == TileKind::kNone) { continue; }
        colours[i] = gpu::vec4(0.0f);
        depths[i] = 0.0f;
    }
    if (!parts.depths) { depths.clear(); }
    return std::tuple(std::move(colours), std::move(depths), device.readClasses(),
                      device.read(device.tile_errors));
}

TEST_CASE_FIXTURE(Gpu, "resample makes what the twin makes of tiles that move, and leaves others alone") {
    const std::array ways{
        Way{0, Rows::kOwn, {.errors = true}},
        Way{2, Rows::kShared, {.errors = true, .depths = true, .classes = true}},
        Way{2, Rows::kSharedHalves, {.errors = true}},
        Way{5, Rows::kOwn, {.errors = true, .depths = true, .classes = true}},
        Way{5, Rows::kOwnHalves, {.depths = true, .classes = true}},
        Way{2, Rows::kShared, {.classes = true, .components = true}},
        Way{0, Rows::kSharedHalves, {.depths = true, .classes = true, .forward = true}},
        Way{2, Rows::kOwn, {.depths = true, .classes = true, .forward = true}},
        Way{2, Rows::kSharedHalves, {.classes = true, .components = true, .forward = true}}};
    const Differences all = checkAll(*this, ways);
    CHECK(all.depth <= 1e-6);
    // A tile whose place rounds to the next source pixel has another gradient. Measured: 3 of 1140, by up to
    // 7e-4.
    CHECK(all.other_tiles.size() <= 6);
    CHECK(all.error <= 0.002);
}

TEST_CASE_FIXTURE(Gpu, "resample makes odd rows means of even ones where an eye does not tell them apart") {
    Way way{
        2, Rows::kShared, {.errors = true, .depths = true, .classes = true}, /*apart=*/true, /*coarse=*/true};
    std::vector<Way> ways{way};
    way.parts.moves_row = true;
    ways.push_back(way);
    way.rows = Rows::kSharedHalves;
    ways.push_back(way);
    const Differences all = checkAll(*this, ways);
    CHECK(all.means > 10000);
    CHECK(all.depth <= 1e-5);  // where this pass moves rows, inverse depths are its own, with 18 bits
}

TEST_CASE_FIXTURE(Gpu, "resample moves a row itself as reproject would, at once or odd rows later") {
    std::size_t pictures = 0;
    const Parts moved{.errors = true, .depths = true, .classes = true},
        copied{.depths = true, .classes = true, .forward = true, .hidden_tiles = true};
    Parts apart{.errors = true, .depths = true}, apart_hidden = apart, hidden = moved;
    hidden.hidden_tiles = apart_hidden.hidden_tiles = true;
    for (StereoCase c : makeStereoCases()) {
        if (toDevice(*this, c).rectified() == 0) { continue; }
        for (const Way& way : {Way{2, Rows::kShared, moved}, Way{5, Rows::kSharedHalves, hidden},
                               Way{2, Rows::kShared, copied}, Way{2, Rows::kSharedHalves, apart, true},
                               Way{5, Rows::kShared, apart_hidden, true}}) {
            INFO(c.name, ", gap px ", way.gap_px, ", apart ", way.apart, ", forward ", way.parts.forward);
            c.settings.gap_px = way.gap_px;
            c.settings.forward = way.parts.forward;
            const Kinds kinds = markSome(tileCount(c.sizePx()));
            CHECK(moveRows(*this, c, kinds, way, true) == moveRows(*this, c, kinds, way, false));
            ++pictures;
        }
    }
    CHECK(pictures == 50);
}

TEST_CASE_FIXTURE(Gpu, "resample takes rows of any length, also longer ones than it keeps at a time") {
    // A ramp with steps in depth: 20 px of disparity per unit of inverse depth.
    const std::uint32_t longest_shared = longestSharedRow(context());
    for (const std::uint32_t width :
         {1u, 31u, 33u, 128u, 257u, gpu::kArrivalsStep - 1, gpu::kArrivalsStep, gpu::kArrivalsStep + 1,
          longest_shared - 1, longest_shared, longest_shared + 1, 5000u, 16384u}) {
        CAPTURE(width);
        const glm::uvec2 size_px(width, 2);
        const auto eyes = stereoPair({Pose{}, {200.0, 200.0, 0.5 * width, 1.0}, size_px}, 0.1);
        const StereoCase c = computeCase(pairOf(eyes), [](auto x, auto y) {
            // The last pixel of the longest row moves by 10.5 px: it arrives at a pixel's left end, and seen
            // from that pixel's middle it came from the border.
            const double w = x == 16383 ? 0.525 : (x / 50) % 3 == 1 ? 1.7 : 0.1 + 0.001 * (x % 50);
            return ComputedPixel{
                {0.5 + 0.5 * std::sin(0.1 * x), x % 7 / 7.0, y, 1.0}, w, x % 11 == 0 ? std::sqrt(0.5) : 0.1};
        });
        const Kinds kinds(tileCount(size_px), TileKind::kNone);
        const Parts parts{.errors = true, .classes = true};
        for (const Rows rows : {Rows::kOwn, Rows::kShared}) {
            if (rows == Rows::kShared && width > longest_shared) { continue; }
            Differences differences;
            check(*this, c, kinds, {c.settings.gap_px, rows, parts}, differences);
            check(*this, c, kinds, {c.settings.gap_px, rows, {.classes = true}, /*apart=*/true}, differences);
            // In a column in the thousands, colours and what lies between pixels are off by up to 2e-4 px;
            // beyond ten thousand, by 1e-3.
            CHECK(differences.colour <= (width <= 5000 ? 1e-3 : 4e-3));
            // How a hole's pixel at the border is sampled depends on rounding.
            std::erase(differences.other_tiles, std::size_t{16383 / 16});
            CHECK(differences.other_tiles.empty());
            if (width > longest_shared) { continue; }
            for (const bool apart : {false, true}) {
                const Way way{c.settings.gap_px, rows, parts, apart};
                CHECK(moveRows(*this, c, kinds, way, true) == moveRows(*this, c, kinds, way, false));
            }
        }
    }
}

TEST_CASE_FIXTURE(Gpu, "resample moves nothing where nothing is worth moving, but paints what is hidden") {
    const StereoCase c = makeStereoCases().front();
    const Arrived arrived(c);
    StereoOnDevice device = toDevice(*this, c, Rows::kShared);
    const auto kinds = markSome(device.tileCount());
    device.writeArrivals(arrived.words);
    device.write(device.tile_kinds, kindsOf(kinds));
    device.writeCounters({});
    const auto before = device.read(device.affiliated);
    device.resample({.errors = true, .classes = true, .background = kBackground});
    const auto after = device.read(device.affiliated);
    const auto colours = device.readAffiliated();
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < colours.size(); ++i) {
        const bool hidden = kinds[tileOf(i, c.sizePx())] == TileKind::kHidden;
        wrong += hidden ? colours[i] != gpu::vec4(kBackground, 0.0f) : !isSamePixel(before, after, i, device);
    }
    CHECK(these(wrong, std::ranges::max(device.read(device.tile_errors)),
                std::ranges::max(device.readClasses())) == these(0u, 0u, 0u));
}

}  // SUITE(resample)
