// The commands: their words, their options, and the calls that run them.
#pragma once

#include "app/options/option_table.h"

#include <functional>

namespace binosplat {

// An argument of the command line without a name.
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
    std::vector<OptionDescription> own;  // beside those that it shares with others
    Options (*make)(const Settings& line);
    const char* footer = "";
    bool hidden = false;  // from --help: of use to the build alone
};

std::span<const Command> commands();
std::vector<std::reference_wrapper<const Command>> shownCommands();  // by --help

// Its own options and those it shares, as the help lists them.
std::vector<OptionDescription> optionsOf(const Command& command);

}  // namespace binosplat
