// The desktop's programs with a file dialog.
#include "app/desktop/open_dialog.h"

#include "app/desktop/file_portal.h"
#include "engine/error.h"
#include "engine/platform.h"
#include "engine/setup/text_file.h"
#include "engine/temporary_folder.h"

#include <array>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

namespace binosplat {

namespace {

const std::array<std::vector<std::string>, 2> kDialogs{{
    {"zenity", "--file-selection", "--title=Open a scene"},
    {"kdialog", "--title", "Open a scene", "--getopenfilename", "."},
}};

}  // namespace

ChosenFile askForFile(const std::function<bool()>& ends) {
    if (std::optional<ChosenFile> chosen = askPortalForFile(ends)) { return std::move(*chosen); }
    for (const std::vector<std::string>& dialog : kDialogs) {
        try {
            const TemporaryFolder folder("binosplat-open-", "choosing a file");
            const std::filesystem::path answer = folder.path() / "answer";
            if (!runProgram(dialog, answer, ends)) { return {}; }  // closed
            // Toolkits may print other things first.
            std::istringstream lines(readTextFile(answer, "the name of a file"));
            ChosenFile chosen;
            for (std::string line; std::getline(lines, line);) {
                if (!line.empty()) { chosen.file = line; }
            }
            return chosen;
        } catch (const Error&) {}  // try the next one
    }
    return {
        "",
        "no dialog to choose a file with: install xdg-desktop-portal, zenity or kdialog, drop the file on "
        "the window, or use the page Scenes"};
}

}  // namespace binosplat
