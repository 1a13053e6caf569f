// `binosplat kernels`: the driver's statistics of every kernel in every specialization that a mode uses, or
// of some, as they are made. Makes only pipelines, so that it also runs on drivers without their GPU.
#include "app/commands.h"
#include "app/terminal/interrupt.h"
#include "engine/error.h"
#include "engine/passes/pass_kernels.h"
#include "engine/passes/present.h"
#include "engine/setup/output_files.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cstdio>
#include <regex>
#include <utility>

namespace binosplat {

namespace {

using Json = nlohmann::ordered_json;

KernelTable allKernels(const Context& context) {
    KernelTable table = PassKernels(context).table();
    append(table, presentKernels());
    return table;
}

std::string nameOf(const KernelVariant& variant) {
    std::string text = variant.shader;
    for (const auto& [name, value] : variant.constants) { text += fmt::format(" {}={}", name, value); }
    return text;
}

// By the driver's own names.
Json statisticsOf(const Context& context, const Kernel& kernel) {
    Json statistics = Json::object();
    const auto executables =
        context.device().getPipelineExecutablePropertiesKHR(vk::PipelineInfoKHR(kernel.pipeline()));
    for (std::uint32_t i = 0; i < executables.size(); ++i) {
        for (const auto& one : context.device().getPipelineExecutableStatisticsKHR(
                 vk::PipelineExecutableInfoKHR(kernel.pipeline(), i))) {
            Json& value = statistics[one.name.data()];
            using Format = vk::PipelineExecutableStatisticFormatKHR;
            if (one.format == Format::eBool32) { value = one.value.b32 == VK_TRUE; }
            if (one.format == Format::eInt64) { value = one.value.i64; }
            if (one.format == Format::eUint64) { value = one.value.u64; }
            if (one.format == Format::eFloat64) { value = one.value.f64; }
        }
    }
    return statistics;
}

KernelTable chosenKernels(const Context& context, const std::string& filter) {
    KernelTable table = allKernels(context);
    try {
        const std::regex pattern(filter);
        std::erase_if(table, [&](const KernelVariant& variant) {
            return !std::regex_search(nameOf(variant), pattern);
        });
    } catch (const std::regex_error&) { table.clear(); }
    check(!table.empty(),
          "--filter is {}, must be a regular expression that matches a kernel's line, such as \"^rasterize "
          ".*kMasked=1\"",
          filter);
    return table;
}

}  // namespace

void runKernels(const KernelsOptions& options) {
    std::optional<OutputFiles> files;
    if (!options.out.empty()) { files.emplace(options.out); }
    const Context context({.device = options.device,
                           .device_extensions = {VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME}});
    const bool has_statistics = context.hasKernelStatistics();
    Json kernels = Json::array();
    // Lives until the next one is made: RADV frees its code memory once no kernel is left in it, and would
    // allocate another 8 MiB for the next kernel.
    Kernel last;
    for (const KernelVariant& variant : chosenKernels(context, options.filter)) {
        stopIfInterrupted();
        Kernel kernel(context, variant, has_statistics ? Kernel::Keep::kStatistics : Kernel::Keep::kNothing);
        Json constants = Json::object();
        for (const auto& [name, value] : variant.constants) { constants[name] = value; }
        const Json statistics = has_statistics ? statisticsOf(context, kernel) : Json::object();
        fmt::print("{}\n", nameOf(variant));
        for (const auto& [name, value] : statistics.items()) {
            fmt::print("    {:<40} {}\n", name, value.dump());
        }
        std::fflush(stdout);
        kernels.push_back({{"shader", variant.shader}, {"constants", constants}, {"statistics", statistics}});
        last = std::move(kernel);
    }
    context.requireNoValidationMessages();
    stopIfInterrupted();
    if (files) {
        const Json all{{"device", context.deviceName()}, {"kernels", kernels}};
        writeText(files->staging() / "kernels.json", all.dump(2) + "\n");
        files->publish();
    }
    fmt::print("{} kernels on {}{}\n", kernels.size(), context.deviceName(),
               has_statistics ? "" : ", which gives no statistics (VK_KHR_pipeline_executable_properties)");
}

}  // namespace binosplat
