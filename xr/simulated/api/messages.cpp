// Messengers, labels and object names of XR_EXT_debug_utils, and the queue of messages.
#include "xr/simulated/api/messages.h"

#include <algorithm>
#include <cstring>
#include <span>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/session.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr XrDebugUtilsMessageSeverityFlagsEXT kSeverities =
    XR_DEBUG_UTILS_MESSAGE_SEVERITY_VERBOSE_BIT_EXT | XR_DEBUG_UTILS_MESSAGE_SEVERITY_INFO_BIT_EXT |
    XR_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
constexpr XrDebugUtilsMessageTypeFlagsEXT kTypes =
    XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT | XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT |
    XR_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT | XR_DEBUG_UTILS_MESSAGE_TYPE_CONFORMANCE_BIT_EXT;

// A message for one messenger, with all that it points to.
struct Pending {
    PFN_xrDebugUtilsMessengerCallbackEXT callback;
    void* user_data;
    XrDebugUtilsMessageSeverityFlagsEXT severity;
    XrDebugUtilsMessageTypeFlagsEXT types;
    std::optional<std::string> id, function;
    std::string text;
    std::vector<std::string> labels;
    std::vector<std::pair<XrDebugUtilsObjectNameInfoEXT, std::optional<std::string>>> objects;
};

std::optional<std::string> copyOf(const char* text) {
    return text == nullptr ? std::nullopt : std::optional<std::string>(text);
}
const char* pointerTo(const std::optional<std::string>& text) { return text ? text->c_str() : nullptr; }

std::vector<Pending>& getPending() {
    thread_local std::vector<Pending> messages;
    return messages;
}

const XrDebugUtilsMessengerCreateInfoEXT*& getCreationMessenger() {
    thread_local const XrDebugUtilsMessengerCreateInfoEXT* messenger = nullptr;
    return messenger;
}

void queueFor(const Pending& message, const XrDebugUtilsMessengerCreateInfoEXT& messenger) {
    if ((messenger.messageSeverities & message.severity) == 0 ||
        (messenger.messageTypes & message.types) == 0) {
        return;
    }
    getPending().push_back(message);
    getPending().back().callback = messenger.userCallback;
    getPending().back().user_data = messenger.userData;
}

void queueForAll(const Pending& message) {
    if (const auto* const creation = getCreationMessenger()) { queueFor(message, *creation); }
    for (const auto& instance : root().children) {
        for (const auto& child : instance->children) {
            if (const auto* const messenger = dynamic_cast<const Messenger*>(child.get())) {
                queueFor(message, messenger->info);
            }
        }
    }
}

std::vector<std::string> labelsOf(const Instance* instance) {
    std::vector<std::string> labels;
    if (instance == nullptr || instance->session == nullptr) { return labels; }
    const Labels& current = instance->session->labels;
    if (current.inserted) { labels.push_back(*current.inserted); }
    labels.insert(labels.end(), current.regions.rbegin(), current.regions.rend());
    return labels;
}

const XrDebugUtilsMessengerCreateInfoEXT& checkMessenger(const XrDebugUtilsMessengerCreateInfoEXT* info) {
    const auto& checked_info = checkStruct(info, XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT);
    checkFlags(checked_info.messageSeverities, kSeverities, "messageSeverities");
    checkFlags(checked_info.messageTypes, kTypes, "messageTypes");
    require(checked_info.userCallback != nullptr, XR_ERROR_VALIDATION_FAILURE, "no callback");
    return checked_info;
}

std::string checkLabel(const XrDebugUtilsLabelEXT* label) {
    const auto& info = checkStruct(label, XR_TYPE_DEBUG_UTILS_LABEL_EXT);
    require(info.labelName != nullptr, XR_ERROR_VALIDATION_FAILURE, "a label has no name");
    return info.labelName;
}

bool wantsMessages(const XrInstanceCreateInfo& info) {
    if (info.enabledExtensionNames == nullptr) { return false; }
    return std::ranges::any_of(
        std::span(info.enabledExtensionNames, info.enabledExtensionCount), [](const char* name) {
            return name != nullptr && std::strcmp(name, XR_EXT_DEBUG_UTILS_EXTENSION_NAME) == 0;
        });
}

}  // namespace

CreationMessenger::CreationMessenger(const XrInstanceCreateInfo* info) {
    if (info == nullptr || info->type != XR_TYPE_INSTANCE_CREATE_INFO || !wantsMessages(*info)) { return; }
    const auto* link = static_cast<const XrBaseInStructure*>(info->next);
    for (int i = 0; link != nullptr && i < 64; ++i, link = link->next) {
        if (link->type != XR_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT) { continue; }
        const auto* const found = reinterpret_cast<const XrDebugUtilsMessengerCreateInfoEXT*>(link);
        if (found->userCallback != nullptr) { getCreationMessenger() = found; }
        return;
    }
}

CreationMessenger::~CreationMessenger() { getCreationMessenger() = nullptr; }

void queueMessage(XrDebugUtilsMessageTypeFlagsEXT type, const char* id, const char* function,
                  const std::string& text) {
    const Instance* const instance =
        root().children.empty() ? nullptr : dynamic_cast<const Instance*>(root().children.front().get());
    queueForAll({nullptr,
                 nullptr,
                 XR_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
                 type,
                 id,
                 function,
                 text,
                 labelsOf(instance),
                 {}});
}

void deliverMessages() {
    // A callback may queue more messages.
    for (const Pending& message : std::exchange(getPending(), {})) {
        std::vector<XrDebugUtilsLabelEXT> labels;
        for (const std::string& label : message.labels) {
            labels.push_back({XR_TYPE_DEBUG_UTILS_LABEL_EXT, nullptr, label.c_str()});
        }
        std::vector<XrDebugUtilsObjectNameInfoEXT> objects;
        for (const auto& [object, name] : message.objects) {
            objects.push_back(object);
            objects.back().objectName = pointerTo(name);
        }
        const XrDebugUtilsMessengerCallbackDataEXT data{XR_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT,
                                                        nullptr,
                                                        pointerTo(message.id),
                                                        pointerTo(message.function),
                                                        message.text.c_str(),
                                                        static_cast<std::uint32_t>(objects.size()),
                                                        objects.data(),
                                                        static_cast<std::uint32_t>(labels.size()),
                                                        labels.data()};
        message.callback(message.severity, message.types, &data, message.user_data);
    }
}

XrResult xrCreateDebugUtilsMessengerEXT(XrInstance instance,
                                        const XrDebugUtilsMessengerCreateInfoEXT* createInfo,
                                        XrDebugUtilsMessengerEXT* messenger) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        const XrDebugUtilsMessengerCreateInfoEXT& info = checkMessenger(createInfo);
        XrDebugUtilsMessengerEXT& output = checkOutput(messenger);
        auto created = std::make_unique<Messenger>();
        created->info = info;
        output = handleOf(adopt(owner, std::move(created)));
    });
}

XrResult xrDestroyDebugUtilsMessengerEXT(XrDebugUtilsMessengerEXT messenger) {
    return answer(__func__, [&] { destroyObject(get<Messenger>(messenger)); });
}

XrResult xrSubmitDebugUtilsMessageEXT(XrInstance instance,
                                      XrDebugUtilsMessageSeverityFlagsEXT messageSeverity,
                                      XrDebugUtilsMessageTypeFlagsEXT messageTypes,
                                      const XrDebugUtilsMessengerCallbackDataEXT* callbackData) {
    return answerFor<Instance>(__func__, instance, [&](const Instance& owner) {
        const auto& data = checkStruct(callbackData, XR_TYPE_DEBUG_UTILS_MESSENGER_CALLBACK_DATA_EXT);
        checkFlags(messageSeverity, kSeverities, "messageSeverity");
        checkFlags(messageTypes, kTypes, "messageTypes");
        require(data.message != nullptr, XR_ERROR_VALIDATION_FAILURE, "there is no message");
        require(data.objects != nullptr || data.objectCount == 0, XR_ERROR_VALIDATION_FAILURE,
                "an array of objects is missing");
        require(data.sessionLabels != nullptr || data.sessionLabelCount == 0, XR_ERROR_VALIDATION_FAILURE,
                "an array of labels is missing");
        // The application's message is unchanged, except for the names of objects; missing parts are filled
        // in.
        Pending message{nullptr,
                        nullptr,
                        messageSeverity,
                        messageTypes,
                        copyOf(data.messageId),
                        copyOf(data.functionName),
                        data.message,
                        {},
                        {}};
        for (std::uint32_t i = 0; i < data.sessionLabelCount; ++i) {
            message.labels.push_back(checkLabel(&data.sessionLabels[i]));
        }
        if (message.labels.empty()) { message.labels = labelsOf(&owner); }
        for (std::uint32_t i = 0; i < data.objectCount; ++i) {
            const auto& object = data.objects[i];
            // The registered name wins, as in the loader's own messengers.
            const auto registered = owner.object_names.find({object.objectType, object.objectHandle});
            message.objects.emplace_back(object, registered == owner.object_names.end()
                                                     ? copyOf(object.objectName)
                                                     : registered->second);
        }
        queueForAll(message);
    });
}

XrResult xrSetDebugUtilsObjectNameEXT(XrInstance instance, const XrDebugUtilsObjectNameInfoEXT* nameInfo) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        const auto& info = checkStruct(nameInfo, XR_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT);
        require(info.objectType != XR_OBJECT_TYPE_UNKNOWN && info.objectHandle != 0,
                XR_ERROR_VALIDATION_FAILURE, "no object to name");
        const std::pair key(info.objectType, info.objectHandle);
        if (info.objectName == nullptr || *info.objectName == '\0') {
            owner.object_names.erase(key);
        } else {
            owner.object_names[key] = info.objectName;
        }
    });
}

XrResult xrSessionBeginDebugUtilsLabelRegionEXT(XrSession session, const XrDebugUtilsLabelEXT* labelInfo) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        owner.labels.regions.push_back(checkLabel(labelInfo));
        owner.labels.inserted.reset();
    });
}

XrResult xrSessionEndDebugUtilsLabelRegionEXT(XrSession session) {
    return answerFor<Session>(__func__, session, [&](Session& owner) {
        owner.labels.inserted.reset();
        if (!owner.labels.regions.empty()) { owner.labels.regions.pop_back(); }
    });
}

XrResult xrSessionInsertDebugUtilsLabelEXT(XrSession session, const XrDebugUtilsLabelEXT* labelInfo) {
    return answerFor<Session>(__func__, session,
                              [&](Session& owner) { owner.labels.inserted = checkLabel(labelInfo); });
}

}  // namespace simulated
