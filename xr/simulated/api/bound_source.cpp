// From a suggested path to a component.
#include "xr/simulated/api/bound_source.h"

#include <algorithm>

#include "xr/simulated/api/instance.h"
#include "xr/simulated/api/profiles.h"

namespace simulated {
namespace {

bool endsIn(std::string_view path, std::initializer_list<std::string_view> components) {
    return std::any_of(components.begin(), components.end(), [&](std::string_view component) { return path.ends_with(component); });
}

// The component that a suggested path means for an action of this type, as the specification's rules have it; none: it stays unbound.
std::optional<std::string> resolve(const Profile& profile, std::string_view user_path, std::string_view path, XrActionType type,
                                   const Vocabulary& words) {
    const auto firstOf = [&](std::initializer_list<const char*> components) -> std::optional<std::string> {
        for (const char* component : components) {
            const std::string whole = std::string(path) + component;
            if (hasComponent(profile, user_path, whole, words)) return whole;
        }
        return std::nullopt;
    };
    const bool is_whole = hasComponent(profile, user_path, path, words);
    const bool is_number =
        is_whole && endsIn(path, {"/click", "/touch", "/value", "/force", "/proximity", "/x", "/y", "/ready_ext", "/proximity_fb",
                                  "/curl_fb", "/slide_fb", "/proximity_meta", "/curl_meta", "/slide_meta"});
    switch (type) {
        case XR_ACTION_TYPE_BOOLEAN_INPUT:
            if (is_number) return std::string(path);
            return firstOf({"/click", "/value"});
        case XR_ACTION_TYPE_FLOAT_INPUT:
            if (is_number) return std::string(path);
            return firstOf({"/value", "/click"});
        case XR_ACTION_TYPE_VECTOR2F_INPUT:
            if (firstOf({"/x"}) && firstOf({"/y"})) return std::string(path);
            return std::nullopt;
        case XR_ACTION_TYPE_POSE_INPUT:
            if (is_whole && path.ends_with("/pose")) return std::string(path);
            return firstOf({"/pose"});
        default:
            if (is_whole && path.starts_with("/output/")) return std::string(path);
            return std::nullopt;
    }
}

}  // namespace

std::optional<BoundSource> bindSource(const Instance& instance, const Profile& profile, XrPath path, XrActionType type) {
    const std::string& text = instance.paths.textOf(path);
    const std::string_view user_path = userPathOf(text);
    const std::optional<std::size_t> device = deviceOf(user_path);
    if (!device) return std::nullopt;
    const std::optional<std::string> component =
        resolve(profile, user_path, std::string_view(text).substr(user_path.size()), type, instance.vocabulary());
    if (!component) return std::nullopt;
    const std::size_t start = component->find('/', 1) + 1;
    const std::size_t end = component->find('/', start);
    return BoundSource{path, instance.paths.findPath(user_path), *device, component->substr(start, end - start), component->substr(start)};
}

}  // namespace simulated
