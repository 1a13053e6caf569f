// The commands: their words and options, and how both are read.
#include "app/command_line/commands_table.h"

#include "app/command_line/option_documents.h"
#include "app/options/option_layers.h"
#include "app/terminal/frame_log.h"
#include "app/view/settings/preferences.h"
#include "engine/error.h"
#include "engine/files/scene_folder.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace binosplat {

namespace {

const OptionDescription kConfig{{"config", "", kRender | kBench | kView, "FILE",
                                 "TOML file with any of these options; the command line wins"},
                                "",
                                "",
                                {},
                                /*is_file*/ true};

std::vector<OptionDescription> with(std::vector<OptionDescription> options, const OptionDescription& one) {
    options.push_back(one);
    return options;
}

std::string wordOf(const Settings& line, const char* name) {
    const auto found = line.find(name);
    return found == line.end() ? "" : found->second.text();
}

// Uses the scene's own cameras.json if --view is given but no cameras file.
void addOwnCameras(Settings& line, const Settings& config) {
    const auto view = line.find("view"), scene = line.find("SCENE");
    if (view == line.end() || scene == line.end() || line.contains("cameras") || config.contains("cameras")) {
        return;
    }
    if (scene->second.items.size() != 1) { return; }
    const std::filesystem::path cameras = findCameraFile(scene->second.items.front());
    if (!cameras.empty()) { line.emplace("cameras", Setting{"--view", {cameras.string()}}); }
}

// Options from the command line, to which cameras may be added, then the config, then `standard`. Tables of
// the config that are in `foreign` are not read but go to `rest`.
RunOptions readRun(Settings& line, const std::set<std::string>& foreign, const RunOptions& standard,
                   std::vector<SettingsTable>* rest = nullptr) {
    const std::string config = wordOf(line, kConfig.text.key);
    Settings config_settings;
    if (!config.empty()) {
        const std::vector<SettingsTable> tables = readSettingsFile(config);
        config_settings = configLayer(config, tables, foreign);
        for (const SettingsTable& table : tables) {
            if (rest != nullptr && foreign.contains(table.name)) { rest->push_back(table); }
        }
    }
    addOwnCameras(line, config_settings);
    RunOptions options = runOptions(mergeLayers(line, config_settings), standard);
    options.config = config;
    return options;
}

// Defaults for consecutive frames.
RunOptions withHistory() {
    RunOptions standard;
    standard.stereo.mode = Mode::kTemporal;
    return standard;
}

// Panoramas are rendered in full, one eye or both, in an order of splats that is the same in all their faces.
void settlePanorama(RenderOptions& render, const Settings& line) {
    const bool around = render.projection == Projection::k360;
    StereoOptions& stereo = render.run.stereo;
    const Mode mode = around ? Mode::kMono : Mode::kShared;
    const char* const name = around ? "360" : "vr180";
    if (line.contains("mode") && stereo.mode != mode) {
        throw Error(ExitCode::kUsage,
                    fmt::format("--projection {} and --mode {} contradict each other: its mode is {}", name,
                                nameOf(stereo.mode), nameOf(mode)));
    }
    if (stereo.foveation_deg > 0.0) {
        throw Error(ExitCode::kUsage,
                    fmt::format("--projection {} and --foveation contradict each other", name));
    }
    stereo.mode = mode;
    if (!stereo.order) { stereo.order = Order::kDistance; }
    const glm::uvec2 size =
        render.run.camera.size_px.value_or(around ? glm::uvec2(4096, 2048) : glm::uvec2(2048));
    check(size.x == (around ? 2 : 1) * size.y, "--size is {}x{}, must be {} with --projection {}", size.x,
          size.y, around ? "twice as wide as high" : "as wide as high", name);
    render.run.camera.size_px = size;
}

Options makeRender(const Settings& given) {
    Settings line = given;
    RenderOptions render;
    render.scene = wordOf(line, "SCENE");
    render.run = readRun(line, {"view"}, line.contains("path") ? withHistory() : RunOptions());
    render = readRows(renderRows(), line, render);
    if (render.projection != Projection::kFlat) { settlePanorama(render, line); }
    const bool both_eyes = render.run.stereo.mode != Mode::kMono,
               in_one = render.video || render.projection == Projection::kVr180;
    if (both_eyes && in_one && !line.contains("layout")) { render.layout = PictureLayout::kSideBySide; }
    if (const std::optional<glm::uvec2>& size = render.run.camera.size_px; render.video && size) {
        check(size->x % 2 == 0 && size->y % 2 == 0, "--size is {}x{}, must be even with --video", size->x,
              size->y);
    }
    if (render.video && both_eyes && render.layout == PictureLayout::kSeparate) {
        throw Error(
            ExitCode::kUsage,
            "--video and --layout separate contradict each other: a film has both eyes in one picture");
    }
    if (render.layout != PictureLayout::kSeparate && render.run.stereo.mode == Mode::kMono) {
        throw Error(ExitCode::kUsage, "--layout and --mode mono contradict each other: there is one eye");
    }
    for (const char* key : {"path-axes", "from", "seconds", "rate", "video", "resume"}) {
        if (line.contains(key) && render.path.empty()) {
            throw Error(ExitCode::kUsage, fmt::format("--{} is given without --path", key));
        }
    }
    return render;
}

// Refuses options that do not fit the kind of bench: a motion starts from one camera, photographs have one
// camera each.
void requireBenchKind(const BenchOptions& bench) {
    const bool cameras = !bench.run.camera.cameras_file.empty();
    const auto refuse = [](bool wrong, const char* message) {
        if (wrong) { throw Error(ExitCode::kUsage, message); }
    };
    refuse(!bench.motion_file.empty() && !bench.photos_folder.empty(),
           "--motion and --photos contradict each other: give one of them");
    refuse(!bench.photos_folder.empty() && !cameras, "--photos is given without --cameras");
    refuse(!bench.photos_folder.empty() && bench.run.camera.size_px.has_value(),
           "--photos and --size contradict each other: pictures have the photographs' size");
    refuse(!bench.motion_file.empty() && !bench.lpips_weights.empty(),
           "--motion and --lpips contradict each other: frames in motion are compared by PSNR alone");
    refuse(bench.orders &&
               (!bench.motion_file.empty() || !bench.photos_folder.empty() || !bench.lpips_weights.empty()),
           "--orders and --motion, --photos or --lpips contradict each other: orders are compared with each "
           "pixel's own order, by PSNR");
    const bool measures_speed = bench.motion_file.empty() && bench.photos_folder.empty() && !bench.orders;
    refuse(bench.repeats != 0 && !measures_speed,
           "--repeats and --motion, --photos or --orders contradict each other");
    refuse(bench.every != 1 && bench.motion_file.empty() && bench.photos_folder.empty(),
           "--every is given without --motion or --photos");
}

Options makeBench(const Settings& given) {
    Settings line = given;
    BenchOptions bench;
    if (const auto scenes = line.find("SCENE"); scenes != line.end()) { bench.scenes = scenes->second.items; }
    bench.run = readRun(line, {"bench", "series", "methods", "views", "view"}, {}, &bench.tables);
    bench.asked = runOptions(line).camera;
    bench = readRows(benchRows(), line, bench);
    requireBenchKind(bench);
    for (const char* key : {"motion-axes", "from", "seconds", "rate", "frame-time"}) {
        if (line.contains(key) && bench.motion_file.empty()) {
            throw Error(ExitCode::kUsage, fmt::format("--{} is given without --motion", key));
        }
    }
    return bench;
}

// What was set on the panel in earlier runs. A broken file must not keep the viewer from starting.
void readOwnPreferences(RunOptions& standard, std::vector<SettingsTable>& view) {
    const std::filesystem::path file = preferencesFile();
    std::error_code ignored;
    if (file.empty() || !std::filesystem::exists(file, ignored)) { return; }
    try {
        std::vector<SettingsTable> tables = readSettingsFile(file);
        static_cast<void>(readPreferences(tables));  // checks them
        standard.stereo = runOptions(configLayer(file, tables, {"view"}), standard).stereo;
        std::erase_if(tables, [](const SettingsTable& table) { return table.name != "view"; });
        view = std::move(tables);
    } catch (const Error& error) {
        FrameLog::print(fmt::format("{}; preferences are not used", error.what()));
    }
}

Options makeView(const Settings& given) {
    Settings line = given;
    ViewOptions view;
    view.scene = wordOf(line, "SCENE");
    view.simulate = line.contains("simulate");
    if (view.scene.empty()) {
        view.scene = "builtin:atelier";
        view.browse = true;
    }
    for (const char* other : {"headset-only", "simulate"}) {
        if (!line.contains("desktop") || !line.contains(other)) { continue; }
        throw Error(ExitCode::kUsage, fmt::format("--desktop and --{} contradict each other", other));
    }
    if (line.contains("out") && !view.simulate) {
        throw Error(ExitCode::kUsage, "--out is given without --simulate");
    }
    RunOptions standard = withHistory();
    standard.stereo.half_periphery = true;
    standard.stereo.axes = Axes::kStay;
    // Simulated runs must be the same everywhere.
    if (!view.simulate) { readOwnPreferences(standard, view.tables); }
    view.run = readRun(line, {"view"}, standard, &view.tables);
    return readRows(viewRows(), line, view);
}

Options makeInfo(const Settings& line) { return InfoOptions{wordOf(line, "SCENE"), runOptions(line).load}; }

Options makeScene(const Settings& line) {
    return readRows(sceneRows(), line, SceneOptions{.name = wordOf(line, "NAME"), .out = {}});
}

Options makeConvert(const Settings& line) {
    const RunOptions run = runOptions(line);
    const auto convert = readRows(convertRows(), line,
                                  ConvertOptions{wordOf(line, "SCENE"),
                                                 run.load,
                                                 wordOf(line, "OUT"),
                                                 {},
                                                 {},
                                                 run.camera.cameras_file,
                                                 run.device});
    for (const char* key : {"cameras", "device"}) {
        if (line.contains(key) && !convert.keep && !convert.isStreamed()) {
            throw Error(ExitCode::kUsage, fmt::format("--{} is given without --keep", key));
        }
    }
    for (const char* key : {"levels", "chunk-splats"}) {
        if (line.contains(key) && !convert.isStreamed()) {
            throw Error(ExitCode::kUsage, fmt::format("--{} is given, but OUT is not a lod-meta.json", key));
        }
    }
    if (convert.keep && convert.keep->unit == Keep::kBytes && convert.isStreamed()) {
        throw Error(ExitCode::kUsage,
                    "--keep is a size, but OUT is a folder: must be a share or a number of splats");
    }
    return convert;
}

Options makeCompare(const Settings& line) {
    return readRows(
        compareRows(), line,
        CompareOptions{.first = wordOf(line, "A"), .second = wordOf(line, "B"), .lpips_weights = {}});
}

Options makeStability(const Settings& line) {
    return readRows(stabilityRows(), line, StabilityOptions{{}, runOptions(line).device});
}

Options makeKernels(const Settings& line) {
    return readRows(kernelsRows(), line, KernelsOptions{{}, runOptions(line).device, {}});
}

Options makeDocument(const Settings& line) { return HelpText{documentOf(wordOf(line, "KIND"))}; }

constexpr const char* kCompareFooter =
    "Prints one `name value` per line. psnr: dB over the stored R, G, B values; inf if the pictures are "
    "equal.\nssim: 1 if they are equal. flip and lpips: 0 if they are equal. The last three clamp values to "
    "between 0 and 1.\nFor the frames of two paths: pictures (how many), psnr, psnr_least (of the worst "
    "one), and change: how much\nA changes from frame to frame, divided by how much B does.";

}  // namespace

std::span<const Command> commands() {
    const Word scene{"SCENE", "file, directory, builtin:NAME, or http or https address"};
    static const std::vector<Command> rows{
        {"render",
         kRender,
         "Render one frame, or one for each pose of a path, and save the pictures",
         {scene},
         with(describe(renderRows()), kConfig),
         makeRender},
        {"bench",
         kBench,
         "Measure modes over scenes, splat counts and picture sizes",
         {{"SCENE", "files, directories, builtin:NAME, or addresses (default: those of the config)",
           /*required*/ false, /*many*/ true}},
         with(describe(benchRows()), kConfig),
         makeBench},
        {"view",
         kView,
         "Show a scene in an OpenXR headset or, without one, in a window",
         {{"SCENE",
           "file, directory, builtin:NAME, or http or https address (default: a list to choose from)",
           /*required*/ false}},
         with(describe(viewRows()), kConfig),
         makeView},
        {"info", kInfo, "Print what a scene contains", {scene}, {}, makeInfo},
        {"scene",
         kScene,
         "Write a built-in scene as a 2DGS PLY file",
         {{"NAME", "name of the built-in scene"}},
         describe(sceneRows()),
         makeScene},
        {"convert",
         kConvert,
         "Write a scene as a PLY, an SPZ or a SOG file, or with levels of detail as streamed SOG",
         {scene,
          {"OUT", "file to write; its name chooses the format: .ply, .spz, .sog, or FOLDER/lod-meta.json"}},
         describe(convertRows()),
         makeConvert},
        {"compare",
         kCompare,
         "Compare two pictures, or the frames of two paths: PSNR, SSIM, FLIP and LPIPS",
         {{"A",
           "picture: PNG, EXR, PFM or PPM (without OpenImageIO only the last two), or a folder of frames "
           "from render --path"},
          {"B", "picture of the same size, or folder of frames with the same names"}},
         describe(compareRows()),
         makeCompare,
         kCompareFooter},
        {"stability",
         kStability,
         "Render extreme cases and compare them with the float64 renderer on the CPU",
         {},
         describe(stabilityRows()),
         makeStability},
        {"kernels",
         kKernels,
         "Compile every GPU kernel and print the driver's statistics",
         {},
         describe(kernelsRows()),
         makeKernels},
        {"document",
         CommandBit{},
         "Print the list of options: markdown, config, man, bash, zsh or fish",
         {{"KIND", "markdown, config, man, bash, zsh or fish"}},
         {},
         makeDocument,
         "",
         /*hidden*/ true},
    };
    return rows;
}

std::vector<std::reference_wrapper<const Command>> shownCommands() {
    std::vector<std::reference_wrapper<const Command>> shown;
    std::ranges::copy_if(commands(), std::back_inserter(shown),
                         [](const Command& command) { return !command.hidden; });
    return shown;
}

std::vector<OptionDescription> optionsOf(const Command& command) {
    std::vector<OptionDescription> options = command.own;
    for (const OptionRow<RunOptions>& row : runRows()) {
        if ((row.text.commands & command.bit) != 0) { options.push_back(describe(row)); }
    }
    return options;
}

}  // namespace binosplat
