// Facts about options: what overrides what, what is refused, and the documents.
#include "app/command_line/option_documents.h"
#include "app/options/camera_options.h"
#include "app/options/modes.h"
#include "app/options/option_table.h"
#include "app/view/settings/view_settings_table.h"
#include "engine/setup/output_files.h"
#include "tests/app/options/parsed.h"
#include "tests/run_program.h"

#include <regex>

SUITE(options) {

const fs::path kSource = BINOSPLAT_SOURCE_DIR;

RunOptions view(const std::string& options) { return parse<ViewOptions>("view a " + options).run; }

void checkRefused(const std::string& line, ExitCode code, const std::string& part) {
    const Outcome outcome = tried([&] {
        parseLine(line);
        return std::string("is taken");
    });
    INFO(line, ": ", outcome.output, outcome.errors);
    CHECK(these(outcome.exit_code, contains(outcome.errors, part)) == these(static_cast<int>(code), true));
}

// The settings that a command line gives: one key and value per line.
std::string describe(const Options& options) {
    std::string text;
    const auto addRows = [&](const RunOptions& run) {
        for (const OptionRow<RunOptions>& row : runRows()) {
            text += fmt::format("{} {}\n", row.text.key, textOf(row.field.value(run)));
        }
        text += fmt::format("most-splats {}\n", run.load.most_splats);
    };
    const auto add = [&](const auto& command) {
        using Command = std::remove_cvref_t<decltype(command)>;
        if constexpr (std::is_same_v<Command, ViewOptions>) {
            text += fmt::format("scene {}\nbrowse {}\n", command.scene, command.browse);
        }
        if constexpr (requires { command.run; }) {
            addRows(command.run);
        } else if constexpr (requires { command.load; }) {
            RunOptions run;
            run.load = command.load;
            addRows(run);
        }
    };
    std::visit(add, options);
    return text;
}

// `> cameras FILE OPTIONS` also reads a file of cameras.
SCRIPT(options, "app/options/options") {
    const Workplace work;
    const auto run = [&](const std::string& line, const std::string&) {
        return tried([&]() -> std::string {
            if (!line.starts_with("cameras ")) { return describe(parseLine(line)); }
            readCameraFiles(renderOptions("--cameras " + (work.path / line.substr(8)).string()).camera);
            return "";
        });
    };
    ScriptHost host{run, work.path};
    host.names = {{"WORK", work.path.string()}, {"SOURCE", kSource.string()}, {"RENDER", kRenderOne}};
    runScript(host);
}

TEST_CASE_FIXTURE(AtWork, "a file whose name has spaces and letters of any language is viewed") {
    const std::string file = (work.path / "Größe 日本.ply").string();
    work.write("Größe 日本.ply", "not looked into");
    const auto viewed = std::get<ViewOptions>(parseWords({file, "--frames", "3", "--mode", "mono"}));
    CHECK(these(viewed.scene, viewed.frames) == these(file, 3));
}

TEST_CASE("a number beyond its range, and a word that is none of a few, are refused with what is taken") {
    const auto checkRows = [](const std::string& command, const auto& rows) {
        for (const auto& row : rows) {
            const bool needs_cameras = std::string_view(row.text.key) == "view";
            const std::string option =
                fmt::format("{}{} --{}=", command, needs_cameras ? " --cameras c" : "", row.text.key);
            const auto refuse = [&](const std::string& value, const std::string& expected) {
                checkRefused(option + value, ExitCode::kBadInput,
                             fmt::format("--{} is {}, must be {}", row.text.key, value, expected));
            };
            if (row.field.least) {
                const double least = *row.field.least, most = *row.field.most;
                for (const double value : {least - 1.0, most + 1.0, std::nan(""), HUGE_VAL}) {
                    refuse(fmt::format("{}", value), "a ");
                }
                CHECK_THROWS_WITH_AS(parseLine(option + "1x"),
                                     doctest::Contains(fmt::format("number from {}", least).c_str()), Error);
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
            CHECK(textOf(row.field.value(renderOptions(fmt::format("--{} {}", row.text.key, choice)))) ==
                  choice);
        }
    }
}

TEST_CASE("a text that is empty, a camera that spans no view and a headset that is nobody's are refused") {
    CHECK_THROWS_WITH_AS(parseWords({"compare", "a", "b", "--lpips", ""}),
                         "--lpips is empty, must be one text that is not empty", Error);
    for (const char* options : {"--eye 0,0,0 --look 0,0,0", "--up 0,0,1 --eye 0,0,0 --look 0,0,1"}) {
        CHECK_THROWS_WITH_AS(makeCameras(renderOptions(options), {}, makeBox("box.ply")),
                             doctest::Contains("span a view"), Error);
    }
    CHECK_THROWS_WITH_AS(readCameraFiles(renderOptions("--headset nobody").camera),
                         doctest::Contains("nobody.toml: not found"), Error);
}

TEST_CASE_FIXTURE(AtWork, "the documents of the options are the program's, and every default key is taken") {
    CHECK_MESSAGE(textIn(kSource / "docs/options.md") == documentOf("markdown"),
                  "run `binosplat document markdown > docs/options.md`");
    const std::string text = textIn(kSource / "configs/default.toml");
    CHECK_MESSAGE(text == documentOf("config"), "run `binosplat document config > configs/default.toml`");
    // The file has every key, as a comment if it has no default; uncommented, each is accepted.
    const std::string one = (work.path / "one.toml").string();
    std::size_t keys = 0;
    std::string table, placement;
    for (std::string line : linesIn(text)) {
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
        if (line.starts_with("mode ") || !options.tables.empty()) {
            CHECK(is_comment == line.starts_with("mode "));
        }
    }
    CHECK(keys == runRows().size() + viewSettingsRows().size() + 3);
    writeText(one, "[view]\n" + placement);
    CHECK(readViewSettings(parse<ViewOptions>("view a --config " + one).tables, {})
              .scene_from_room.has_value());
    CHECK(contains(text, "\n# mode = \"predicted\""));
    // The values in the file are the defaults.
    const RunOptions none = renderOptions(""),
                     file = renderOptions("--config " + (kSource / "configs/default.toml").string());
    CHECK(these(file.camera.near, file.camera.background, file.stereo, file.metres_per_unit) ==
          these(none.camera.near, none.camera.background, none.stereo, none.metres_per_unit));
    CHECK_FALSE(none.camera.near);  // depends on the size of the scene
    CHECK(none.stereo.mode == Mode::kPredicted);
}

TEST_CASE_FIXTURE(AtWork, "splats go by depth or distance, as the options, the config or the scene say") {
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
    CHECK(these(orderOf("", Order::kDistance), orderOf(file, Order::kDepth),
                orderOf("--order depth", Order::kDistance)) ==
          these(Order::kDistance, Order::kDistance, Order::kDepth));
    CHECK(orderOf(file + " --order depth", Order::kDistance) == Order::kDepth);
    CHECK(view("--order distance").stereo.order == Order::kDistance);
    CHECK(parse<BenchOptions>("bench a --out b --orders").orders);
}

TEST_CASE("the help of view has its own rows and those it shares, and none that only other commands have") {
    std::map<std::string, bool> is_of_view;
    const auto addRows = [&](const auto&... tables) {
        const auto add = [&](const auto& row) {
            is_of_view[row.text.key] |= (row.text.commands & kView) != 0;
        };
        (std::ranges::for_each(tables, add), ...);
    };
    addRows(viewRows());
    const std::size_t own = is_of_view.size();
    addRows(runRows(), renderRows(), benchRows(), sceneRows(), convertRows(), compareRows());
    CHECK(own >= 5);
    const std::string help = std::get<HelpText>(parseLine("view --help")).text;
    std::size_t others = 0;
    for (const auto& [key, is_shown] : is_of_view) {
        CHECK_MESSAGE(std::regex_search(help, std::regex("\n *--" + key + "\\b(?!-)")) == is_shown, key);
        others += is_shown ? 0 : 1;
    }
    CHECK(others > 20);
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
        CHECK(these(refusal(half + " --foveation 20").empty(), refusal(half).empty()) == these(true, false));
    }
    CHECK(view("").stereo.half_periphery);
    CHECK(view("").stereo.axes == Axes::kStay);
    CHECK(view("--axes view").stereo.axes == Axes::kView);
    CHECK_FALSE(view("--periphery full").stereo.half_periphery);
    CHECK(view("--foveation 20").stereo.foveation_deg == 20.0);
}

}  // SUITE(options)
