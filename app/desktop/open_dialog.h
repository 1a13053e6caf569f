// The desktop's own dialog for choosing a file.
#pragma once

#include <string>

namespace binosplat {

struct ChosenFile {
    std::string file;     // empty: cancelled
    std::string trouble;  // why there is no dialog
};

// Waits until the user has chosen. Uses zenity or kdialog, which ask the desktop's portal if there is one.
ChosenFile askForFile();

}  // namespace binosplat
