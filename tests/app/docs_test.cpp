// Facts about the documents: their links, options and files exist, and the program understands their
// commands.
#include "app/command_line/commands_table.h"
#include "app/command_line/option_documents.h"
#include "tests/app/document_links.h"
#include "tests/app/options/parsed.h"
#include "tests/app/program_script.h"
#include "tests/xr/simulated/installed.h"

SUITE(docs) {

const fs::path kSource = BINOSPLAT_SOURCE_DIR;

std::vector<fs::path> documents() {
    std::vector<fs::path> files = documentsIn(kSource / "docs");
    for (const char* name : {"README.md", "CONTRIBUTING.md", "CHANGELOG.md", "third_party/NOTICES.md",
                             "xr/simulated/README.md"}) {
        files.push_back(kSource / name);
    }
    return files;
}

// Options of cmake, ctest, doctest, apt-get and other programs whose commands the documents show.
const std::set<std::string> kForeignOptions{
    "--preset",    "--build",   "--install", "--config",    "--test-dir",
    "--test-case", "--target",  "--prefix",  "--component", "--output-on-failure",
    "--help",      "--version", "--success", "--pictures",  "--share",
    "--tolerance", "--ignore",  "--whole",   "--try",       "--test-suite",
    "--cflags",    "--libs"};

bool isOption(const std::string& name) {
    const auto has = [&](const Command& command) {
        return std::ranges::any_of(optionsOf(command), [&](const OptionDescription& option) {
            return name == fmt::format("--{}", option.text.key);
        });
    };
    return kForeignOptions.contains(name) || std::ranges::any_of(commands(), has);
}

// Lines of fenced blocks, and spans of inline code.
std::vector<std::string> codeLines(const std::string& text) {
    std::vector<std::string> lines;
    bool fenced = false;
    for (const std::string& line : linesIn(text)) {
        if (line.starts_with("```")) {
            fenced = !fenced;
        } else if (fenced || line.starts_with("    ")) {
            lines.push_back(line);
        } else {
            for (const std::string& span : findAll(line, "`([^`]+)`")) { lines.push_back(span); }
        }
    }
    return lines;
}

// The words of a command, up to where a shell would end it, without the brackets around optional parts.
std::vector<std::string> wordsOf(const std::string& line) {
    std::vector<std::string> words;
    for (const std::string& word : wordsIn(line)) {
        if (word == "&&" || word == "|" || word == ">" || word.starts_with('#')) { break; }
        const bool ends = word.ends_with(';') || word.ends_with(',');
        const std::size_t begin = word.find_first_not_of("[\""), end = word.find_last_not_of("];,\"");
        if (begin != std::string::npos && begin <= end) {
            words.push_back(word.substr(begin, end + 1 - begin));
        }
        if (ends) { break; }
    }
    return words;
}

// The words after "binosplat" in a line that calls it, behind a folder and variables; else none.
std::vector<std::string> callOfProgram(const std::string& line) {
    const std::vector<std::string> words = wordsOf(line);
    const auto is_variable = [](const std::string& word) {
        return std::regex_match(word, std::regex("[A-Z_]+=.*"));
    };
    const auto program = std::ranges::find_if_not(words, is_variable);
    if (program == words.end() || program + 1 == words.end() ||
        fs::path(*program).filename() != "binosplat") {
        return {};
    }
    return {program + 1, words.end()};
}

// Words that stand for others: in capitals, or a choice between names.
bool isPlaceholder(const std::string& word) {
    return std::isupper(static_cast<unsigned char>(word[0])) != 0 || word.find('|') != std::string::npos;
}

// Why `binosplat CALL` would be refused, or "". Values are checked only if no word is a placeholder.
std::string wrongCall(std::vector<std::string> call) {
    // Only mentioned, not called.
    if (call.size() == 1 && std::ranges::find(commands(), call[0], &Command::name) != commands().end()) {
        return "";
    }
    // A file in place of a command means `view`.
    if (call[0] == "FILE" || call[0].ends_with(".ply")) { call.insert(call.begin(), "view"); }
    std::erase(call, "OPTIONS");
    for (std::string& word : call) { std::ranges::replace(word, '\\', '/'); }  // Windows paths
    try {
        parseWords(call);
    } catch (const Error& error) {
        const std::string message = error.what();
        const bool lacks_cameras = message.starts_with("--view is given without"),
                   needs_files = lacks_cameras || std::ranges::any_of(call, isPlaceholder),
                   is_understood = error.code() != ExitCode::kUsage || lacks_cameras;
        return is_understood && needs_files ? "" : message;
    }
    return "";
}

SCRIPT(docs, "app/docs") { runProgramScript(); }

TEST_CASE("every library that is built with has its row in the notices, and its licence where compiled in") {
    const std::string notices = textIn(kSource / "third_party" / "NOTICES.md");
    const std::size_t licences = notices.find("\n## Licences of what is compiled in");
    REQUIRE(licences != std::string::npos);
    std::string rows;
    for (const std::string& row : findAll(notices.substr(0, licences), "\n(\\|[^\n]*)")) {
        for (const char c : row) { rows += static_cast<char>(std::tolower(static_cast<unsigned char>(c))); }
        if (!contains(row, "compiled in")) { continue; }
        const std::string link = row.substr(2, row.find(')') - 1);
        CHECK_MESSAGE(notices.find(link, licences) != std::string::npos, "no licence of " << link);
    }
    const std::vector<std::string> libraries = findAll(textIn(kSource / "third_party" / "CMakeLists.txt"),
                                                       R"(add_library\(third_party_([a-z0-9]+) )");
    CHECK(libraries.size() > 10);
    for (const std::string& library : libraries) {
        CHECK_MESSAGE(contains(rows, library), "no row of " << library);
    }
}

TEST_CASE_FIXTURE(AtWork, "fish and zsh complete what is typed") {
    if (!isInstalled("fish", "fish") || !isInstalled("zsh", "zsh")) { return; }
    work.write("complete.fish", documentOf("fish") +
                                    "for words in re 'render --mode pre' 'compare --lp' 'render --path pos'\n"
                                    "    complete -C \"binosplat $words\" | string split -f 1 \\t\nend\n");
    work.write("poses.csv", "x");
    CHECK(work.runCommand("fish --no-config complete.fish").output ==
          "render\npredicted\n--lpips\nposes.csv\n");
    // In a terminal of its own, with a key that records what a line was completed to.
    work.write("_binosplat", documentOf("zsh"));
    work.write("complete.zsh", R"(zmodload zsh/zpty
zpty shell zsh -f -i
zpty -w shell 'PS1= fpath=($PWD $fpath); autoload -Uz compinit; compinit -D -u'
zpty -w shell 'record() { zle complete-word; print -r -- "$BUFFER" >>completed; BUFFER= }'
zpty -w shell 'zle -N record; bindkey ^T record'
for words in re 'render --mode pre' 'compare --lp' 'render --path pos'; do
    zpty -n -w shell "binosplat $words"$'\C-t'
done
zpty -w shell exit
while zpty -r shell line; do :; done
)");
    const Outcome zsh = work.runCommand("timeout 60 zsh -f complete.zsh");
    CHECK(these(zsh.exit_code, zsh.errors) == these(0, ""));
    CHECK(work.bytesOf("completed") ==
          "binosplat render \nbinosplat render --mode predicted \nbinosplat compare --lpips \n"
          "binosplat render --path poses.csv \n");
}

TEST_CASE_FIXTURE(AtWork, "groff shows the man page, with every command and every option of it") {
    if (!isInstalled("groff", "groff-base")) { return; }
    work.write("page", documentOf("man"));
    const Outcome shown = work.runCommand("groff -man -Tascii -ww -P-cbou page");
    CHECK(these(shown.exit_code, shown.errors) == these(0, ""));
    std::size_t at = shown.output.find("COMMANDS");
    for (const Command& command : shownCommands()) {
        at = shown.output.find(fmt::format("\n   binosplat {}", command.name), at);
        REQUIRE_MESSAGE(at != std::string::npos, command.name);
        for (const OptionDescription& option : optionsOf(command)) {
            at = shown.output.find(fmt::format("\n       --{}", option.text.key), at);
            REQUIRE_MESSAGE(at != std::string::npos, command.name << " --" << option.text.key);
        }
    }
}

TEST_CASE_FIXTURE(AtWork, "desktops accept the program's entry, formats and description") {
    if (!isInstalled("desktop-file-validate", "desktop-file-utils") ||
        !isInstalled("appstreamcli", "appstream")) {
        return;
    }
    const std::string base = (kSource / "app" / "linux" / "org.binosplat.viewer").string();
    for (const std::string& command : {"desktop-file-validate " + base + ".desktop",
                                       "appstreamcli validate --no-net " + base + ".metainfo.xml"}) {
        const Outcome judged = work.runCommand(command);
        CHECK_MESSAGE(judged.exit_code == 0, command << ": " << judged.output << judged.errors);
    }
    std::string opened;  // in the order of the desktop entry
    for (const std::string& type :
         findAll(textIn(base + ".metainfo.xml"), "<mediatype>([^<]+)</mediatype>")) {
        opened += type + ";";
    }
    CHECK(findAll(textIn(base + ".desktop"), "MimeType=(.*)\n") == std::vector<std::string>{opened});
    // What a double click runs: one word for the file, whatever its name.
    const std::vector<std::string> started = findAll(textIn(base + ".desktop"), "\nExec=(.*)\n");
    REQUIRE(started.size() == 1);
    std::vector<std::string> call = wordsIn(started[0]);
    CHECK(call.at(0) == "binosplat");
    call.erase(call.begin());
    CHECK(std::ranges::count(call, "%f") == 1);
    const std::string name = "/home/a b/my scene.ply";
    std::ranges::replace(call, std::string("%f"), name);
    CHECK(std::get<ViewOptions>(parseWords(call)).scene == name);
    for (const std::string& type : findAll(textIn(base + ".xml"), "mime-type type=\"([^\"]+)\"")) {
        CHECK_MESSAGE(contains(opened, type + ";"), type);
    }
    // Once the formats are installed, files have these types, so that a double click opens the program.
    if (!isInstalled("update-mime-database", "shared-mime-info") || !isInstalled("gio", "libglib2.0-bin")) {
        return;
    }
    const Outcome types = work.runCommand(
        "mkdir -p share/mime/packages && cp '" + base +
        ".xml' share/mime/packages && export XDG_DATA_HOME=\"$PWD/share\" && "
        "update-mime-database share/mime && for name in ply spz sog splat ksplat glb; do "
        "echo x >scene.$name && gio info -a standard::content-type scene.$name || exit; done");
    CHECK_MESSAGE(types.exit_code == 0, types.errors);
    std::string given;
    for (const auto& type : findAll(types.output, "standard::content-type: (.+)\n")) { given += type + ";"; }
    CHECK(given == opened);
}

TEST_CASE("links of the documents lead somewhere; the options and files they name exist") {
    checkLinks(documents());
    int options = 0, files = 0;
    for (const fs::path& document : documents()) {
        CAPTURE(document);
        const std::string text = textIn(document);
        for (const std::string& option : findAll(text, R"((?:^|[\s`('"\[])(--[a-z][a-z-]+))")) {
            CHECK_MESSAGE(isOption(option), option);
            ++options;
        }
        for (const std::string& name : findAll(
                 text, R"(`((?:configs|docs|tests|engine|shaders|app|xr|third_party)/[a-zA-Z0-9_/.]+)`)")) {
            CHECK_MESSAGE(fs::exists(kSource / name), name);
            ++files;
        }
    }
    CHECK(options > 100);
    CHECK(files > 20);
}

TEST_CASE("commands that the documents show are understood" * nightly()) {
    int calls = 0, runs = 0;
    const auto run_commands = findAll(textIn(kSource / "run"), R"(\n    ([a-z0-9]+)\)\n)");
    REQUIRE(run_commands.size() == 5);
    const std::string presets = textIn(kSource / "CMakePresets.json");
    fs::current_path(kSource);  // configs are named relative to it
    for (const fs::path& document : documents()) {
        CAPTURE(document);
        for (const std::string& line : codeLines(textIn(document))) {
            if (const std::vector<std::string> call = callOfProgram(line); !call.empty()) {
                CHECK_MESSAGE(wrongCall(call).empty(), line << ": " << wrongCall(call));
                ++calls;
            }
            const std::vector<std::string> words = wordsOf(line);
            if (words.size() > 1 && words[0] == "./run") {
                CHECK_MESSAGE(std::ranges::find(run_commands, words[1]) != run_commands.end(), line);
                ++runs;
            }
            for (const std::string& preset : findAll(line, "--preset ([a-z0-9]+)")) {
                CHECK_MESSAGE(contains(presets, fmt::format("\"name\": \"{}\"", preset)), line);
            }
            for (const std::string& word : words) {
                if (std::regex_match(word,
                                     std::regex("(configs|tests|third_party|xr|docs)/[a-zA-Z0-9_./-]+"))) {
                    CHECK_MESSAGE(fs::exists(kSource / word), line);
                }
            }
        }
    }
    CHECK(calls > 25);
    CHECK(runs > 4);
}

TEST_CASE_FIXTURE(AtWork, "the README's commands about files do what they say" * nightly()) {
    int done = 0;
    for (const std::string& line : codeLines(textIn(kSource / "README.md"))) {
        const std::vector<std::string> call = callOfProgram(line);
        if (call.empty() || (call[0] != "info" && call[0] != "scene" && call[0] != "convert")) { continue; }
        std::string arguments;
        for (const std::string& word : call) {
            arguments += fmt::format(" {}", word == "SCENE" ? "builtin:fence" : word == "N" ? "1000" : word);
        }
        work.go(arguments);
        ++done;
    }
    CHECK(done == 3);
    CHECK(work.holds("OUT.ply"));
    CHECK(work.holds("FILE.ply"));
}

}  // SUITE(docs)
