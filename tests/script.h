// Facts that are scripts: commands, and what comes of them, in NAME_test.txt beside NAME_test.cpp.
// docs/development.md says how one is written.
#pragma once

#include "tests/suite.h"

namespace binosplat::test {

struct Outcome {
    int exit_code = -1;
    std::string output, errors;
};

// What a suite's scripts run on.
struct ScriptHost {
    // What `> WORDS` does. The environment is NAME=VALUE ..., as `env` has it.
    std::function<Outcome(const std::string& words, const std::string& environment)> run;
    std::filesystem::path folder{};              // where a script's files lie
    std::string errors_begin{};                  // every line of error begins so
    std::map<std::string, std::string> names{};  // what $NAME stands for
    std::set<std::string> features{};            // `[NAME] LINE` is for builds that have it, `[!NAME] LINE` for others
    std::map<std::string, std::function<void(const std::string&)>> verbs{};  // more words that begin a line
};

// What `action` says, or the error that it throws.
Outcome tried(const std::function<std::string()>& action);

// What a script's \n, \t, \r and \xNN stand for.
std::string unescaped(const std::string& text);
// A text after `FROM => TO`, of which FROM is in it; without FROM it is TO that comes behind it.
std::string edited(std::string text, const std::string& edit);

// Runs the case that is under way.
void runScript(const ScriptHost& host);

// Every case of tests/PATH_test.txt becomes one of this suite.
int addScript(const char* suite, const std::string& path, void (*run)());

}  // namespace binosplat::test

// SCRIPT(cli, "app/cli") { ... runScript(host); }: for each case of tests/app/cli_test.txt.
#define SCRIPT(suite, path)                                                                 \
    void runOneScript();                                                                    \
    const int are_scripts_added = ::binosplat::test::addScript(#suite, path, runOneScript); \
    void runOneScript()
