// Common to the documents that are made from the table.
#pragma once

#include "app/command_line/commands_table.h"

#include <string>
#include <string_view>
#include <vector>

namespace binosplat {

inline bool isFlag(const OptionText& text) { return *text.value == '\0'; }

inline std::string replaced(std::string text, std::string_view what, std::string_view by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size())) {
        text.replace(at, what.size(), by);
    }
    return text;
}

inline std::vector<const Command*> shownCommands() {
    std::vector<const Command*> shown;
    for (const Command& command : commands()) {
        if (!command.hidden) { shown.push_back(&command); }
    }
    return shown;
}

}  // namespace binosplat
