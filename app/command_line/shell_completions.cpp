// Completion for bash, zsh and fish.
#include "app/command_line/option_documents.h"

#include "app/command_line/commands_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace binosplat {

namespace {

// `text` with a backslash before each of `special`.
std::string escaped(std::string_view text, std::string_view special) {
    std::string made;
    for (const char letter : text) {
        if (special.find(letter) != std::string_view::npos) { made += '\\'; }
        made += letter;
    }
    return made;
}

// In single quotes, which must be interrupted for a quote within.
std::string quotedForZsh(std::string_view text) {
    std::string made = "'";
    for (const char letter : text) { made += letter == '\'' ? std::string("'\\''") : std::string(1, letter); }
    return made + "'";
}

std::string quotedForFish(std::string_view text) { return fmt::format("'{}'", escaped(text, "\\'")); }

}  // namespace

std::string completionsOfBash() {
    std::string names, options, values;
    for (const Command& command : shownCommands()) {
        names += fmt::format("{}{}", names.empty() ? "" : " ", command.name);
        std::vector<std::string> keys;
        for (const OptionDescription& option : optionsOf(command)) {
            keys.push_back(fmt::format("--{}", option.text.key));
            if (!option.choices.empty()) {
                values +=
                    fmt::format("        {}:--{}) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")); return ;;\n",
                                command.name, option.text.key, fmt::join(option.choices, " "));
            } else if (!option.text.isFlag()) {
                values += fmt::format("        {}:--{}) {} return ;;\n", command.name, option.text.key,
                                      option.is_file ? "COMPREPLY=($(compgen -f -- \"$word\"));" : "");
            }
        }
        options += fmt::format("        {}) COMPREPLY=($(compgen -W \"{} --help\" -- \"$word\")) ;;\n",
                               command.name, fmt::join(keys, " "));
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
    std::string names, cases;
    for (const Command& command : shownCommands()) {
        names += fmt::format("        {}\n", quotedForZsh(fmt::format("{}:{}", command.name, command.help)));
        cases += fmt::format("    {})\n        _arguments", command.name);
        for (const OptionDescription& option : optionsOf(command)) {
            std::string specification =
                fmt::format("--{}[{}]", option.text.key, escaped(option.text.help, "[]\\"));
            if (!option.text.isFlag()) {
                specification += fmt::format(":{}:{}", escaped(option.text.value, ":[]\\"),
                                             option.is_file ? "_files" : "");
                if (!option.choices.empty()) {
                    specification += fmt::format("({})", fmt::join(option.choices, " "));
                }
            }
            cases += fmt::format(" \\\n            {}", quotedForZsh(specification));
        }
        cases += fmt::format(" \\\n            '--help[print this command'\\''s options]'{} ;;\n",
                             command.words.empty() ? "" : " \\\n            '*:file:_files'");
    }
    return fmt::format(R"(#compdef binosplat
_binosplat() {{
    local -a commands=(
{}    )
    if ((CURRENT == 2)); then
        _alternative 'commands:command:{{_describe -t commands command commands}}' 'scenes:scene:_files'
        return
    fi
    local command=$words[2]
    shift words
    ((CURRENT--))
    case $command in
{}    *) _files ;;
    esac
}}
_binosplat "$@"
)",
                       names, cases);
}

std::string completionsOfFish() {
    std::string text =
        "# Completion of binosplat for fish.\ncomplete -c binosplat -n __fish_use_subcommand -l help -d "
        "'print the commands'\n"
        "complete -c binosplat -n __fish_use_subcommand -l version -d 'print the version'\n";
    for (const Command& command : shownCommands()) {
        text += fmt::format("complete -c binosplat -n __fish_use_subcommand -a {} -d {}\n", command.name,
                            quotedForFish(command.help));
        const std::string seen =
            fmt::format("complete -c binosplat -n '__fish_seen_subcommand_from {}'", command.name);
        for (const OptionDescription& option : optionsOf(command)) {
            std::string value = option.text.isFlag() ? "" : option.is_file ? " -r -F" : " -x";
            if (!option.choices.empty()) { value += fmt::format(" -a '{}'", fmt::join(option.choices, " ")); }
            text += fmt::format("{} -l {}{} -d {}\n", seen, option.text.key, value,
                                quotedForFish(option.text.help));
        }
        text += fmt::format("{} -l help -d 'print the options'\n", seen);
    }
    return text;
}

}  // namespace binosplat
