// Well-formed paths and their numbers; xrStringToPath and xrPathToString.
#include "xr/simulated/api/paths.h"

#include <algorithm>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/instance.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr std::size_t kMostPaths = 1 << 16;

// "/a/b": starts with a slash, does not end with one, and no level is empty or made only of dots.
bool isWellFormed(std::string_view text) {
    if (text.size() < 2 || text.size() >= XR_MAX_PATH_LENGTH || text.front() != '/') { return false; }
    for (std::size_t start = 1; start <= text.size();) {
        const std::size_t end = std::min(text.find('/', start), text.size());
        const std::string_view level = text.substr(start, end - start);
        if (level.empty() || !isPathLevel(level) || level.find_first_not_of('.') == std::string_view::npos) {
            return false;
        }
        start = end + 1;
    }
    return text.back() != '/';
}

}  // namespace

bool isPathLevel(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    });
}

XrPath Paths::pathOf(std::string_view text) {
    if (!isWellFormed(text)) {
        refuse(XR_ERROR_PATH_FORMAT_INVALID, makePrintable(text), " is not a well-formed path");
    }
    const auto [entry, is_new] = paths_.try_emplace(std::string(text), texts_.size() + 1);
    if (is_new) {
        if (texts_.size() == kMostPaths) {
            paths_.erase(entry);
            refuse(XR_ERROR_PATH_COUNT_EXCEEDED, text, " is one more than ", kMostPaths,
                   ", the most paths that there may be");
        }
        texts_.emplace_back(text);
    }
    return entry->second;
}

const std::string& Paths::textOf(XrPath path) const {
    require(path != XR_NULL_PATH && path <= texts_.size(), XR_ERROR_PATH_INVALID, "the number ", path,
            " is not a path");
    return texts_[path - 1];
}

XrPath Paths::findPath(std::string_view text) const {
    const auto found = paths_.find(std::string(text));
    return found == paths_.end() ? XR_NULL_PATH : found->second;
}

XrResult xrStringToPath(XrInstance instance, const char* pathString, XrPath* path) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        require(pathString != nullptr, XR_ERROR_VALIDATION_FAILURE, "a string is missing");
        XrPath& output = checkOutput(path);
        output = owner.paths.pathOf({pathString, strnlen(pathString, XR_MAX_PATH_LENGTH)});
    });
}

XrResult xrPathToString(XrInstance instance, XrPath path, uint32_t bufferCapacityInput,
                        uint32_t* bufferCountOutput, char* buffer) {
    return answerFor<Instance>(__func__, instance, [&](const Instance& owner) {
        fillString(bufferCapacityInput, bufferCountOutput, buffer, owner.paths.textOf(path));
    });
}

}  // namespace simulated
