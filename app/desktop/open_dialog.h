// The desktop's own dialog for choosing a file.
#pragma once

#include <functional>
#include <string>

namespace binosplat {

struct ChosenFile {
    std::string file;     // empty: cancelled
    std::string trouble;  // why there is no dialog
};

// Waits until the user has chosen, or until `ends`. Asks the desktop's portal, or else zenity or kdialog.
ChosenFile askForFile(const std::function<bool()>& ends);

}  // namespace binosplat
