// Prints the list of commands and options for readers and shells.
#include "app/command_line/option_documents.h"

#include "app/command_line/commands_table.h"
#include "app/terminal/version.h"
#include "app/view/settings/view_settings_table.h"
#include "engine/error.h"

#include <array>
#include <utility>

namespace binosplat {

namespace {

std::string replaced(std::string_view text, std::string_view what, std::string_view by) {
    std::string made;
    for (std::size_t at = text.find(what); at != std::string_view::npos; at = text.find(what)) {
        made.append(text.substr(0, at)).append(by);
        text.remove_prefix(at + what.size());
    }
    return made.append(text);
}

std::string usage(const Command& command) {
    std::string line = fmt::format("binosplat {}", command.name);
    for (const Word& word : command.words) {
        const std::string name = fmt::format("{}{}", word.name, word.many ? "..." : "");
        line += word.required ? " " + name : fmt::format(" [{}]", name);
    }
    for (const OptionDescription& option : command.own) {
        if (option.text.required) { line += fmt::format(" --{} {}", option.text.key, option.text.value); }
    }
    return line + (optionsOf(command).empty() ? "" : " [OPTIONS]");
}

std::string markdownRow(const OptionDescription& option, const std::string& last) {
    const std::string value =
        option.text.isFlag() ? "" : fmt::format(" {}", replaced(option.text.value, "|", "\\|"));
    return fmt::format("| `--{}{}` | {} | {} | {} | {} |\n", option.text.key, value,
                       replaced(option.text.help, "|", "\\|"), option.range, option.standard, last);
}

std::string commandsWith(const OptionText& text) {
    std::string names;
    for (const Command& command : shownCommands()) {
        if ((text.commands & command.bit) != 0) {
            names += fmt::format("{}`{}`", names.empty() ? "" : ", ", command.name);
        }
    }
    return (text.commands & kMethods) != 0 ? names + ", `[[methods]]`" : names;
}

std::string markdown() {
    std::string text =
        "# Options\n\nGenerated from the program's own table (`binosplat document markdown`). Every command "
        "prints its part\nwith `--help`.\n\n## Commands\n";
    for (const Command& command : shownCommands()) {
        text +=
            fmt::format("\n### {}\n\n{}.\n\n```\n{}\n```\n\n", command.name, command.help, usage(command));
        for (const Word& word : command.words) { text += fmt::format("- `{}`: {}\n", word.name, word.help); }
        if (command.own.empty()) { continue; }
        text += fmt::format("{}| option | | range | default | |\n|---|---|---|---|---|\n",
                            command.words.empty() ? "" : "\n");
        for (const OptionDescription& option : command.own) {
            text += markdownRow(option, option.text.required ? "required" : "");
        }
    }
    text +=
        "\n## Shared options\n\nThe last column says which commands have the option. An option may also be "
        "set in a config file (`--config`):\nwithout its dashes, either at the top or in the table that is "
        "named here. The command line wins.\n`[[methods]]` means that a bench's methods may set it, too.\n";
    const char* table = "";
    for (const OptionRow<RunOptions>& row : runRows()) {
        if (std::string_view(table) != row.text.table) {
            table = row.text.table;
            text += fmt::format(
                "\n### [{}]\n\n| option | | range | default | commands |\n|---|---|---|---|---|\n", table);
        }
        text += markdownRow(describe(row), commandsWith(row.text));
    }
    text +=
        "\n### [view]\n\nOnly for config files; the panel saves these keys. It also saves where the scene "
        "is: `scene-position`,\n`scene-orientation` (w, x, y, z) and `units-per-metre`, all three or none, "
        "and the scene's scale,\n`metres-per-unit`.\n\n| key | | range | default |\n|---|---|---|---|\n";
    for (const OptionRow<ViewSettings>& row : viewSettingsRows()) {
        const OptionDescription key = describe(row);
        text += fmt::format("| `{}` | {} | {} | {} |\n", key.text.key, key.text.help, key.range,
                            key.standard.empty() ? "false" : key.standard);
    }
    return text;
}

// docs/render.md explains these in detail.
constexpr std::array<std::pair<const char*, const char*>, 6> kEnvironment{{
    {"BINOSPLAT_DATA", "folder that contains configs/headsets"},
    {"BINOSPLAT_PIPELINE_CACHE", "folder in which to keep what the driver has compiled; 0: none"},
    {"BINOSPLAT_FONT", "TrueType font of the viewer's panel"},
    {"BINOSPLAT_SHADERS", "folder of shader sources that the viewer's panel can reload"},
    {"BINOSPLAT_VISIBILITY_MASK", "0: the viewer also draws what the headset's lenses hide"},
    {"BINOSPLAT_VALIDATION",
     "1: run with Vulkan's validation layers; any message of theirs makes the command fail"},
}};

// A dot or an apostrophe at the start of a line would be a request, and a bare dash a hyphen that searches do
// not find.
std::string manText(const std::string& text) {
    std::string escaped = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
    if (escaped.starts_with('.') || escaped.starts_with('\'')) { escaped = "\\&" + escaped; }
    return escaped;
}

std::string man() {
    std::string text = fmt::format(
        ".TH BINOSPLAT 1 \"\" \"binosplat {}\" \"User Commands\"\n.SH NAME\nbinosplat \\- {}\n.SH SYNOPSIS\n",
        kVersion, "Gaussian splatting scenes for the two eyes of a VR headset");
    for (const Command& command : shownCommands()) {
        text += fmt::format(".B {}\n.br\n", manText(usage(command)));
    }
    text += ".SH COMMANDS\n";
    for (const Command& command : shownCommands()) {
        text += fmt::format(".SS {}\n{}.\n", manText(usage(command)), manText(command.help));
        for (const Word& word : command.words) {
            text += fmt::format(".TP\n.I {}\n{}\n", word.name, manText(word.help));
        }
        for (const OptionDescription& option : optionsOf(command)) {
            text += fmt::format(
                ".TP\n\\fB\\-\\-{}\\fR{}\n{}\n", manText(option.text.key),
                option.text.isFlag() ? "" : fmt::format(" \\fI{}\\fR", manText(option.text.value)),
                manText(option.help()));
        }
    }
    text +=
        ".SH EXIT STATUS\n0 done; 1 bad input; 2 the command line was not understood; 3 no usable device, "
        "runtime or headset; 130 and 143 "
        "interrupted.\n.SH ENVIRONMENT\n";
    for (const auto& [name, help] : kEnvironment) {
        text += fmt::format(".TP\n.B {}\n{}\n", name, manText(help));
    }
    return text;
}

}  // namespace

std::string documentOf(const std::string& kind) {
    if (kind == "markdown") { return markdown(); }
    if (kind == "config") { return defaultConfig(); }
    if (kind == "man") { return man(); }
    if (kind == "bash") { return completionsOfBash(); }
    if (kind == "zsh") { return completionsOfZsh(); }
    if (kind == "fish") { return completionsOfFish(); }
    throw Error(ExitCode::kUsage,
                fmt::format("document: KIND is {}, must be markdown, config, man, bash, zsh or fish", kind));
}

}  // namespace binosplat
