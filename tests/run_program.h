// Runs the program in a folder of its own.
#pragma once

#include "engine/platform.h"
#include "tests/script.h"

#ifndef _WIN32
#include <sys/wait.h>
#include <unistd.h>
#endif

namespace binosplat::test {

// Set by test programs that contain the program itself (fork_program.cpp): runs it in a fork of this process,
// which has already loaded and linked the libraries; that is a third of its start-up time. Returns -1 if a
// fork is not possible, otherwise the status from `waitpid`.
inline int (*run_in_fork)(const std::string& arguments, const std::string& environment,
                          const fs::path& folder, const fs::path& outputs) = nullptr;

// An empty folder to run in, removed with the test. On Windows, which has no POSIX shell, it is only a
// folder.
struct Workplace {
    fs::path base = makeBase();
    fs::path path = base / "work";

    Workplace() { fs::create_directories(path); }
    Workplace(const Workplace&) = delete;
    Workplace& operator=(const Workplace&) = delete;
    ~Workplace() {
        std::error_code ignored;
        fs::remove_all(base, ignored);
    }

#ifndef _WIN32
    // As in the shell: `arguments` may redirect, and `environment` is NAME=VALUE ... in front of the program.
    [[nodiscard]] Outcome run(const std::string& arguments, const std::string& environment = "") const {
        if (run_in_fork != nullptr) {
            if (const int status = run_in_fork(arguments, environment, path, base); status != -1) {
                return outcomeOf(status);
            }
        }
        return runCommand(environment + " '" BINOSPLAT_PROGRAM "' " + arguments);
    }

    // A run that must succeed.
    Outcome go(const std::string& arguments, const std::string& environment = "") const {
        Outcome outcome = run(arguments, environment);
        INFO(arguments << ": " << outcome.errors);
        REQUIRE(outcome.exit_code == 0);
        return outcome;
    }

    // A run that must end with this code and one line of error, which contains `part`.
    void checkRefused(const std::string& arguments, int exit_code, const std::string& part,
                      const std::string& environment = "") const {
        CAPTURE(environment);
        const Outcome outcome = run(arguments, environment);
        INFO(arguments << ": " << outcome.errors);
        CHECK(outcome.exit_code == exit_code);
        CHECK(isOneLine(outcome.errors));
        CHECK(outcome.errors.starts_with("binosplat: "));
        CHECK(contains(outcome.errors, part));
    }

    // Any shell command.
    [[nodiscard]] Outcome runCommand(const std::string& command) const {
        const std::string out = (base / "output").string(), errors = (base / "errors").string();
        return outcomeOf(std::system(
            ("cd '" + path.string() + "' && { " + command + "; } >'" + out + "' 2>'" + errors + "'")
                .c_str()));
    }
#endif

    [[nodiscard]] bool isEmpty() const { return fs::is_empty(path); }
    [[nodiscard]] bool holds(const std::string& name) const { return fs::exists(path / name); }
    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path / name, std::ios::binary) << text;
    }
    [[nodiscard]] std::string bytesOf(const std::string& name) const { return textIn(path / name); }
    // Everything in it, by paths relative to it.
    [[nodiscard]] std::set<std::string> files() const {
        std::set<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(path)) {
            names.insert(entry.path().lexically_relative(path).string());
        }
        return names;
    }

private:
#ifndef _WIN32
    [[nodiscard]] Outcome outcomeOf(int status) const {
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, textIn(base / "output"),
                textIn(base / "errors")};
    }
#endif
    static fs::path makeBase() { return createFolder(fs::temp_directory_path(), "binosplat-test-"); }
};

#ifndef _WIN32
// One whose user has settings of their own.
struct Home : Workplace {
    Home() { setenv("XDG_CONFIG_HOME", (base / "config").c_str(), 1); }
    ~Home() { unsetenv("XDG_CONFIG_HOME"); }
    [[nodiscard]] std::string at(const std::string& name) const { return (path / name).string(); }
};
#endif

// Of a library that need not be linked.
template <typename Function>
Function* functionIn(const char* library, const char* name) {
    void* const function = functionOf(library, name);
    REQUIRE_MESSAGE(function != nullptr, name);
    return reinterpret_cast<Function*>(function);
}

// For facts that use one: TEST_CASE_FIXTURE(AtWork, "...").
struct AtWork {
    const Workplace work;
};

}  // namespace binosplat::test
