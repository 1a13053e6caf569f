// The commands: their words, their options, and the functions that read them.
#pragma once

#include "app/options/option_table.h"

#include <functional>

namespace binosplat {

// A positional argument of the command line.
struct Word {
    const char* name;
    const char* help;
    bool required = true;
    bool many = false;
};

struct Command {
    const char* name;
    CommandBit bit;
    const char* help;
    std::vector<Word> words;
    std::vector<OptionDescription> own;  // besides those that it shares with others
    Options (*make)(const Settings& line);
    const char* footer = "";
    bool hidden = false;  // from --help: only for the build
};

std::span<const Command> commands();
std::vector<std::reference_wrapper<const Command>> shownCommands();  // by --help

// A command's own options and those it shares, in the order of the help.
std::vector<OptionDescription> optionsOf(const Command& command);

}  // namespace binosplat
