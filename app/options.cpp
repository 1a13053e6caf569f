// The command line, read with CLI11, and the typed values of all settings.
#include "app/options.h"

#include "app/option_layers.h"
#include "app/option_table.h"
#include "app/version.h"
#include "engine/error.h"
#include "engine/picture/flip.h"
#include "engine/setup/values.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <limits>
#include <span>
#include <string_view>

namespace binosplat {

namespace {

// A gap is filled pixel by pixel from its two ends; beyond this it is no crack in a surface but something hidden.
constexpr std::uint64_t kMaxGapPx = 64;
constexpr std::uint64_t kMaxMoveCost = 1'000'000;
// Values lie between 0 and a few; the passes hold a pixel's squared error under 64.
constexpr double kMaxExpectedError = 8.0;
constexpr std::uint64_t kMaxMemoryMib = std::uint64_t{1} << 30;

// What CLI11 fills in; values stay text until both layers are merged.
struct CommandLine {
    std::map<std::string, std::string> values;
    std::map<std::string, CLI::Option*> given;
    std::map<std::string, bool> flags;
};

void addRows(CLI::App& command, CommandLine& line, std::span<const OptionRow> rows, const char* group) {
    for (const OptionRow& row : rows) {
        const std::string name = std::string("--") + row.key;
        const bool is_flag = *row.value == '\0';
        CLI::Option* option =
            is_flag ? command.add_flag(name, line.flags[row.key], row.help) : command.add_option(name, line.values[row.key], row.help);
        if (!is_flag) { option->type_name(row.value); }
        option->group(group);
        line.given[row.key] = option;
    }
}

void addCommonRows(CLI::App& command, CommandLine& line, std::string& config) {
    addRows(command, line, kCameraRows, "Camera");
    addRows(command, line, kStereoRows, "Stereo");
    addRows(command, line, kRunRows, "Run");
    command.add_option("--config", config, "TOML file with any of these options; the command line wins")->type_name("FILE")->group("Run");
}

CLI::Option* addLpipsOption(CLI::App& command, std::string& weights) {
    return command.add_option("--lpips", weights, "also measure LPIPS, with this file of weights (squeeze, 0.1)")->type_name("WEIGHTS");
}

// Of the camera only what a headset leaves open.
void addViewRows(CLI::App& command, CommandLine& line, std::string& config) {
    for (const OptionRow& row : kCameraRows) {
        const std::string_view key = row.key;
        if (key == "eye" || key == "look" || key == "up" || key == "near" || key == "background") {
            addRows(command, line, std::span(&row, 1), "Camera");
        }
    }
    for (const OptionRow& row : kStereoRows) {
        if (std::string_view(row.key) != "ipd") { addRows(command, line, std::span(&row, 1), "Stereo"); }
    }
    addRows(command, line, std::span(kRunRows).first(std::size(kRunRows) - 1), "Run");  // without the last: the device is the headset's
    command.add_option("--config", config, "TOML file with any of these options; the command line wins")->type_name("FILE")->group("Run");
}

Settings commandLineLayer(const CommandLine& line) {
    Settings layer;
    for (const auto& [key, option] : line.given) {
        if (option->count() == 0) { continue; }
        const bool is_flag = !line.values.contains(key);
        layer.emplace(key, Setting{"--" + key, {is_flag ? (line.flags.at(key) ? "true" : "false") : line.values.at(key)}});
    }
    return layer;
}

RunOptions readRun(const CommandLine& line, const std::string& config, const std::set<std::string>& foreign,
                   std::vector<SettingsTable>* rest) {
    Settings config_settings;
    if (!config.empty()) {
        const std::vector<SettingsTable> tables = readSettingsFile(config);
        config_settings = configLayer(config, tables, foreign);
        for (const SettingsTable& table : tables) {
            if (rest != nullptr && foreign.contains(table.name)) { rest->push_back(table); }
        }
    }
    RunOptions options = runOptions(mergeLayers(commandLineLayer(line), config_settings));
    options.config = config;
    return options;
}

// CLI11 takes "-.5,0,0" for an option but "-0.5,0,0" for a value.
std::vector<std::string> readableArguments(int count, const char* const* arguments) {
    std::vector<std::string> reversed;
    for (int i = count - 1; i > 0; --i) {
        std::string argument = arguments[i];
        const bool bare_fraction =
            argument.size() > 2 && argument[0] == '-' && argument[1] == '.' && std::isdigit(static_cast<unsigned char>(argument[2])) != 0;
        if (bare_fraction) { argument.insert(1, "0"); }
        reversed.push_back(argument);
    }
    return reversed;
}

// A motion starts from one camera, photographs have one camera each.
void requireBenchKind(const BenchOptions& bench) {
    const bool cameras = !bench.run.camera.cameras_file.empty();
    const auto refuse = [](bool wrong, const char* message) {
        if (wrong) { throw Error(ExitCode::kUsage, message); }
    };
    refuse(!bench.motion_file.empty() && !bench.photos_folder.empty(), "--motion and --photos contradict each other, must be one of them");
    refuse(!bench.photos_folder.empty() && !cameras, "--photos is given without --cameras");
    refuse(!bench.photos_folder.empty() && bench.run.camera.size_px.has_value(),
           "--photos and --size contradict each other: pictures have the photographs' size");
    refuse(!bench.motion_file.empty() && !bench.lpips_weights.empty(),
           "--motion and --lpips contradict each other: frames in motion are compared by PSNR alone");
    refuse(bench.orders && (!bench.motion_file.empty() || !bench.photos_folder.empty() || !bench.lpips_weights.empty()),
           "--orders and --motion, --photos or --lpips contradict each other: orders are compared with one of each pixel's own, by PSNR");
    refuse(bench.every != 1 && bench.motion_file.empty() && bench.photos_folder.empty(), "--every is given without --motion or --photos");
}

std::string oneLine(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return text;
}

}  // namespace

RunOptions runOptions(const Settings& settings, RunOptions options) {
    CameraOptions& camera = options.camera;
    StereoOptions& stereo = options.stereo;
    const auto read = [&](const char* key, auto&& store) {
        if (const auto found = settings.find(key); found != settings.end()) { store(found->second); }
    };
    read("eye", [&](const Setting& s) { camera.eye = readVector(s); });
    read("look", [&](const Setting& s) { camera.look = readVector(s); });
    read("up", [&](const Setting& s) { camera.up = readVector(s); });
    read("fov-x", [&](const Setting& s) { camera.fov_x_deg = readNumber(s, 0.1, 179.0); });
    read("size", [&](const Setting& s) { camera.size_px = readSize(s); });
    read("cameras", [&](const Setting& s) { camera.cameras_file = readText(s); });
    read("view",
         [&](const Setting& s) { camera.view = static_cast<std::uint32_t>(readCount(s, 0, std::numeric_limits<std::uint32_t>::max())); });
    read("headset", [&](const Setting& s) { camera.headset = readText(s); });
    read("near", [&](const Setting& s) { camera.near = readNumber(s, 1e-6, 1e6); });
    read("background", [&](const Setting& s) { camera.background = readColour(s); });
    read("mode", [&](const Setting& s) { stereo.mode = readChoice(s, {"mono", "two-pass", "shared", "reproject", "paper", "predicted"}); });
    read("dominant", [&](const Setting& s) { stereo.dominant = readChoice(s, {"left", "right"}) == "left" ? kLeft : kRight; });
    read("ipd", [&](const Setting& s) { stereo.ipd_m = readNumber(s, 0.0, 10.0); });
    read("center-roi", [&](const Setting& s) { stereo.center_roi = readFlag(s); });
    read("margin", [&](const Setting& s) { stereo.margin_px = static_cast<std::uint32_t>(readCount(s, 0, kMaxSide)); });
    read("budget", [&](const Setting& s) { stereo.budget = readNumber(s, 0.0, 1.0); });
    read("move-cost", [&](const Setting& s) { stereo.move_cost = static_cast<std::uint32_t>(readCount(s, 0, kMaxMoveCost)); });
    read("depth", [&](const Setting& s) { stereo.depth = readChoice(s, {"sum", "mean", "inverse"}); });
    read("order", [&](const Setting& s) { stereo.order = readChoice(s, {"depth", "distance"}); });
    read("resampling", [&](const Setting& s) { stereo.resampling = readChoice(s, {"cubic", "forward"}); });
    read("per-eye", [&](const Setting& s) { stereo.per_eye = readFlag(s); });
    read("gap-px", [&](const Setting& s) { stereo.gap_px = static_cast<std::uint32_t>(readCount(s, 0, kMaxGapPx)); });
    read("edge-samples", [&](const Setting& s) { stereo.edge_samples = static_cast<std::uint32_t>(readCount(s, 1, kMaxSide)); });
    read("edge-bounds", [&](const Setting& s) { stereo.edge_bounds = readChoice(s, {"paper", "tight"}); });
    read("hole-error", [&](const Setting& s) { stereo.hole_error = readNumber(s, 0.0, kMaxExpectedError); });
    read("newcomer-error", [&](const Setting& s) { stereo.newcomer_error = readNumber(s, 0.0, kMaxExpectedError); });
    read("lod", [&](const Setting& s) {
        options.load.lod = static_cast<std::uint32_t>(readCount(s, 0, std::numeric_limits<std::uint32_t>::max()));
    });
    read("flatten", [&](const Setting& s) { options.load.flatten = readFlag(s); });
    read("antialiased", [&](const Setting& s) { options.load.antialiased = readFlag(s); });
    read("metres-per-unit", [&](const Setting& s) { options.metres_per_unit = readPositive(s); });
    read("memory-limit", [&](const Setting& s) { options.memory_limit_mib = readCount(s, 1, kMaxMemoryMib); });
    read("device", [&](const Setting& s) { options.device = readText(s); });
    return options;
}

Options parseOptions(int argument_count, const char* const* arguments) {
    CLI::App app{"binosplat: stereo pictures of Gaussian splatting scenes", "binosplat"};
    app.require_subcommand(1);
    app.set_version_flag("--version", fmt::format("binosplat {}", kVersion));

    CommandLine render_line, bench_line, view_line, info_line, convert_line, stability_line, kernels_line;
    RenderOptions render;
    CLI::App* render_command = app.add_subcommand("render", "Render one frame and write its pictures");
    render_command->add_option("SCENE", render.scene, "file, directory or builtin:NAME")->required();
    render_command->add_option("--out", render.out, "directory for pictures and report.json")->required()->type_name("DIR");
    addCommonRows(*render_command, render_line, render.run.config);

    BenchOptions bench;
    CLI::App* bench_command = app.add_subcommand("bench", "Measure modes over scenes, splat counts and picture sizes");
    bench_command->add_option("SCENE", bench.scenes, "files, directories or builtin:NAME (default: those of the config)");
    bench_command->add_option("--out", bench.out, "directory for bench.json, bench.csv and bench.svg")->required()->type_name("DIR");
    bench_command->add_option("--motion", bench.motion_file, "head poses (CSV) to play relative to the camera")->type_name("TRACE.csv");
    bench_command->add_option("--motion-axes", bench.motion_axes, "axes of --motion: openxr (default) or unity")->type_name("AXES");
    bench_command->add_option("--photos", bench.photos_folder, "photographs of the cameras of --cameras, to compare with")
        ->type_name("DIR");
    bench_command->add_flag("--orders", bench.orders,
                            "compare the orders of splats with one that every pixel has of its own, on the CPU, and count what pops");
    std::string every;
    CLI::Option* every_option =
        bench_command->add_option("--every", every, "only every Nth pose of --motion or camera of --photos (default 1)")->type_name("N");
    CLI::Option* bench_lpips = addLpipsOption(*bench_command, bench.lpips_weights);
    addCommonRows(*bench_command, bench_line, bench.run.config);

    ViewOptions view;
    CLI::App* view_command = app.add_subcommand("view", "Show a scene in an OpenXR headset");
    view_command->add_option("SCENE", view.scene, "file, directory or builtin:NAME")->required();
    addViewRows(*view_command, view_line, view.run.config);
    CLI::Option* simulate = view_command->add_option("--simulate", view.script, "use the simulated headset, driven by SCRIPT if given");
    simulate->expected(0, 1)->type_name("[SCRIPT]");
    CLI::Option* view_out =
        view_command->add_option("--out", view.out, "where the simulated headset writes what its wearer sees")->type_name("DIR");
    std::string frames;
    CLI::Option* frames_option = view_command->add_option("--frames", frames, "stop after N frames")->type_name("N");
    view_command->add_flag("--load-first", view.load_first, "load the scene before the session starts, not meanwhile");
    view_command->add_flag("--hide-panel", view.hide_panel, "start without the panel");
    view_command->add_option("--shaders", view.shaders, "folder that the panel's Shaders button reloads from")->type_name("DIR");

    InfoOptions info;
    CLI::App* info_command = app.add_subcommand("info", "Say what a scene holds");
    info_command->add_option("SCENE", info.scene, "file, directory or builtin:NAME")->required();
    addRows(*info_command, info_line, std::span(kRunRows).first(kLoadRows), "Run");

    SceneOptions scene;
    std::string splats;
    CLI::App* scene_command = app.add_subcommand("scene", "Write a built-in scene as a 2DGS PLY file");
    scene_command->add_option("NAME", scene.name, "name of the built-in scene")->required();
    CLI::Option* splats_option =
        scene_command->add_option("--splats", splats, "how many splats (default: the scene's own number)")->type_name("N");
    scene_command->add_option("--out", scene.out, "file to write")->required()->type_name("FILE.ply");

    ConvertOptions convert;
    CLI::App* convert_command = app.add_subcommand("convert", "Write a scene as a PLY or an SPZ file");
    convert_command->add_option("SCENE", convert.scene, "file, directory or builtin:NAME")->required();
    convert_command->add_option("OUT", convert.out, "file to write, by its name: .ply or .spz")->required();
    addRows(*convert_command, convert_line, std::span(kRunRows).first(kLoadRows), "Run");

    CompareOptions compare;
    std::string pixels_per_degree;
    CLI::App* compare_command = app.add_subcommand("compare", "Say how much two pictures differ: PSNR, SSIM, FLIP and LPIPS");
    compare_command->add_option("A", compare.first, "picture: PNG, EXR, PFM, PPM (without OpenImageIO only the last two)")->required();
    compare_command->add_option("B", compare.second, "picture of the same size")->required();
    CLI::Option* compare_lpips = addLpipsOption(*compare_command, compare.lpips_weights);
    CLI::Option* degree_option =
        compare_command
            ->add_option("--pixels-per-degree", pixels_per_degree,
                         "how large FLIP takes the picture to be seen (default 67.02; bench: focal length in pixels times pi / 180)")
            ->type_name("N");
    compare_command->footer(
        "Prints a line for each score, its name and its value: psnr in dB, of R, G and B as they are stored, inf for equal\n"
        "pictures; ssim, 1 for equal pictures; flip and lpips, 0 for equal pictures. The last three clamp values to 0 to 1.");

    StabilityOptions stability;
    CLI::App* stability_command = app.add_subcommand("stability", "Hold stiff and extreme cases against the float64 twin");
    stability_command->add_option("--out", stability.out, "directory for stability.txt, stability.csv and stability.svg")
        ->required()
        ->type_name("DIR");
    addRows(*stability_command, stability_line, std::span(kRunRows).last(1), "Run");

    KernelsOptions kernels;
    CLI::App* kernels_command = app.add_subcommand("kernels", "Make every GPU kernel and say what the driver makes of it");
    kernels_command->add_option("--out", kernels.out, "directory for kernels.json")->type_name("DIR");
    addRows(*kernels_command, kernels_line, std::span(kRunRows).last(1), "Run");

    try {
        app.parse(readableArguments(argument_count, arguments));
    } catch (const CLI::CallForHelp&) {
        const auto chosen = app.get_subcommands();
        return HelpText{chosen.empty() ? app.help() : chosen.front()->help("binosplat")};
    } catch (const CLI::CallForVersion&) { return HelpText{app.version() + "\n"}; } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::kUsage, oneLine(error.what()) + " (see `binosplat --help`)");
    }

    if (render_command->parsed()) {
        render.run = readRun(render_line, render.run.config, {"view"}, nullptr);
        return render;
    }
    if (bench_command->parsed()) {
        bench.run = readRun(bench_line, bench.run.config, {"bench", "series", "methods", "views", "view"}, &bench.tables);
        if (every_option->count() > 0) { bench.every = static_cast<std::uint32_t>(readCount({"--every", {every}}, 1, 1000000)); }
        bench.motion_axes = readChoice({"--motion-axes", {bench.motion_axes}}, {"openxr", "unity"});
        if (bench_lpips->count() > 0) { bench.lpips_weights = readText({"--lpips", {bench.lpips_weights}}); }
        requireBenchKind(bench);
        return bench;
    }
    if (view_command->parsed()) {
        view.simulate = simulate->count() > 0;
        if (view_out->count() > 0 && !view.simulate) { throw Error(ExitCode::kUsage, "--out is given without --simulate"); }
        view.run = readRun(view_line, view.run.config, {"view"}, &view.tables);
        if (frames_option->count() > 0) { view.frames = readCount({"--frames", {frames}}, 1, 1000000000); }
        return view;
    }
    if (stability_command->parsed()) {
        stability.device = runOptions(commandLineLayer(stability_line)).device;
        return stability;
    }
    if (kernels_command->parsed()) {
        kernels.device = runOptions(commandLineLayer(kernels_line)).device;
        return kernels;
    }
    if (info_command->parsed()) {
        info.load = runOptions(commandLineLayer(info_line)).load;
        return info;
    }
    if (convert_command->parsed()) {
        convert.load = runOptions(commandLineLayer(convert_line)).load;
        return convert;
    }
    if (compare_command->parsed()) {
        compare.pixels_per_degree = kFlipPixelsPerDegree;
        if (degree_option->count() > 0) {
            compare.pixels_per_degree =
                readNumber({"--pixels-per-degree", {pixels_per_degree}}, kFlipLeastPixelsPerDegree, kFlipMostPixelsPerDegree);
        }
        if (compare_lpips->count() > 0) { compare.lpips_weights = readText({"--lpips", {compare.lpips_weights}}); }
        return compare;
    }
    if (splats_option->count() > 0) { scene.splats = readCount({"--splats", {splats}}, 1, std::uint64_t{1} << 31); }
    return scene;
}

}  // namespace binosplat
