// Resolves a suggested path to a component.
#include "xr/simulated/api/bound_source.h"

#include "xr/simulated/api/instance.h"
#include "xr/simulated/api/profiles.h"

namespace simulated {
namespace {

// The component that a suggested path means for an action of this type, by the specification's rules; if
// empty, the action stays unbound.
std::optional<std::string> resolve(const Profile& profile, std::string_view user_path, std::string_view path,
                                   XrActionType type, const Enabled& enabled) {
    const auto firstOf = [&](std::initializer_list<const char*> components) -> std::optional<std::string> {
        for (const char* component : components) {
            const std::string longer = std::string(path) + component;
            if (findComponent(profile, user_path, longer, enabled) != nullptr) { return longer; }
        }
        return std::nullopt;
    };
    const Component* const whole = findComponent(profile, user_path, path, enabled);
    const auto is = [&](ComponentKind kind) { return whole != nullptr && whole->kind == kind; };
    const bool is_number = is(ComponentKind::kBoolean) || is(ComponentKind::kFloat);
    switch (type) {
        case XR_ACTION_TYPE_BOOLEAN_INPUT:
            if (is_number) { return std::string(path); }
            return firstOf({"/click", "/value"});
        case XR_ACTION_TYPE_FLOAT_INPUT:
            if (is_number) { return std::string(path); }
            return firstOf({"/value", "/click"});
        case XR_ACTION_TYPE_VECTOR2F_INPUT:
            if (firstOf({"/x"}) && firstOf({"/y"})) { return std::string(path); }
            return std::nullopt;
        case XR_ACTION_TYPE_POSE_INPUT:
            if (is(ComponentKind::kPose)) { return std::string(path); }
            return firstOf({"/pose"});
        default:
            if (is(ComponentKind::kVibration)) { return std::string(path); }
            return std::nullopt;
    }
}

}  // namespace

std::optional<BoundSource> bindSource(const Instance& instance, const Profile& profile, XrPath path,
                                      XrActionType type) {
    const std::string& text = instance.paths.textOf(path);
    const std::string_view user_path = userPathOf(text);
    const std::optional<std::size_t> device = deviceOf(user_path);
    if (!device) { return std::nullopt; }
    const std::optional<std::string> component =
        resolve(profile, user_path, std::string_view(text).substr(user_path.size()), type, instance);
    if (!component) { return std::nullopt; }
    const std::size_t start = component->find('/', 1) + 1;
    const std::size_t end = component->find('/', start);
    return BoundSource{path, instance.paths.findPath(user_path), *device,
                       component->substr(start, end - start), component->substr(start)};
}

}  // namespace simulated
