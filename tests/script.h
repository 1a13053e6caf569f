// Tests that are scripts: commands with their expected results, in NAME_test.txt next to NAME_test.cpp.
// docs/development.md says how to write one.
#pragma once

#include "tests/suite.h"

namespace binosplat::test {

struct Outcome {
    int exit_code = -1;
    std::string output, errors;
};

// What a suite's scripts run on.
struct ScriptHost {
    // Executes `> WORDS`. The environment is NAME=VALUE ..., as for `env`.
    std::function<Outcome(const std::string& words, const std::string& environment)> run;
    fs::path folder{};                           // where a script's files are
    std::string errors_begin{};                  // every line of error begins with this
    std::map<std::string, std::string> names{};  // values of $NAME
    // `[NAME] LINE` is for builds that have NAME, `[!NAME] LINE` for others
    std::set<std::string> features{};
    // Additional words that can begin a line.
    std::map<std::string, std::function<void(const std::string&)>> verbs{};
};

// The result of `action`, or the error that it throws.
Outcome tried(const std::function<std::string()>& action);

// Replaces a script's \n, \t, \r and \xNN.
std::string unescaped(const std::string& text);
// The text after `FROM => TO`, in which FROM must occur; if FROM is empty, TO is appended.
std::string edited(std::string text, const std::string& edit);

// Runs the case that is being executed.
void runScript(const ScriptHost& host);

// Every case of tests/PATH_test.txt becomes one of this suite.
int addScript(const char* suite, const std::string& path, void (*run)());

}  // namespace binosplat::test

// SCRIPT(cli, "app/cli") { ... runScript(host); }: for each case of tests/app/cli_test.txt.
#define SCRIPT(suite, path)                                                                 \
    void runOneScript();                                                                    \
    const int are_scripts_added = ::binosplat::test::addScript(#suite, path, runOneScript); \
    void runOneScript()
