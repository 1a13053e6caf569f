// What the viewer starts with on which device.
#include "app/view/view.h"
#include "tests/suite.h"

SUITE(device_defaults) {

constexpr std::uint64_t kGiB = std::uint64_t{1} << 30;

TEST_CASE("small is what a headset's processor holds, or a GPU within a processor that has less than 8 GiB") {
    const DeviceDefaults headset{.quality = Quality::kFast,
                                 .resolution_scale = 0.7,
                                 .refresh_rate = 72.0,
                                 .sh_degree = 2,
                                 .most_splats = 11'000'000};
    CHECK(defaultsOf("Turnip Adreno (TM) 750", true, 11 * kGiB) == headset);
    for (const char* name : {"Mali-G610 MC4 (Panfrost)", "Mali-G78", "V3D 7.1.7"}) {
        CHECK_MESSAGE(defaultsOf(name, true, 6 * kGiB).most_splats == 6'000'000, name);
    }
    CHECK(defaultsOf("V3D 4.2", true, kGiB / 4).most_splats == 500'000);
    CHECK(defaultsOf("NVIDIA GeForce GTX 1060", false, 6 * kGiB) == DeviceDefaults{});
    CHECK(defaultsOf("AMD Custom GPU 0405 (RADV VANGOGH)", true, 8 * kGiB) == DeviceDefaults{});
    CHECK(describeDefaults({}).empty());
    CHECK(these(DeviceDefaults{}.quality, ViewSettings{}.quality) ==
          these(Quality::kBalanced, Quality::kBalanced));
}

TEST_CASE("hardware begins with a quality that holds the rate, software with none, unless one is named") {
    ViewOptions options;
    const auto qualityOn = [&](bool is_software) { return startSettings(options, is_software).quality; };
    CHECK(these(qualityOn(false), qualityOn(true)) == these(Quality::kBalanced, Quality::kOff));
    const DeviceDefaults small = defaultsOf("V3D 7.1.7", true, kGiB);
    CHECK(startSettings(options, false, small).quality == Quality::kFast);
    options.tables.push_back({"view", "a.toml:1", {{"quality", {"a.toml:2: quality", {"sharp"}}}}});
    CHECK(these(qualityOn(false), qualityOn(true)) == these(Quality::kSharp, Quality::kSharp));
}

}  // SUITE(device_defaults)
