// Chapter 6 of the specification: path strings as atoms, for an instance's life.
#pragma once

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "xr/simulated/openxr.h"

namespace simulated {

class Paths {
public:
    // XR_ERROR_PATH_FORMAT_INVALID, XR_ERROR_PATH_COUNT_EXCEEDED.
    XrPath pathOf(std::string_view text);
    // XR_ERROR_PATH_INVALID.
    const std::string& textOf(XrPath path) const;
    // XR_NULL_PATH if nobody made it yet.
    XrPath findPath(std::string_view text) const;

private:
    std::vector<std::string> texts_;
    std::unordered_map<std::string, XrPath> paths_;
};

// Lower-case letters, digits, and - _ . make a level of a path, and so the name of an action.
bool isPathLevel(std::string_view text);

}  // namespace simulated
