// Facts about the choice between resolution and bound, on simulated devices and in simulated scenes: a
// frame's time and error are functions of both knobs, and not the functions that the model assumes.
#include "app/view/governor/governor.h"
#include "tests/suite.h"

SUITE(knobs) {

constexpr double kPeriodMs = 1000.0 / 90.0;

// Shares of the time of a full pair: constant, by pixels, by work, by rendered pixels.
struct Device {
    const char* waits_for;
    double ms, one, pixels, work, both;
};
// A resolution r adds an error of loss (1 / r^power - 1). Error and work are those of 28 dB, and change per
// dB.
struct Place {
    const char* name;
    double loss, power, error, db_per_db, work, work_per_db;
};
using Over = std::function<double(double time_s)>;
const Over kSame = [](double) { return 1.0; };
struct Change {
    const char* of;
    Over cost, motion;
    double stolen = 0.0;  // the share of frames from which others steal a tenth of a second
};

double workAt(const Place& place, double bound_db, double motion) {
    return std::min(place.work * motion * std::exp(place.work_per_db * (bound_db - 28.0)), 1.0);
}
double warpErrorAt(const Place& place, double bound_db, double motion) {
    return place.error * motion * std::pow(10.0, -0.1 * place.db_per_db * (bound_db - 28.0));
}
double lossAt(const Place& place, double scale) { return place.loss * (std::pow(scale, -place.power) - 1.0); }
double msAt(const Device& device, double scale, double work) {
    const double pixels = scale * scale;
    return device.ms * (device.one + device.pixels * pixels + work * (device.work + device.both * pixels));
}
// What is measured of a frame, a little different each time; its cost is relative to the device's usual one.
GovernedFrame drawFrame(const Device& device, const Place& place, const GovernedSettings& now, double cost,
                        double motion, std::mt19937& random, double stolen_ms = 0.0) {
    const double scale = now.resolution_scale, work = workAt(place, now.error_bound_db, motion),
                 ms = msAt(device, scale, work) * cost * drawBetween(random, 0.95, 1.05) + stolen_ms;
    const double lost = std::max(std::ceil(ms / kPeriodMs) - 1.0, 0.0),
                 warp_error = warpErrorAt(place, now.error_bound_db, motion) * drawBetween(random, 0.9, 1.1);
    return {ms, kPeriodMs, false, lost, work, warp_error, lossAt(place, scale / 2.0) - lossAt(place, scale)};
}

struct Minute {
    double late = 0.0, error = 0.0;  // shares of frames; mean square
    double error_at_last = 0.0;      // in the second half
    int changes_at_last = 0;         // likewise
    bool beaten = false, lowers_resolution_first = true;

    // With fixed knobs, frames are late if they leave less than a tenth of the period.
    Minute(const Device& device, const Place& place, const Change& change,
           const std::optional<Knobs>& fixed = {}) {
        Governor governor;
        std::mt19937 random(1), thief(2);
        std::optional<GovernedSettings> before;
        int frames = 0, frames_at_last = 0;
        for (double time_s = 0.0; time_s < 60.0; ++frames) {
            governor.wish(Quality::kBalanced, Mode::kTemporal, {1.0, 1.0});
            const GovernedSettings now =
                fixed ? GovernedSettings{1.0, fixed->scale, fixed->bound_db} : governor.settings();
            lowers_resolution_first &= now.error_bound_db >= 26.0 || now.resolution_scale == 0.6;
            const double motion = change.motion(time_s),
                         error_now = warpErrorAt(place, now.error_bound_db, motion) +
                                     lossAt(place, now.resolution_scale);
            const GovernedFrame frame = drawFrame(device, place, now, change.cost(time_s), motion, random,
                                                  drawUnit(thief) < change.stolen ? 100.0 : 0.0);
            if (!fixed) { governor.measure(frame); }
            late += frame.gpu_ms > (fixed ? 0.9 : 1.0) * kPeriodMs;
            error += error_now;
            if (time_s > 30.0) {
                changes_at_last += before && *before != now;
                ++frames_at_last;
                error_at_last += error_now;
            }
            before = now;
            time_s += 1e-3 * kPeriodMs * (1.0 + (fixed ? 0.0 : frame.lost_periods));
        }
        late /= frames;
        error /= frames;
        error_at_last /= frames_at_last;
        beaten = governor.isBeaten();
    }
};

constexpr std::array<Device, 3> kDevices{{{"pixels", 20.0, 0.05, 0.2, 0.0, 0.75},
                                          {"splats", 14.0, 0.3, 0.02, 0.65, 0.03},
                                          {"both", 24.0, 0.15, 0.1, 0.25, 0.5}}};
constexpr std::array<Place, 3> kPlaces{{{"smooth", 3e-5, 4.0, 3e-5, 0.8, 0.3, 0.04},
                                        {"sharp", 8e-4, 2.0, 9e-5, 0.5, 0.38, 0.075},
                                        {"between", 2e-4, 3.0, 4e-5, 0.6, 0.25, 0.06}}};

// Of the fixed pairs of knobs that are hardly ever late.
double leastError(const Device& device, const Place& place, const Change& change) {
    double least = 1.0;
    for (double tenths = 6.0; tenths <= 10.0; ++tenths) {
        // A lower bound is for the least resolution alone.
        for (double bound_db = tenths > 6.0 ? KnobModel::kLeastWhileScaleGives : 20.0; bound_db <= 30.0;
             ++bound_db) {
            const Minute fixed(device, place, change, Knobs{0.1 * tenths, bound_db});
            if (fixed.late <= 0.02) { least = std::min(least, fixed.error); }
        }
    }
    return least;
}

TEST_CASE("it is within a tenth of the best fixed knobs, hardly ever late, and comes to rest") {
    const std::array<Change, 5> changes{
        {{"nothing", kSame, kSame},
         {"the scene's cost", [](double t) { return t < 20.0 || t > 40.0 ? 1.0 : 1.25; }, kSame},
         {"the device's clock", [](double t) { return t < 25.0 ? 1.0 : 1.2; }, kSame},
         {"the head's motion", kSame, [](double t) { return std::fmod(t, 12.0) < 6.0 ? 1.0 : 0.3; }},
         {"now and then a frame takes long", kSame, kSame, 0.008}}};
    for (const Device& device : kDevices) {
        for (const Place& place : kPlaces) {
            for (const Change& change : changes) {
                INFO("waits for ", std::string(device.waits_for), ", ", std::string(place.name),
                     ", changes: ", std::string(change.of));
                const Minute governed(device, place, change);
                CHECK(governed.late <= 0.02);
                CHECK(governed.lowers_resolution_first);
                CHECK(std::sqrt(governed.error / leastError(device, place, change)) <= 1.1);
                if (change.of == std::string("nothing")) { CHECK(governed.changes_at_last <= 2); }
            }
        }
    }
}

TEST_CASE("a load that goes away little by little is not taken for what the knobs have saved") {
    const Change fades{"another program ends",
                       [](double t) { return 3.0 - 2.0 * std::clamp((t - 8.0) / 8.0, 0.0, 1.0); }, kSame};
    for (const Device& device : {kDevices[1], kDevices[2]}) {
        INFO("waits for ", std::string(device.waits_for));
        const Minute governed(device, kPlaces[1], fades);
        const double least = leastError(device, kPlaces[1], {"nothing", kSame, kSame});
        CHECK(std::sqrt(governed.error_at_last / least) <= 1.1);
    }
}

TEST_CASE("frames in full are exact whatever the bound, and say nothing about frames that are reprojected") {
    const KnobLimits limits;
    const Knobs all{1.0, 30.0};
    KnobModel model;
    const auto show = [&](const Knobs& knobs, const KnobFrame& frame) {
        for (int i = 0; i < 20; ++i) { model.add(knobs, frame); }
    };
    const KnobFrame reprojected{
        .ms = 8.0, .seconds = 0.01, .work = 0.3, .warp_error = 1e-4, .half_loss = 1e-3};
    show(all, reprojected);
    const double reprojected_error = model.expectedError(all);
    CHECK(reprojected_error > 0.0);
    const Knobs low{1.0, 22.0};
    show(low, {.ms = 9.0, .seconds = 0.01, .work = 1.0, .is_full = true});
    CHECK(model.expectedError(low) == 0.0);
    // A lower bound would save nothing, so the resolution pays for the time, and the bound may be the best.
    CHECK(model.best(9.5, limits) == all);
    const Knobs quicker = model.best(7.0, limits);
    CHECK(quicker.scale >= 0.7);
    CHECK(quicker.scale < 1.0);
    CHECK(quicker.bound_db == limits.most_bound_db);
    show(all, reprojected);
    CHECK(model.expectedMs(all) == doctest::Approx(8.0).epsilon(0.05));
    CHECK(model.expectedError(all) == doctest::Approx(reprojected_error).epsilon(0.1));
}

TEST_CASE("what three slow frames took away is given back within fifty frames, also where frames take long") {
    Governor governor;
    const Device slow{"both", 263.0, 0.12, 0.1, 0.45, 0.33};
    double least_scale = 1.0;
    for (int frame = 0; frame < 62; ++frame) {
        governor.wish(Quality::kBalanced, Mode::kTemporal, {0.2, 1.0});
        const GovernedSettings now = governor.settings();
        const double work = workAt(kPlaces[2], now.error_bound_db, 1.2);
        const double ms = msAt(slow, now.resolution_scale, work) * (frame >= 12 && frame < 15 ? 2.0 : 1.0);
        governor.measure({.gpu_ms = ms, .period_ms = 150.0, .work = work});
        least_scale = std::min(least_scale, now.resolution_scale);
    }
    CHECK(least_scale < 1.0);
    CHECK(governor.settings().resolution_scale == 1.0);
    CHECK(governor.settings().budget == 1.0);  // the bound decides, whatever the budget was
}

TEST_CASE("a load that grows hardly ever has it fall to the least knobs where much more fits") {
    const Device& device = kDevices[0];
    int fallen = 0;
    for (const double growth : {1.05, 1.08, 1.12}) {
        for (const double most : {1.16, 1.28, 1.3, 1.44}) {
            for (const Place& place : kPlaces) {
                CHECK(msAt(device, 0.6, workAt(place, 24.0, 1.0)) * most < 0.65 * kPeriodMs);
                for (unsigned seed = 1; seed <= 4; ++seed) {
                    Governor governor;
                    std::mt19937 random(seed);
                    double cost = most > 1.29 ? 0.9 : 0.8;
                    bool has_fallen = false;
                    for (int frame = 0; frame < 200; ++frame) {
                        governor.wish(Quality::kBalanced, Mode::kTemporal, {1.0, 1.0});
                        const GovernedSettings now = governor.settings();
                        has_fallen |=
                            now.resolution_scale < 0.61 && now.error_bound_db == KnobModel::kLeastBoundDb;
                        cost = frame > 45 ? std::min(growth * cost, most) : cost;
                        governor.measure(drawFrame(device, place, now, cost, 1.0, random));
                    }
                    fallen += has_fallen;
                }
            }
        }
    }
    CHECK(fallen <= 5);  // of 144
}

TEST_CASE("where nothing fits it ends at the least knobs") {
    const Minute slow({"all", 90.0, 0.3, 0.2, 0.2, 0.3}, kPlaces[0], {"nothing", kSame, kSame});
    CHECK(slow.beaten);
    CHECK(slow.changes_at_last == 0);
}

TEST_CASE("of two scenes that take as long a smooth one gives resolution, and a sharp one its bound") {
    KnobModel smooth, sharp;
    smooth.add({1.0, 30.0}, {14.0, 0.01, 0.35, 1e-4, 1e-5});
    sharp.add({1.0, 30.0}, {14.0, 0.01, 0.35, 1e-5, 1e-2});
    const KnobLimits limits{.least_scale = 0.4, .whole = 1.0, .most_bound_db = 30.0};
    const Knobs of_smooth = smooth.best(12.7, limits), of_sharp = sharp.best(12.7, limits);
    CHECK(these(of_smooth.scale, of_smooth.bound_db) == these(between(0.0, 1.0), 30.0));
    CHECK(these(of_sharp.scale, of_sharp.bound_db) == these(1.0, between(0.0, 30.0)));
}

}  // SUITE(knobs)
