// The dialog for files of the desktop's portal (org.freedesktop.portal.FileChooser), which sandboxes have,
// too.
#pragma once

#include "app/desktop/open_dialog.h"

#include <functional>
#include <optional>

namespace binosplat {

// Waits until the user has chosen, or until `ends`. Empty: there is no portal.
std::optional<ChosenFile> askPortalForFile(const std::function<bool()>& ends);

// The path of a file URI; empty: it is none.
std::string pathOfUri(const std::string& uri);

}  // namespace binosplat
