// The desktop's own dialog for choosing a file.
#pragma once

#include <string>

namespace binosplat {

struct ChosenFile {
    std::string file;     // empty: nobody chose one
    std::string trouble;  // why there is no dialog
};

// Waits until somebody has chosen. By zenity or kdialog, which ask the desktop's portal where there is one.
ChosenFile askForFile();

}  // namespace binosplat
