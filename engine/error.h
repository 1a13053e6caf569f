// Errors from outside (a file, a driver, a config): one exception class, thrown by `check` and `fail`, caught
// once in `main`. Programming errors are asserts; expected outcomes are std::optional or an enum.
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace binosplat {

// The exit codes of the program.
enum class ExitCode : int {
    kDone = 0,
    kBadInput = 1,  // a file, a value or the disk is at fault; one line says which
    kUsage = 2,     // the command line was not understood
    kNoDevice = 3,  // no usable GPU, OpenXR runtime or headset
};

// `what()` is one line: file, place, what is wrong, what was expected.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, std::string message)
        : std::runtime_error(oneLine(std::move(message))), code_(code) {}
    explicit Error(const std::string& message) : Error(ExitCode::kBadInput, message) {}
    [[nodiscard]] ExitCode code() const { return code_; }

private:
    // Names and values in a message come from outside and may contain anything.
    static std::string oneLine(std::string message) {
        for (char& letter : message) {
            if (static_cast<unsigned char>(letter) < ' ') { letter = ' '; }
        }
        return message;
    }

    ExitCode code_;
};

// Throws a bad-input Error with the formatted message.
template <typename... Args>
[[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) {
    throw Error(fmt::format(format, std::forward<Args>(args)...));
}

// Throws a bad-input Error with the formatted message unless `condition` holds.
template <typename... Args>
void check(bool condition, fmt::format_string<Args...> format, Args&&... args) {
    if (!condition) { fail(format, std::forward<Args>(args)...); }
}

}  // namespace binosplat
