// Optional features of a headset that failed: one line for each, however many frames and sessions it fails
// in.
#pragma once

#include "xr/check.h"

#include <set>
#include <string>
#include <utility>
#include <vector>

namespace binosplat::xr {

class Troubles {
public:
    void add(const std::string& line) {
        if (said_.insert(line).second) { news_.push_back(line); }
    }
    // The lines that were not taken yet.
    [[nodiscard]] std::vector<std::string> take() { return std::exchange(news_, {}); }

    // Does `act`; if that throws Error, goes on without `what` ("pulses") and returns false.
    template <typename Act>
    bool tryFor(const char* what, Act&& act) {
        try {
            act();
            return true;
        } catch (const Error& error) { add(fmt::format("{}; going on without {}", error.what(), what)); }
        return false;
    }

private:
    std::set<std::string> said_;
    std::vector<std::string> news_;
};

}  // namespace binosplat::xr
