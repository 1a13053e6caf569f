// Completions of three shells.
#include "app/options/shell_completions.h"

#include "app/options/document_text.h"

#include <fmt/format.h>

namespace binosplat {

namespace {

// Within single quotes of a shell; zsh takes brackets and colons for its own.
std::string quoted(const std::string& text) { return replaced(text, "'", "'\\''"); }
std::string zshText(const std::string& text) { return quoted(replaced(replaced(replaced(text, "[", "\\["), "]", "\\]"), ":", "\\:")); }

}  // namespace

std::string completionsOfBash() {
    std::string names, options, values;
    for (const Command* command : shownCommands()) {
        names += fmt::format("{}{}", names.empty() ? "" : " ", command->name);
        std::vector<std::string> keys;
        for (const OptionDescription& option : optionsOf(*command)) {
            keys.push_back(fmt::format("--{}", option.text.key));
            if (!option.choices.empty()) {
                values += fmt::format("        {}:--{}) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")); return ;;\n", command->name,
                                      option.text.key, fmt::join(option.choices, " "));
            } else if (!isFlag(option.text)) {
                values += fmt::format("        {}:--{}) {} return ;;\n", command->name, option.text.key,
                                      option.is_file ? "COMPREPLY=($(compgen -f -- \"$word\"));" : "");
            }
        }
        options +=
            fmt::format("        {}) COMPREPLY=($(compgen -W \"{} --help\" -- \"$word\")) ;;\n", command->name, fmt::join(keys, " "));
    }
    return fmt::format(R"(# Completion of binosplat for bash.
_binosplat() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}} command=${{COMP_WORDS[1]}}
    if ((COMP_CWORD == 1)); then
        COMPREPLY=($(compgen -W "{} --help --version" -- "$word"))
        return
    fi
    case $command:$before in
{}    esac
    if [[ $word != -* ]]; then
        COMPREPLY=($(compgen -f -- "$word"))
        return
    fi
    case $command in
{}    esac
}}
complete -o filenames -F _binosplat binosplat
)",
                       names, values, options);
}

std::string completionsOfZsh() {
    std::string list, cases;
    for (const Command* command : shownCommands()) {
        list += fmt::format("        '{}:{}'\n", command->name, zshText(command->help));
        cases += fmt::format("        {}) _arguments", command->name);
        for (const OptionDescription& option : optionsOf(*command)) {
            cases += fmt::format(" \\\n            '--{}[{}]", option.text.key, zshText(option.help()));
            if (!option.choices.empty()) {
                cases += fmt::format(":{}:({})'", option.text.value, fmt::join(option.choices, " "));
            } else if (isFlag(option.text)) {
                cases += "'";
            } else {
                cases += fmt::format(":{}:{}'", zshText(option.text.value), option.is_file ? "_files" : "");
            }
        }
        cases += " \\\n            '*:file:_files' ;;\n";
    }
    return fmt::format(
        "#compdef binosplat\n# Completion of binosplat for zsh.\n_binosplat() {{\n    local -a commands=(\n{}    )\n    if ((CURRENT == "
        "2)); then\n"
        "        _describe command commands\n        return\n    fi\n    local command=$words[2]\n    shift words\n    ((CURRENT--))\n"
        "    case $command in\n{}    esac\n}}\n_binosplat \"$@\"\n",
        list, cases);
}

std::string completionsOfFish() {
    std::string text = "# Completion of binosplat for fish.\n";
    for (const Command* command : shownCommands()) {
        text += fmt::format("complete -c binosplat -n __fish_use_subcommand -f -a {} -d '{}'\n", command->name, quoted(command->help));
        for (const OptionDescription& option : optionsOf(*command)) {
            const std::string value = isFlag(option.text)       ? ""
                                      : !option.choices.empty() ? fmt::format(" -x -a '{}'", fmt::join(option.choices, " "))
                                      : option.is_file          ? " -r"
                                                                : " -x";
            text += fmt::format("complete -c binosplat -n '__fish_seen_subcommand_from {}' -l {}{} -d '{}'\n", command->name,
                                option.text.key, value, quoted(option.help()));
        }
    }
    return text;
}

}  // namespace binosplat
