// The command line, read with CLI11.
#include "app/options/options.h"

#include "app/command_line/commands_table.h"
#include "app/terminal/version.h"
#include "engine/address.h"
#include "engine/error.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <deque>
#include <filesystem>
#include <memory>
#include <string_view>

namespace binosplat {

namespace {

// Filled in by CLI11 for one command; values stay text until they are merged with those of a config.
struct CommandLine {
    const Command* command = nullptr;
    CLI::App* parser = nullptr;
    std::map<std::string, std::string> values;
    std::map<std::string, std::vector<std::string>> words;  // words that may be repeated
    std::map<std::string, CLI::Option*> given;
};

const char* groupOf(const OptionText& text) {
    static const std::map<std::string_view, const char*> groups{
        {"camera", "Camera"}, {"stereo", "Stereo"}, {"scene", "Scene"}, {"run", "Run"}};
    const auto found = groups.find(text.table);
    return found == groups.end() ? "Options" : found->second;
}

void addOption(CommandLine& line, const OptionDescription& option) {
    const OptionText& text = option.text;
    const std::string name = std::string("--") + text.key;
    CLI::Option* added = nullptr;
    if (text.isFlag()) {
        added = line.parser->add_flag(name)->description(option.help());
    } else {
        added = line.parser->add_option(name, line.values[text.key], option.help())->type_name(text.value);
        if (*text.value == '[') { added->expected(0, 1); }
    }
    added->group(groupOf(text))->required(text.required);
    line.given[text.key] = added;
}

void addCommand(CLI::App& app, CommandLine& line, const Command& command) {
    line.command = &command;
    line.parser = app.add_subcommand(command.name, command.help);
    if (command.hidden) { line.parser->group(""); }
    for (const Word& word : command.words) {
        CLI::Option* added = word.many
                                 ? line.parser->add_option(word.name, line.words[word.name], word.help)
                                 : line.parser->add_option(word.name, line.values[word.name], word.help);
        line.given[word.name] = added->required(word.required);
    }
    for (const OptionDescription& option : optionsOf(command)) { addOption(line, option); }
    if (*command.footer != '\0') { line.parser->footer(command.footer); }
}

Settings settingsOf(const CommandLine& line) {
    Settings settings;
    for (const auto& [key, option] : line.given) {
        if (option->count() == 0) { continue; }
        if (const auto words = line.words.find(key); words != line.words.end()) {
            settings.emplace(key, Setting{key, words->second});
        } else {
            // A flag holds "true", or the text after its =.
            const auto value = line.values.find(key);
            settings.emplace(
                key,
                Setting{"--" + key, {value == line.values.end() ? option->results().back() : value->second}});
        }
    }
    return settings;
}

// CLI11 takes "-.5,0,0" for an option but "-0.5,0,0" for a value.
std::vector<std::string> readableArguments(std::vector<std::string> words) {
    std::ranges::reverse(words);
    for (std::string& argument : words) {
        const bool bare_fraction = argument.size() > 2 && argument[0] == '-' && argument[1] == '.' &&
                                   std::isdigit(static_cast<unsigned char>(argument[2])) != 0;
        if (bare_fraction) { argument.insert(1, "0"); }
    }
    return words;
}

bool isScene(const std::string& word) {
    std::error_code unknown;
    return word.starts_with("builtin:") || isAddress(word) || std::filesystem::exists(word, unknown);
}

// No command looks like that.
bool looksLikeFile(const std::string& word) {
    return word.find_first_of("/\\") != std::string::npos || std::filesystem::path(word).has_extension();
}

// A scene in place of a command is viewed: a file that was dropped onto the program, or opened with it.
// Without any word the viewer lists scenes. For any other word CLI11 would only say that a command is
// missing.
std::vector<std::string> withCommand(std::vector<std::string> words) {
    if (words.empty()) { return {"view"}; }
    const std::string word = words.front();
    if (word.starts_with('-') || std::ranges::find(commands(), word, &Command::name) != commands().end()) {
        return words;
    }
    if (isScene(word)) {
        if (words.size() > 1 && !words[1].starts_with('-') &&
            (isScene(words[1]) || looksLikeFile(words[1]))) {
            throw Error(
                ExitCode::kUsage,
                fmt::format("{} and {} are two scenes, must be one to view at a time", word, words[1]));
        }
        words.insert(words.begin(), "view");
        return words;
    }
    check(!looksLikeFile(word),
          "{}: no such file, must be a scene to view, or a command (see `binosplat --help`)", word);
    std::string names;
    for (const Command& command : shownCommands()) {
        names += fmt::format("{}{}", names.empty() ? "" : ", ", command.name);
    }
    throw Error(
        ExitCode::kUsage,
        fmt::format("{} is not a command; must be one of: {}, or a scene to view (see `binosplat --help`)",
                    word, names));
}

// A command may be left out, which CLI11 does not know.
struct HelpFormatter : CLI::Formatter {
    std::string make_usage(const CLI::App* app, std::string name) const override {
        if (app->get_parent() != nullptr) { return CLI::Formatter::make_usage(app, name); }
        return "Usage: binosplat SCENE [OPTIONS]       show a scene, as `binosplat view` does\n"
               "       binosplat SUBCOMMAND [OPTIONS]\n";
    }
};

std::string oneLine(std::string text) {
    std::ranges::replace(text, '\n', ' ');
    return text;
}

}  // namespace

Options parseOptions(int argument_count, const char* const* arguments) {
    std::vector<std::string> words(arguments + std::min(argument_count, 1), arguments + argument_count);
    for (const std::string& word : words) { requireNoUser(word); }  // before any message repeats it
    words = withCommand(std::move(words));
    CLI::App app{"binosplat: Gaussian splatting scenes in stereo and in a VR headset", "binosplat"};
    app.formatter(std::make_shared<HelpFormatter>());
    app.allow_windows_style_options(false);  // a path may begin with a slash there, too
    app.require_subcommand(1);
    app.set_version_flag("--version", fmt::format("binosplat {}", kVersion));
    std::deque<CommandLine> lines;  // CLI11 keeps addresses of its elements
    for (const Command& command : commands()) { addCommand(app, lines.emplace_back(), command); }
    try {
        app.parse(readableArguments(words));
    } catch (const CLI::CallForHelp&) {
        const auto chosen = app.get_subcommands();
        return HelpText{chosen.empty() ? app.help() : chosen.front()->help("binosplat")};
    } catch (const CLI::CallForVersion&) {
        return HelpText{app.version() + "\n"};
    } catch (const CLI::ParseError& error) {
        throw Error(ExitCode::kUsage, oneLine(error.what()) + " (see `binosplat --help`)");
    }
    const auto chosen =
        std::ranges::find_if(lines, [](const CommandLine& line) { return line.parser->parsed(); });
    return chosen->command->make(settingsOf(*chosen));
}

}  // namespace binosplat
