// Facts about options: the command line over the config, what of both is refused, and the documents.
#include "app/command_line/option_documents.h"
#include "app/options/camera_options.h"
#include "app/options/modes.h"
#include "app/options/option_table.h"
#include "app/view/settings/view_settings_table.h"
#include "engine/setup/output_files.h"
#include "tests/app/options/parsed.h"
#include "tests/run_program.h"

SUITE(options) {

const fs::path kSource = BINOSPLAT_SOURCE_DIR;

RunOptions view(const std::string& options) { return parse<ViewOptions>("view a " + options).run; }

void checkRefused(const std::string& line, ExitCode code, const std::string& part) {
    INFO("line ", line, ", part ", part);
    try {
        parseLine(line);
        FAIL_CHECK("is taken");
    } catch (const Error& error) {
        CHECK(error.code() == code);
        CHECK_MESSAGE(std::string(error.what()).find(part) != std::string::npos, error.what());
    }
}

TEST_CASE_FIXTURE(AtWork, "a scene in the place of a command is viewed, any other word is a usage error") {
    const std::string file = (work.path / "Größe 日本.ply").string();
    work.write("Größe 日本.ply", "not looked into");
    const auto viewed = std::get<ViewOptions>(parseWords({file, "--frames", "3", "--mode", "mono"}));
    CHECK(these(viewed.scene, viewed.frames) == these(file, 3));
    CHECK(parse<ViewOptions>(work.path.string()).scene == work.path.string());
    CHECK(parse<ViewOptions>("").browse);
    CHECK(parse<ViewOptions>("builtin:no-such-scene").scene == "builtin:no-such-scene");
    checkRefused("rendre", ExitCode::kUsage, "rendre is not a command; must be one of: render, bench, view, info, scene, convert, compare");
    for (const char* gone : {"gone.ply", "gone/", "a/gone", "gone.ply --frames 3"}) {
        checkRefused(gone, ExitCode::kBadInput, "no such file, must be a scene to view, or a command");
    }
    checkRefused("builtin:fence gone.ply", ExitCode::kUsage, "builtin:fence and gone.ply are two scenes, must be one to view at a time");
    for (const char* line :
         {"https://me:secret@server/a.ply", "info https://me:secret@server/a.ply", "bench a https://me:secret@server/a.ply --bogus"}) {
        checkRefused(line, ExitCode::kBadInput, "https://...@server/a.ply: names a user");
    }
}

TEST_CASE("a command line that is not understood is a usage error, which names what is wrong") {
    for (const auto& [line, part] : std::vector<std::pair<std::string, std::string>>{
             {"view --desktop --headset-only", "--desktop and --headset-only contradict each other"},
             {"render", "SCENE"},
             {"render builtin:one-splat", "--out"},
             {kRenderOne + "--bogus", "--bogus"},
             {kRenderOne + "--near", "--near"},
             {kRenderOne + "--view 1", "--view is given without --cameras"},
             {kRenderOne + "--headset quest2 --fov-x 60", "--headset and --fov-x"},
             {kRenderOne + "--cameras c.json --eye 0,0,0", "--cameras and --eye"},
             {kRenderOne + "--rate 5", "--rate is given without --path"},
             {kRenderOne + "--from 1", "--from is given without --path"},
             {kRenderOne + "--seconds 1", "--seconds is given without --path"},
             {kRenderOne + "--path-axes unity", "--path-axes is given without --path"},
             {"bench a --out out --photos p", "--cameras"},
             {"bench a --out out --every 2", "--motion or --photos"},
             {"bench a --out out --rate 40", "--rate is given without --motion"},
             {"bench a --out out --orders --motion m.csv", "--orders and --motion"},
             {"bench a --out out --motion m.csv --lpips w.bin", "--motion and --lpips"},
             {"bench a --out out --motion m.csv --cameras c.json --photos p", "--motion and --photos"},
             {"view a --view 1", "--view is given without --cameras"},
             {"view a --gaze 0,0,1", "--gaze"},
             {"view a --out out", "--out is given without --simulate"},
             {"stability", "--out"},
             {"convert a", "OUT"},
             {"compare", "A is required"},
             {"compare a", "B is required"},
             {"compare a b c", "c"},
             {"compare a b --lpips", "--lpips"},
             {"document page", "page"}}) {
        checkRefused(line, ExitCode::kUsage, part);
    }
}

TEST_CASE("a number beyond its range, and a word that is none of a few, are refused with what is taken") {
    const auto checkRows = [](const std::string& command, const auto& rows) {
        for (const auto& row : rows) {
            const bool needs_cameras = std::string_view(row.text.key) == "view";
            const std::string option = fmt::format("{}{} --{}=", command, needs_cameras ? " --cameras c" : "", row.text.key);
            const auto refuse = [&](const std::string& value, const std::string& expected) {
                checkRefused(option + value, ExitCode::kBadInput, fmt::format("--{} is {}, must be {}", row.text.key, value, expected));
            };
            if (row.field.least) {
                const double least = *row.field.least, most = *row.field.most;
                for (const double value : {least - 1.0, most + 1.0, std::nan(""), HUGE_VAL}) { refuse(fmt::format("{}", value), "a "); }
                CHECK_THROWS_WITH_AS(parseLine(option + "1x"), doctest::Contains(fmt::format("number from {}", least).c_str()), Error);
            }
            if (!row.field.choices.empty()) { refuse("nonsense", std::string(row.field.choices.front())); }
        }
    };
    checkRows("render a --out out", runRows());
    checkRows("render a --out out", renderRows());
    checkRows("bench a --out out", benchRows());
    checkRows("view a", viewRows());
    checkRows("scene a --out out", sceneRows());
    checkRows("compare a b", compareRows());
    for (const OptionRow<RunOptions>& row : runRows()) {
        for (const std::string_view choice : row.field.choices) {
            CHECK(textOf(row.field.value(renderOptions(fmt::format("--{} {}", row.text.key, choice)))) == choice);
        }
    }
}

TEST_CASE("other values that are none say what they must be") {
    for (const char* size : {"0x0", "70000x70000", "16385x1", "0x16", "-1x5", "0", "12x", "axb", "1x2x3", "99999999999999999999x1"}) {
        checkRefused(kRenderOne + "--size=" + size, ExitCode::kBadInput,
                     fmt::format("--size is {}, must be WIDTHxHEIGHT with 1 to 16384 pixels per side", size));
    }
    CHECK(renderOptions("--size 24").camera.size_px == glm::uvec2(24));
    CHECK(these(renderOptions("--budget 20%").stereo.warp.budget, renderOptions("--budget 100%").stereo.warp.budget) == these(0.2, 1.0));
    for (const char* share : {"120%", "-1%", "20%%", "%", "1.5"}) {
        checkRefused(fmt::format("{}--budget={}", kRenderOne, share), ExitCode::kBadInput,
                     "must be a number from 0 to 1, or from 0% to 100%");
    }
    for (const char* crop : {"0,0,0", "0,0,0,0", "0,0,0,-1", "0,0,nan,1", "0,0,0,inf", "0,0,0,1,2", ","}) {
        checkRefused(fmt::format("convert a b.ply --crop={}", crop), ExitCode::kBadInput, "must be four finite numbers x,y,z,r");
    }
    for (const auto& [options, part] :
         std::vector<std::pair<const char*, const char*>>{{"--eye 1,2", "--eye is 1,2, must be three finite numbers"},
                                                          {"--eye 1,2,nan", "three finite numbers"},
                                                          {"--eye 1,2,3,4", "three finite numbers"},
                                                          {"--background 0,0,2", "--background is 0,0,2"},
                                                          {"--gaze 0,0,0", "--gaze is 0,0,0, must be a direction x,y,z, not 0,0,0"},
                                                          {"--gap-px 1.5", "--gap-px is 1.5, must be a whole number from 0 to 64"},
                                                          {"--lod 0.5", "--lod is 0.5, must be a whole number"},
                                                          {"--center-roi=often", "--center-roi is often, must be true or false"}}) {
        checkRefused(kRenderOne + options, ExitCode::kBadInput, part);
    }
    CHECK_THROWS_WITH_AS(parseWords({"compare", "a", "b", "--lpips", ""}), "--lpips is empty, must be one text that is not empty", Error);
    for (const char* options : {"--eye 0,0,0 --look 0,0,0", "--up 0,0,1 --eye 0,0,0 --look 0,0,1"}) {
        CHECK_THROWS_WITH_AS(makeCameras(renderOptions(options), {}, makeBox("box.ply")), doctest::Contains("span a view"), Error);
    }
    CHECK_THROWS_WITH_AS(readCameraFiles(renderOptions("--headset nobody").camera), doctest::Contains("nobody.toml: not found"), Error);
}

TEST_CASE("values may begin with a minus, and a flag may be switched off by what stands after its =") {
    CHECK(renderOptions("--eye -1,0,0").camera.eye == glm::dvec3(-1.0, 0.0, 0.0));
    CHECK(renderOptions("--eye -.5,0,1e-3").camera.eye == glm::dvec3(-0.5, 0.0, 1e-3));
    CHECK(renderOptions("--eye=-1,-2,-3").camera.eye == glm::dvec3(-1.0, -2.0, -3.0));
    CHECK(renderOptions("--center-roi").stereo.warp.center_rois);
    CHECK_FALSE(renderOptions("--center-roi=false").stereo.warp.center_rois);
}

TEST_CASE_FIXTURE(AtWork, "errors in a config name file and line") {
    const std::string file = (work.path / "a.toml").string();
    for (const auto& [text, part] : std::vector<std::pair<const char*, const char*>>{
             {"[camera]\n\nnear = 0\n", "a.toml:3: near is 0, must be a number from 1e-06 to 1000000"},
             {"size = \"0x5\"\n", "a.toml:1: size is 0x5, must be WIDTHxHEIGHT with 1 to 16384"},
             {"[camera]\neye = [1, 2]\n", "a.toml:2: eye is 1,2, must be three"},
             {"[stereo]\nmargin = -1\n", "a.toml:2: margin is -1"},
             {"[stereo]\ncenter-roi = 1\n", "a.toml:2: center-roi is 1, must be true or false"},
             {"[stereo]\ngap_px = 1.5\n", "a.toml:2: gap_px is 1.5, must be a whole number from 0 to 64"},
             {"[stereo]\nedge_bounds = 3\n", "a.toml:2: edge_bounds is 3, must be paper or tight"},
             {"[stereo]\nmargins = 1\n", "a.toml:2: margins is not a known key"},
             {"[stereo]\nnear = 1\n", "a.toml:2: near is in [stereo], must be in [camera]"},
             {"[stereoo]\nmargin = 1\n", "a.toml:1: [stereoo] is not a known table"},
             {"near = 1\n[camera]\nnear = 2\n", "near is set twice"},
             {"[camera]\nnear = \n", "a.toml:2: "},
             {"[camera]\nheadset = \"quest2\"\nfov_x = 60\n", "contradict"}}) {
        work.write("a.toml", text);
        checkRefused(kRenderOne + "--config " + file, ExitCode::kBadInput, part);
    }
    checkRefused(kRenderOne + "--config none.toml", ExitCode::kBadInput, "none.toml");
}

TEST_CASE_FIXTURE(AtWork, "errors in a file of cameras name the camera and the key") {
    const std::string file = (work.path / "c.json").string();
    const auto errorWith = [&](const std::string& text, const std::string& options = "") {
        work.write("c.json", text);
        return errorOf([&] { readCameraFiles(renderOptions("--cameras " + file + options).camera); });
    };
    const std::string start = R"([{"width": 8, "height": 8, "fx": 8, "fy": 8, "position": [0,0,0], "rotation": )";
    for (const auto& [text, part] :
         std::vector<std::pair<std::string, std::string>>{{"[{", "c.json: byte"},
                                                          {"{}", "c.json: holds no cameras"},
                                                          {"[]", "c.json: holds no cameras"},
                                                          {"[3]", "c.json: camera 0"},
                                                          {R"([{"width": 8}])", "c.json: camera 0: height is missing"},
                                                          {start + "[[1,0,0],[0,1,0]]}]", "rotation"},
                                                          {start + "[[1,0,0],[0,1,0],[0,0,-1]]}]", "must be a rotation"},
                                                          {start + "[[2,0,0],[0,1,0],[0,0,1]]}]", "must be a rotation"}}) {
        CHECK_MESSAGE(errorWith(text).find(part) != std::string::npos, text);
    }
    const std::string good = start + "[[1,0,0],[0,1,0],[0,0,1]]}]";
    CHECK(errorWith(good).empty());
    CHECK(errorWith(good, " --view 1").find("--view is 1, must be 0 to 0") != std::string::npos);
}

TEST_CASE_FIXTURE(AtWork, "the documents of the options are those that the program makes, and every key of the default config is taken") {
    CHECK_MESSAGE(textIn(kSource / "docs/options.md") == documentOf("markdown"), "run `binosplat document markdown > docs/options.md`");
    const std::string text = textIn(kSource / "configs/default.toml");
    CHECK_MESSAGE(text == documentOf("config"), "run `binosplat document config > configs/default.toml`");
    // Every key of a config is there, those without a default as comments; whoever takes out the mark has a key that is taken.
    const std::string one = (work.path / "one.toml").string();
    std::size_t keys = 0;
    std::istringstream lines(text);
    std::string table, placement;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with('[')) { table = line.substr(0, line.find(']') + 1); }
        const bool is_comment = line.starts_with("# ");
        if (table.empty() || line.starts_with('[') || line.empty()) { continue; }
        ++keys;
        CAPTURE(line);
        line = line.substr(is_comment ? 2 : 0);
        if (table == "[view]" && (line.starts_with("scene-") || line.starts_with("units-"))) {
            placement += line + "\n";
            continue;
        }
        writeText(one, table + "\n" + line + "\n");
        const auto options = parse<ViewOptions>("view a --config " + one);
        CHECK_NOTHROW(readViewSettings(options.tables, {}));
        CHECK(options.tables.empty() == (table != "[view]"));
        if (line.starts_with("mode ") || !options.tables.empty()) { CHECK(is_comment == line.starts_with("mode ")); }
    }
    CHECK(keys == runRows().size() + viewSettingsRows().size() + 3);
    writeText(one, "[view]\n" + placement);
    CHECK(readViewSettings(parse<ViewOptions>("view a --config " + one).tables, {}).scene_from_room.has_value());
    CHECK(text.find("\n# mode = \"predicted\"") != std::string::npos);
    // It says the defaults.
    const RunOptions none = renderOptions(""), file = renderOptions("--config " + (kSource / "configs/default.toml").string());
    CHECK(these(file.camera.near, file.camera.background, file.stereo, file.metres_per_unit) ==
          these(none.camera.near, none.camera.background, none.stereo, none.metres_per_unit));
    CHECK_FALSE(none.camera.near);  // by the size of the scene
    CHECK(none.stereo.mode == Mode::kPredicted);
}

TEST_CASE("bash is told of files for the options that take one, of names for those that are one of a few, and of nothing for others") {
    const std::string bash = documentOf("bash"), files = "COMPREPLY=($(compgen -f -- \"$word\"));";
    const auto names = [](const char* choices) { return fmt::format("COMPREPLY=($(compgen -W \"{}\" -- \"$word\"));", choices); };
    std::map<std::string, std::string> expected{{"render:--path-axes", names("openxr unity")}, {"view:--dominant", names("left right")}};
    for (const std::string& option : wordsIn("render:--path render:--out render:--cameras bench:--motion bench:--photos compare:--lpips "
                                             "scene:--out view:--config view:--shaders view:--simulate")) {
        expected[option] = files;
    }
    for (const char* option : {"render:--rate", "render:--headset"}) { expected[option] = ""; }
    for (const auto& [option, completed] : expected) {
        CHECK_MESSAGE(bash.find(fmt::format("        {}) {} return ;;\n", option, completed)) != std::string::npos, option);
    }
}

TEST_CASE_FIXTURE(AtWork, "frames that follow one another are temporal unless a mode is named, and the command line wins over the config") {
    const std::string open = " --config " + (kSource / "configs/default.toml").string(),
                      named = " --config " + (work.path / "named.toml").string();
    writeText(work.path / "named.toml",
              "mode = \"paper\"\nnear = 0.5\n[camera]\nsize = \"64x32\"\nheadset = \"quest2\"\n"
              "[stereo]\ncenter-roi = true\nipd = 0.07\n");
    CHECK(these(renderOptions("").stereo.mode, renderOptions("--path b.csv").stereo.mode) == these(Mode::kPredicted, Mode::kTemporal));
    CHECK(renderOptions("--path b.csv" + named).stereo.mode == Mode::kPaper);
    CHECK(these(view("").stereo.mode, view(open).stereo.mode, view(named).stereo.mode, view(named + " --mode predicted").stereo.mode) ==
          these(Mode::kTemporal, Mode::kTemporal, Mode::kPaper, Mode::kPredicted));
    const RunOptions from_file = renderOptions(named), both = renderOptions(named + " --near 0.1 --size 8x9 --fov-x 90 --ipd 0");
    CHECK(these(from_file.camera.near, from_file.camera.size_px, from_file.camera.headset) == these(0.5, glm::uvec2(64, 32), "quest2"));
    CHECK(from_file.stereo.warp.center_rois);
    CHECK(from_file.stereo.ipd_m == 0.07);
    CHECK(these(both.camera.near, both.camera.size_px, both.camera.fov_x_deg) == these(0.1, glm::uvec2(8, 9), 90.0));
    CHECK(both.camera.headset.empty());  // an angle and a headset contradict each other
    CHECK(both.stereo.ipd_m == 0.0);
}

TEST_CASE_FIXTURE(AtWork, "every command that reads a scene has the options of how it is read, which a config may hold, too") {
    writeText(work.path / "a.toml", "[scene]\nlod = 3\nflatten = true\nantialiased = true\nsh_degree = 1\n");
    const std::string file = "--config " + (work.path / "a.toml").string();
    CHECK(renderOptions("").load == LoadOptions());
    CHECK(parse<InfoOptions>("info a").load == LoadOptions());
    const LoadOptions expected{.lod = 3, .sh_degree = 1, .flatten = true, .antialiased = true};
    const std::string all = "--lod 3 --sh-degree 1 --flatten --antialiased";
    for (const LoadOptions& load :
         {renderOptions(file).load, renderOptions(all).load, view(all).load, parse<BenchOptions>("bench a --out b " + all).run.load,
          parse<InfoOptions>("info a " + all).load, parse<ConvertOptions>("convert a b.ply " + all).load}) {
        CHECK(load == expected);
    }
    CHECK(renderOptions(file + " --lod 0").load.lod == 0u);
    CHECK_FALSE(view("--center-roi").load.flatten);
}

TEST_CASE_FIXTURE(AtWork, "splats go by depth or by distance: as the command line says, the config, or else the scene") {
    writeText(work.path / "a.toml", "[stereo]\norder = \"distance\"\n");
    const std::string file = "--config " + (work.path / "a.toml").string();
    const auto orderOf = [](const std::string& options, Order usual) {
        return frameSettings({}, renderOptions(options).stereo, usual).order;
    };
    CHECK_FALSE(renderOptions("").stereo.order);
    CHECK(frameSettings({}, renderOptions("").stereo, Order::kDepth).order == Order::kDepth);
    StereoOptions stays;
    stays.axes = Axes::kStay;
    CHECK(frameSettings({}, stays, Order::kDepth).order == Order::kDistance);
    CHECK(these(orderOf("", Order::kDistance), orderOf(file, Order::kDepth), orderOf("--order depth", Order::kDistance)) ==
          these(Order::kDistance, Order::kDistance, Order::kDepth));
    CHECK(orderOf(file + " --order depth", Order::kDistance) == Order::kDepth);
    CHECK(view("--order distance").stereo.order == Order::kDistance);
    CHECK(parse<BenchOptions>("bench a --out b --orders").orders);
}

TEST_CASE("half the resolution goes with foveation, and the headset has it unless it is told not to") {
    const auto refusal = [](const std::string& options) {
        const StereoOptions stereo = renderOptions(options).stereo;
        CHECK(frameSettings({}, stereo, Order::kDepth).half_periphery == stereo.half_periphery);
        return errorOf([&] { requirePeriphery(stereo); });
    };
    CHECK_FALSE(renderOptions("").stereo.half_periphery);
    CHECK(renderOptions("--periphery half").stereo.half_periphery);
    CHECK(refusal("--periphery full") == "");
    for (const std::string_view mode : kModeNames) {
        const std::string half = fmt::format("--mode {} --periphery half", mode);
        CHECK(refusal(half + " --foveation 20") == "");
        CHECK(refusal(half) == "--periphery is half, but --foveation is 0, must be the angle within which resolution is full");
    }
    CHECK(view("").stereo.half_periphery);
    CHECK(view("").stereo.axes == Axes::kStay);
    CHECK(view("--axes view").stereo.axes == Axes::kView);
    CHECK_FALSE(view("--periphery full").stereo.half_periphery);
    CHECK(view("--foveation 20").stereo.foveation_deg == 20.0);
}

}  // SUITE(options)
