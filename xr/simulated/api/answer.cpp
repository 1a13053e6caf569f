// The lock that every call takes, and messages about calls that were refused or failed.
#include "xr/simulated/api/answer.h"

#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>

#include "xr/simulated/api/messages.h"
#include "xr/simulated/environment.h"
#include "xr/simulated/names.h"

namespace simulated {
namespace {

struct Said {
    std::uint64_t times = 0, told = 0;
};

std::map<std::string, Said>& getSaidLines() {
    // Never destroyed: destructors at the end of the process may still have something to say.
    static auto& lines = *new std::map<std::string, Said>();
    return lines;
}

bool isPowerOfTen(std::uint64_t number) {
    while (number >= 10 && number % 10 == 0) { number /= 10; }
    return number == 1;
}

// The runtime's lock guards the lines that were said.
void say(const std::string& line) {
    // Limits the memory for a program whose lines are all different.
    constexpr std::size_t kMostLines = 1000;
    if (getSaidLines().size() == kMostLines && !getSaidLines().contains(line)) { sayTotals(); }
    Said& said = getSaidLines()[line];
    if (!isPowerOfTen(++said.times)) { return; }
    said.told = said.times;
    if (said.times == 1) {
        std::fprintf(stderr, "simulated runtime: %s\n", line.c_str());
    } else {
        std::fprintf(stderr, "simulated runtime: %s (%" PRIu64 " times so far)\n", line.c_str(), said.times);
    }
}

}  // namespace

std::mutex& getRuntimeLock() {
    static std::mutex lock;
    return lock;
}

void sayTotals() {
    for (const auto& [line, said] : getSaidLines()) {
        if (said.times > said.told) {
            std::fprintf(stderr, "simulated runtime: %s (%" PRIu64 " times in all)\n", line.c_str(),
                         said.times);
        }
    }
    getSaidLines().clear();
}

void append(std::string& reason, XrStructureType type) {
    if (const char* const name = nameOf(type)) {
        reason += name;
    } else {
        append(reason, static_cast<std::int64_t>(type));
    }
}

void explain(const char* function, const Refusal& refusal) {
    // A failure of the runtime itself is always reported: no application can know what to do about it. The
    // loader asks for every function that it knows, even without an instance after one was refused; that is
    // not the application's mistake.
    const bool is_loaders =
        std::strcmp(function, "xrGetInstanceProcAddr") == 0 && refusal.result != XR_ERROR_VALIDATION_FAILURE;
    if (!is_loaders) {
        queueMessage(XR_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT, nameOf(refusal.result), function,
                     refusal.reason);
    }
    const bool is_wanted = settingOf("EXPLAIN").is_there && !is_loaders;
    if (!is_wanted && refusal.result != XR_ERROR_RUNTIME_FAILURE) { return; }
    say(std::string(function) + ": " + nameOf(refusal.result) + ": " + refusal.reason);
}

void explainFailure(const char* function, const char* what) {
    queueMessage(XR_DEBUG_UTILS_MESSAGE_TYPE_GENERAL_BIT_EXT, nameOf(XR_ERROR_RUNTIME_FAILURE), function,
                 what);
    say(std::string(function) + ": " + what);
}

}  // namespace simulated
