// What of a headset a program goes on without: a line for each, once, in however many frames and sessions it comes to that.
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
    // Those that were not taken yet.
    [[nodiscard]] std::vector<std::string> take() { return std::exchange(news_, {}); }

    // Does `act`, and goes on without `what` ("pulses") where that throws Error: false then. Lost and InstanceLost are thrown on.
    template <typename Act>
    bool tryFor(const char* what, Act&& act) {
        try {
            act();
            return true;
        } catch (const Lost&) { throw; } catch (const InstanceLost&) {
            throw;
        } catch (const Error& error) { add(fmt::format("{}; on without {}", error.what(), what)); }
        return false;
    }

private:
    std::set<std::string> said_;
    std::vector<std::string> news_;
};

}  // namespace binosplat::xr
