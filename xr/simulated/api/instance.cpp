// Instances: checks on creation, the offered extensions, and names of results and structure types.
#include "xr/simulated/api/instance.h"

#include <algorithm>
#include <cstring>

#include "xr/simulated/api/api.h"
#include "xr/simulated/api/structures.h"
#include "xr/simulated/extensions.h"
#include "xr/simulated/names.h"

namespace simulated {
namespace {

std::vector<Extension> listOfferedExtensions(const Script& script) {
    std::vector<Extension> offered;
    for (const Extension& extension : kExtensions) {
        if (script.allowsExtension(extension.name)) { offered.push_back(extension); }
    }
    return offered;
}

// A broken script is reported when the instance is made; until then it does not remove extensions.
Script loadScriptBeforeInstance() {
    try {
        return loadScriptOfEnvironment();
    } catch (const ScriptError&) { return {}; }
}

void checkApplication(const XrApplicationInfo& application) {
    const auto isEnded = [](const auto& name) { return strnlen(name, sizeof name) < sizeof name; };
    require(isEnded(application.applicationName) && isEnded(application.engineName), XR_ERROR_NAME_INVALID,
            "a name is not terminated");
    require(!textOf(application.applicationName).empty(), XR_ERROR_NAME_INVALID,
            "the application has no name");
    textOf(application.engineName);
    const XrVersion version = application.apiVersion;
    require(XR_VERSION_MAJOR(version) == 1 && XR_VERSION_MINOR(version) <= 1,
            XR_ERROR_API_VERSION_UNSUPPORTED, "the API version is ", XR_VERSION_MAJOR(version), ".",
            XR_VERSION_MINOR(version), ", this runtime implements OpenXR 1.0 and 1.1");
}

[[noreturn]] void refuseExtension(const char* name) {
    // Programs with another graphics API could not have a session here, so they are told at once what is
    // supported.
    for (const char* const graphics :
         {"XR_KHR_opengl_enable", "XR_KHR_opengl_es_enable", "XR_MNDX_egl_enable", "XR_KHR_metal_enable"}) {
        if (std::strcmp(name, graphics) != 0) { continue; }
        refuse(XR_ERROR_EXTENSION_NOT_PRESENT, name,
               ": this runtime has Vulkan alone, XR_KHR_vulkan_enable2 or XR_KHR_vulkan_enable");
    }
    throw Refusal{XR_ERROR_EXTENSION_NOT_PRESENT, name};
}

std::set<std::string, std::less<>> checkExtensions(const XrInstanceCreateInfo& info, const Script& script) {
    const std::vector<Extension> offered = listOfferedExtensions(script);
    std::set<std::string, std::less<>> names;
    for (const char* const name :
         checkArray(info.enabledExtensionNames, info.enabledExtensionCount, "extension names")) {
        require(name != nullptr, XR_ERROR_VALIDATION_FAILURE, "an extension name is missing");
        const auto isIt = [&](const Extension& one) { return std::strcmp(one.name, name) == 0; };
        if (std::ranges::none_of(offered, isIt)) { refuseExtension(name); }
        names.emplace(name);
    }
    return names;
}

template <std::size_t size, class Value>
void spell(char* buffer, const char* unknown_prefix, Value value) {
    require(buffer != nullptr, XR_ERROR_VALIDATION_FAILURE, "a buffer is missing");
    const char* const name = nameOf(value);
    copyText(*reinterpret_cast<char(*)[size]>(buffer),
             name != nullptr ? name : unknown_prefix + std::to_string(static_cast<int>(value)));
}

}  // namespace

void checkNotLost(const Instance& instance) {
    require(!instance.lost_from || instance.simulation->clock.now() < *instance.lost_from,
            XR_ERROR_INSTANCE_LOST, "the script lost the instance");
}

XrResult xrEnumerateApiLayerProperties(uint32_t propertyCapacityInput, uint32_t* propertyCountOutput,
                                       XrApiLayerProperties* properties) {
    // The loader knows the layers; a runtime has none.
    return answer(__func__, [&] { fillArray(propertyCapacityInput, propertyCountOutput, properties, {}); });
}

XrResult xrEnumerateInstanceExtensionProperties(const char* layerName, uint32_t propertyCapacityInput,
                                                uint32_t* propertyCountOutput,
                                                XrExtensionProperties* properties) {
    return answer(__func__, [&] {
        require(layerName == nullptr, XR_ERROR_API_LAYER_NOT_PRESENT, layerName, ": a runtime has no layers");
        const std::vector<Extension> offered = listOfferedExtensions(loadScriptBeforeInstance());
        if (!wantsArray(propertyCapacityInput, propertyCountOutput, properties, offered.size())) { return; }
        for (std::size_t i = 0; i < offered.size(); ++i) {
            checkType(properties[i], XR_TYPE_EXTENSION_PROPERTIES);
        }
        for (std::size_t i = 0; i < offered.size(); ++i) {
            copyText(properties[i].extensionName, offered[i].name);
            properties[i].extensionVersion = offered[i].version;
        }
    });
}

XrResult xrCreateInstance(const XrInstanceCreateInfo* createInfo, XrInstance* instance) {
    const CreationMessenger messenger(createInfo);
    return answer(__func__, [&] {
        const XrInstanceCreateInfo& info = checkStruct(createInfo, XR_TYPE_INSTANCE_CREATE_INFO);
        XrInstance& output = checkOutput(instance);
        require(info.createFlags == 0, XR_ERROR_VALIDATION_FAILURE, "createFlags is ", info.createFlags,
                ", no flags are known");
        // API layers are the loader's concern: it passes their names through, and a runtime ignores them.
        checkApplication(info.applicationInfo);
        auto created = std::make_unique<Instance>();
        require(root().children.empty(), XR_ERROR_LIMIT_REACHED, "one instance at a time");
        created->is_1_1 = XR_VERSION_MINOR(info.applicationInfo.apiVersion) >= 1;
        // Last, since it empties the output folder and takes over from a lost instance.
        created->extensions = checkExtensions(info, loadScriptOfEnvironment());
        created->simulation = Simulation::begin();
        output = handleOf(adopt(root(), std::move(created)));
    });
}

XrResult xrDestroyInstance(XrInstance instance) {
    return answer(__func__, [&] {
        destroyObject(get<Instance>(instance));
        sayTotals();
    });
}

XrResult xrGetInstanceProperties(XrInstance instance, XrInstanceProperties* instanceProperties) {
    return answerFor<Instance>(__func__, instance, [&](const Instance&) {
        XrInstanceProperties& properties = checkStruct(instanceProperties, XR_TYPE_INSTANCE_PROPERTIES);
        properties.runtimeVersion = XR_MAKE_VERSION(1, 0, 0);
        copyText(properties.runtimeName, "Simulated OpenXR runtime");
    });
}

XrResult xrResultToString(XrInstance instance, XrResult value, char buffer[XR_MAX_RESULT_STRING_SIZE]) {
    return answerFor<Instance>(__func__, instance, [&](const Instance&) {
        spell<XR_MAX_RESULT_STRING_SIZE>(
            buffer, XR_SUCCEEDED(value) ? "XR_UNKNOWN_SUCCESS_" : "XR_UNKNOWN_FAILURE_", value);
    });
}

XrResult xrStructureTypeToString(XrInstance instance, XrStructureType value,
                                 char buffer[XR_MAX_STRUCTURE_NAME_SIZE]) {
    return answerFor<Instance>(__func__, instance, [&](const Instance&) {
        spell<XR_MAX_STRUCTURE_NAME_SIZE>(buffer, "XR_UNKNOWN_STRUCTURE_TYPE_", value);
    });
}

}  // namespace simulated
