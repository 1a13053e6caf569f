// Reads scripts, and runs their cases line by line.
#include "tests/script.h"

namespace binosplat::test {
namespace {

struct Line {
    std::size_t number;
    std::string text;
};
struct Script {
    std::string name, path;
    std::vector<Line> lines;
};
// By suite. Cases stay at their addresses, since doctest keeps pointers to their names.
std::map<std::string, std::list<Script>>& scripts() {
    static std::map<std::string, std::list<Script>> all;
    return all;
}

// The rest of a line, if it begins with this word.
std::optional<std::string> behind(const std::string& text, const std::string& word) {
    if (text != word && !text.starts_with(word + " ")) { return std::nullopt; }
    return text.substr(std::min(text.size(), word.size() + 1));
}

// "a | b c" or "a b".
std::vector<std::string> valuesOf(const std::string& text) {
    std::vector<std::string> values = wordsIn(text);
    if (!contains(text, " | ")) { return values; }
    values.clear();
    for (std::size_t begin = 0, end = 0; end != std::string::npos; begin = end + 3) {
        end = text.find(" | ", begin);
        values.push_back(text.substr(begin, end - begin));
    }
    return values;
}

// The values at a JSON pointer, in which * stands for each element of an array or an object.
void collect(const nlohmann::json& json, const std::string& pointer, std::vector<nlohmann::json>& found) {
    const std::size_t end = std::min(pointer.find('/', 1), pointer.size());
    if (pointer.empty()) {
        found.push_back(json);
    } else if (pointer.substr(0, end) == "/*") {
        for (const nlohmann::json& one : json) { collect(one, pointer.substr(end), found); }
    } else {
        collect(json.at(nlohmann::json::json_pointer(pointer.substr(0, end))), pointer.substr(end), found);
    }
}

bool holds(const nlohmann::json& found, const std::string& relation, const nlohmann::json& expected) {
    if (relation == "==") { return found == expected; }
    if (relation == "!=") { return found != expected; }
    if (relation == "<") { return found < expected; }
    if (relation == ">") { return found > expected; }
    if (relation == "<=") { return found <= expected; }
    if (relation == ">=") { return found >= expected; }
    if (relation == "size") { return found.size() == expected; }
    if (relation == "has") { return found.contains(expected.get<std::string>()); }
    if (relation == "lacks") { return !found.contains(expected.get<std::string>()); }
    if (relation == "about") { return found.get<double>() == doctest::Approx(expected.get<double>()); }
    FAIL(relation, " is no relation");
    return false;
}

class Run {
public:
    Run(const ScriptHost& host, const Script& script) : host_(host), script_(script), names_(host.names) {}

    void runLines(std::size_t begin, std::size_t end) {
        for (at_ = begin; at_ < end;) {
            const std::string text = lineAt(at_);
            const std::size_t number = script_.lines[at_].number;
            INFO(script_.path, ":", number, ": ", text);
            if (const auto loop = behind(text, "for")) {
                const std::size_t first = at_ + 1, behind_end = endOfLoop(first);
                const std::string name = loop->substr(0, loop->find(' '));
                for (const std::string& value : valuesOf(loop->substr(name.size() + 1))) {
                    names_[name] = value;
                    runLines(first, behind_end - 1);
                }
                at_ = behind_end;
            } else {
                ++at_;
                runLine(text);
            }
        }
    }

private:
    // The line with its names replaced; empty for a comment, or a line for another build.
    [[nodiscard]] std::string lineAt(std::size_t at) const {
        std::string text = script_.lines[at].text;
        if (text.starts_with('#')) { return ""; }
        if (text.starts_with('[')) {
            const std::size_t end = text.find(']');
            const bool is_not = text[1] == '!';
            if (host_.features.contains(text.substr(1 + is_not, end - 1 - is_not)) == is_not) { return ""; }
            text.erase(0, end + 2);
        }
        for (std::size_t dollar = 0; (dollar = text.find('$', dollar)) != std::string::npos; ++dollar) {
            const bool in_braces = text.substr(dollar, 2) == "${";
            const std::size_t begin = dollar + 1 + in_braces;
            const std::size_t end =
                std::min(text.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ_", begin), text.size());
            const auto name = names_.find(text.substr(begin, end - begin));
            if (name != names_.end()) { text.replace(dollar, end + in_braces - dollar, name->second); }
        }
        return text;
    }
    [[nodiscard]] std::size_t endOfLoop(std::size_t at) const {
        for (int depth = 1; depth > 0; ++at) {
            REQUIRE_MESSAGE(at < script_.lines.size(), "a loop does not end");
            const std::string& text = script_.lines[at].text;
            depth += behind(text, "for").has_value() - (text == "end");
        }
        return at;
    }
    // The lines that continue this one.
    std::string textOf(const std::string& mark) {
        std::string text;
        for (; at_ < script_.lines.size() && lineAt(at_).starts_with(mark); ++at_) {
            text += lineAt(at_).substr(mark.size()) + "\n";
        }
        return text;
    }
    [[nodiscard]] std::string bytesOf(const std::string& name) const { return textIn(host_.folder / name); }

    void runLine(const std::string& text) {
        if (text.empty()) { return; }
        if (const auto words = behind(text, ">")) {
            is_program_ = true;
            return runCommand(*words, [&] { return host_.run(*words, environment_); });
        }
        if (const auto command = behind(text, "$")) {
            is_program_ = false;
            return runCommand(*command, [&] { return runInShell(*command); });
        }
        INFO(command_, " wrote: ", outcome_.output, outcome_.errors);
        const auto begins = [&](const char* word) {
            const auto rest = behind(text, word);
            rest_ = unescaped(rest.value_or(""));
            return rest.has_value();
        };
        if (text.starts_with('!')) {
            checkRefused(text);
        } else if (begins("+")) {
            CHECK(contains(outcome_.output, rest_));
        } else if (begins("-")) {
            CHECK_FALSE(contains(outcome_.output, rest_));
        } else if (begins("~")) {
            CHECK((rest_.empty() ? outcome_.errors.empty() : contains(outcome_.errors, rest_)));
        } else if (begins("warned")) {
            CHECK(isOneLine(outcome_.errors));
            CHECK(contains(outcome_.errors, rest_));
        } else if (begins("once")) {
            const std::size_t first = outcome_.output.find(rest_);
            CHECK(first != std::string::npos);
            CHECK(outcome_.output.find(rest_, first + 1) == std::string::npos);
        } else if (begins("holds")) {
            const std::size_t space = rest_.find(' ');
            CHECK(contains(bytesOf(rest_.substr(0, space)), rest_.substr(space + 1)));
        } else if (text.starts_with("=")) {
            --at_;
            CHECK(outcome_.output == textOf("= "));
        } else if (begins("begins")) {
            CHECK(outcome_.output.starts_with(rest_));
        } else if (begins("write")) {
            fs::create_directories((host_.folder / rest_).parent_path());
            std::ofstream(host_.folder / rest_, std::ios::binary) << unescaped(textOf("    "));
        } else if (begins("env")) {
            environment_ = rest_;
        } else if (begins("let")) {
            names_[rest_.substr(0, rest_.find(' '))] = rest_.substr(rest_.find(' ') + 1);
        } else if (begins("files")) {
            checkFiles();
        } else if (begins("same")) {
            const auto words = wordsIn(rest_);
            CHECK(bytesOf(words.at(0)).size() > 0);
            for (const std::string& word : words) { CHECK_MESSAGE(bytesOf(word) == bytesOf(words[0]), word); }
        } else if (begins("differ")) {
            CHECK(bytesOf(wordsIn(rest_).at(0)) != bytesOf(wordsIn(rest_).at(1)));
        } else if (begins("absent")) {
            for (const std::string& word : wordsIn(rest_)) { CHECK_FALSE(fs::exists(host_.folder / word)); }
        } else if (begins("there")) {
            for (const std::string& word : wordsIn(rest_)) { CHECK(fs::exists(host_.folder / word)); }
        } else if (begins("json")) {
            checkJson();
        } else {
            const std::string verb = text.substr(0, text.find(' '));
            REQUIRE_MESSAGE(host_.verbs.contains(verb), verb, " begins no line of a script");
            host_.verbs.at(verb)(text.substr(std::min(text.size(), verb.size() + 1)));
        }
    }

    [[nodiscard]] Outcome runInShell(const std::string& command) const {
        const std::string log =
            (fs::temp_directory_path() / ("script-" + host_.folder.parent_path().filename().string()))
                .string();
        const std::string inner = "cd '" + host_.folder.string() + "' && { " + command + "; }";
        const int status = std::system((inner + " >'" + log + "' 2>'" + log + "-errors'").c_str());
        Outcome outcome{status / 256, textIn(log), textIn(log + "-errors")};
        for (const std::string& file : {log, log + "-errors"}) { fs::remove(file); }
        return outcome;
    }
    void runCommand(const std::string& words, const std::function<Outcome()>& run) {
        command_ = words;
        outcome_ = run();
        INFO(outcome_.output, outcome_.errors);
        std::size_t next = at_;
        while (next < script_.lines.size() && lineAt(next).empty()) { ++next; }
        const bool is_refused = next < script_.lines.size() && lineAt(next).starts_with('!');
        if (!is_refused) { REQUIRE(outcome_.exit_code == 0); }
    }
    // `! PART`, or `!CODE PART`: the command ended with this code and one line, which contains PART.
    void checkRefused(const std::string& text) {
        const std::size_t space = std::min(text.find(' '), text.size());
        CHECK(outcome_.exit_code == (space == 1 ? 1 : std::stoi(text.substr(1, space - 1))));
        CHECK(isOneLine(outcome_.errors));
        if (is_program_) { CHECK(outcome_.errors.starts_with(host_.errors_begin)); }
        CHECK(contains(outcome_.errors, unescaped(text.substr(std::min(space + 1, text.size())))));
    }
    void checkFiles() {
        std::set<std::string> names;
        for (const auto& entry : fs::recursive_directory_iterator(host_.folder)) {
            names.insert(entry.path().lexically_relative(host_.folder).generic_string());
        }
        const std::vector<std::string> expected = wordsIn(rest_);
        CHECK(names == std::set<std::string>(expected.begin(), expected.end()));
    }
    // FILE POINTER RELATION VALUE
    void checkJson() {
        std::istringstream words(rest_);
        std::string file, pointer, relation, value;
        words >> file >> pointer >> relation >> std::ws;
        std::getline(words, value);
        std::vector<nlohmann::json> found;
        const nlohmann::json json = nlohmann::json::parse(bytesOf(file));
        collect(json, pointer == "/" ? "" : pointer, found);
        CHECK(found.size() > 0);
        // @POINTER is another value of the same file.
        const nlohmann::json expected = value.starts_with('@')
                                            ? json.at(nlohmann::json::json_pointer(value.substr(1)))
                                            : nlohmann::json::parse(value);
        for (const nlohmann::json& one : found) { CHECK_MESSAGE(holds(one, relation, expected), one.dump()); }
    }

    const ScriptHost& host_;
    const Script& script_;
    std::map<std::string, std::string> names_;
    std::size_t at_ = 0;  // the next line
    std::string command_, environment_, rest_;
    Outcome outcome_;
    bool is_program_ = true;  // instead of the shell
};

}  // namespace

Outcome tried(const std::function<std::string()>& action) {
    try {
        return {0, action(), ""};
    } catch (const Error& error) {
        return {static_cast<int>(error.code()), "", std::string(error.what()) + "\n"};
    }
}

std::string unescaped(const std::string& text) {
    std::string plain;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '\\' || i + 1 == text.size()) {
            plain += text[i];
        } else if (const char c = text[++i]; c == 'x') {
            plain += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            plain += c == 'n' ? '\n' : c == 't' ? '\t' : c == 'r' ? '\r' : c;
        }
    }
    return plain;
}

std::string edited(std::string text, const std::string& edit) {
    const std::size_t arrow = edit.find(" =>");
    REQUIRE(arrow != std::string::npos);
    const std::string from = unescaped(edit.substr(0, arrow)),
                      to = unescaped(edit.substr(std::min(arrow + 4, edit.size())));
    const std::size_t at = from.empty() ? text.size() : text.find(from);
    REQUIRE_MESSAGE(at != std::string::npos, from);
    return text.replace(at, from.size(), to);
}

int addScript(const char* suite, const std::string& path, void (*run)()) {
    const std::string file = BINOSPLAT_SOURCE_DIR "/tests/" + path + "_test.txt";
    std::ifstream stream(file);
    std::list<Script>& cases = scripts()[suite];
    std::size_t number = 0;
    for (std::string text; std::getline(stream, text);) {
        ++number;
        const auto always = behind(text, "case"), at_night = behind(text, "nightly case");
        if (always || at_night) {
            cases.push_back({always ? *always : *at_night, "tests/" + path + "_test.txt", {}});
            doctest::detail::TestCase test(run, file.c_str(), static_cast<unsigned>(number),
                                           doctest::detail::TestSuite() * suite);
            test* cases.back().name.c_str();
            if (at_night) { test* nightly(); }
            doctest::detail::regTest(test);
        } else if (!cases.empty()) {
            cases.back().lines.push_back({number, text});
        }
    }
    return static_cast<int>(number);
}

void runScript(const ScriptHost& host) {
    const doctest::detail::TestCase& test = *doctest::getContextOptions()->currentTest;
    for (const Script& script : scripts()[test.m_test_suite]) {
        if (script.name == test.m_name) { return Run(host, script).runLines(0, script.lines.size()); }
    }
    FAIL("no case has this name");
}

}  // namespace binosplat::test
