// The viewer's defaults on a small device, such as a standalone headset, unless the user chooses otherwise.
#pragma once

#include "app/view/settings/view_settings.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace binosplat {

struct DeviceDefaults {
    Quality quality = Quality::kBalanced;
    double resolution_scale = 1.0;
    double refresh_rate = 0.0;               // if the headset has it; 0: the runtime's choice
    std::optional<std::uint32_t> sh_degree;  // the highest that is kept
    std::uint64_t most_splats = 0;           // for a streamed scene; 0: as many as fit
    bool operator==(const DeviceDefaults&) const = default;
};

// A device is small if its GPU is integrated, and either its driver's name is Turnip, Panfrost or Mali or it
// has less than 8 GiB. `memory_bytes`: of its largest heap.
DeviceDefaults defaultsOf(std::string_view device_name, bool is_integrated, std::uint64_t memory_bytes);

// "quality fast, resolution-scale 0.7"; empty if they are those of any device.
std::string describeDefaults(const DeviceDefaults& defaults);

}  // namespace binosplat
