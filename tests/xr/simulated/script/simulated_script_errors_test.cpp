// Facts about scripts with mistakes: each is reported with its file and line, and nothing crashes.
#include "tests/script.h"
#include "tests/xr/simulated/folder.h"
#include "xr/simulated/script/script.h"

SUITE(simulated_script_errors) {

using namespace simulated;

Outcome parse(const std::string& text, const std::string& name) {
    try {
        (void)Script::parse(text, name);
        return {0, "", ""};
    } catch (const ScriptError& error) { return {1, "", error.what() + std::string("\n")}; }
}

// `> SCRIPT`, in which \n ends a line.
SCRIPT(simulated_script_errors, "xr/simulated/script/simulated_script_errors") {
    const Folder folder;
    const auto refusal = [&](const std::string& text, const std::string&) {
        return parse(unescaped(text), (folder.path / "a.script").string());
    };
    ScriptHost host{refusal, folder.path};
    host.names = {{"LONG", std::string(5000, 'x')}};
#ifndef _WIN32
    host.features = {"posix"};
#endif
    // headset FROM => TO: a headset's file with a part of it replaced. long FILE MIB: a file one byte longer
    // than that.
    host.verbs = {
        {"headset", [&](const std::string& edit) { folder.write("h.toml", edited(kHeadsetToml, edit)); }},
        {"long", [&](const std::string& words) {
             const std::size_t mebibytes = std::stoul(wordsIn(words).at(1));
             folder.write(wordsIn(words)[0], std::string((mebibytes << 20) + 1, '#'));
         }}};
    runScript(host);
}

// How many of these texts are refused, each with its file's name.
template <class Texts>
std::size_t countRefused(const Texts& texts) {
    std::size_t refused = 0;
    for (const std::string& text : texts) {
        const Outcome parsed = parse(text, "a.script");
        if (parsed.exit_code == 0) { continue; }
        ++refused;
        if (!parsed.errors.starts_with("a.script:")) { FAIL_CHECK(parsed.errors); }
    }
    return refused;
}

TEST_CASE_FIXTURE(InFolder, "a script's own file may be one that cannot be read") {
    folder.write("h.toml", "version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n");
    CHECK_THROWS_AS((void)Script::load(folder.path / "h.toml"), ScriptError);
    const std::filesystem::path none = folder.path / "none.script";
    CHECK_THROWS_WITH_AS(
        (void)Script::load(none),
        (none.string() + ": cannot be read (No such file or directory), must be a script").c_str(),
        ScriptError);
    CHECK_THROWS_AS((void)Script::load("/dev/zero"), ScriptError);
}

TEST_CASE("a script cut off anywhere, or with any byte changed, is a script or an error") {
    const std::string walk = textIn(BINOSPLAT_SOURCE_DIR "/configs/simulated/walk.script"),
                      text = walk +
                             "headset \"none such.toml\"\nvisibility-mask on\naim left turn 5 5\nat 5 eye "
                             "left angles -1 1 1 -1\n"
                             "at 6 controller left off\n";
    REQUIRE(text.size() > 900);
    std::vector<std::string> cut, changed;
    for (std::size_t length = 0; length <= text.size(); ++length) { cut.push_back(text.substr(0, length)); }
    for (std::size_t i = 0; i < walk.size(); ++i) {
        for (const char byte : {'\0', '\n', '"', '#', '-', '9', '\xff'}) {
            changed.push_back(walk);
            changed.back()[i] = byte;
        }
    }
    // Cut at the end of a line, it is a shorter script; cut inside a word, it is mostly invalid.
    const std::size_t refused = countRefused(cut);
    CHECK(cut.size() - refused > 20);
    CHECK(refused > 200);
    CHECK(countRefused(changed) > 1000);
}

}  // SUITE(simulated_script_errors)
