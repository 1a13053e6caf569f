// Completion for bash.
#include "app/command_line/option_documents.h"

#include "app/command_line/commands_table.h"

#include <fmt/format.h>

namespace binosplat {

std::string completionsOfBash() {
    std::string names, options, values;
    for (const Command& command : shownCommands()) {
        names += fmt::format("{}{}", names.empty() ? "" : " ", command.name);
        std::vector<std::string> keys;
        for (const OptionDescription& option : optionsOf(command)) {
            keys.push_back(fmt::format("--{}", option.text.key));
            if (!option.choices.empty()) {
                values += fmt::format("        {}:--{}) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")); return ;;\n", command.name,
                                      option.text.key, fmt::join(option.choices, " "));
            } else if (!option.text.isFlag()) {
                values += fmt::format("        {}:--{}) {} return ;;\n", command.name, option.text.key,
                                      option.is_file ? "COMPREPLY=($(compgen -f -- \"$word\"));" : "");
            }
        }
        options += fmt::format("        {}) COMPREPLY=($(compgen -W \"{} --help\" -- \"$word\")) ;;\n", command.name, fmt::join(keys, " "));
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

}  // namespace binosplat
