// Runs the program in a fork of a test program that is linked with it.
#include "app/program.h"
#include "tests/run_program.h"

#ifdef BINOSPLAT_OPENIMAGEIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <OpenImageIO/imageio.h>
#pragma GCC diagnostic pop
#endif

#include <dlfcn.h>
#include <fcntl.h>
#include <wordexp.h>

#include <csignal>
#include <iostream>
#include <regex>

namespace binosplat::test {
namespace {

std::ptrdiff_t countThreads() {
    return std::distance(fs::directory_iterator("/proc/self/task"), fs::directory_iterator());
}
// Threads that libraries (OpenImageIO's log4cplus) start when loaded and never need again. A fork lacks them.
const std::ptrdiff_t threads_of_libraries = countThreads();

// The words as the shell splits them; false if the text needs a shell: redirections, pipes, jobs.
bool areWords(const std::string& text, wordexp_t& words) {
    return wordexp(text.c_str(), &words, WRDE_NOCMD | WRDE_UNDEF) == 0;
}

bool isOneCommand(const std::string& text) { return text.find_first_of("|&;<>(){}`\n") == std::string::npos; }

void redirect(int descriptor, const fs::path& file) {
    const int opened = open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    if (opened < 0 || dup2(opened, descriptor) < 0) { _exit(126); }
    close(opened);
}

[[noreturn]] void runHere(const std::string& arguments, const std::string& environment) {
    wordexp_t words{}, variables{};
    if (!areWords(environment, variables) || !areWords("binosplat " + arguments, words)) { _exit(126); }
    for (std::size_t i = 0; i < variables.we_wordc; ++i) {
        const std::string variable = variables.we_wordv[i];
        const std::size_t equals = variable.find('=');
        setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
    }
    words.we_wordv[0] = strdup(BINOSPLAT_PROGRAM);
    const int code = runProgram(static_cast<int>(words.we_wordc), words.we_wordv);
    std::fflush(nullptr);
    _exit(code);  // `exit` would wait for the libraries' threads
}

int runInFork(const std::string& arguments, const std::string& environment, const fs::path& folder,
              const fs::path& outputs) {
    if (countThreads() != threads_of_libraries || !isOneCommand(arguments) || !isOneCommand(environment)) {
        return -1;
    }
    std::cout << std::flush;
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child < 0) { return -1; }
    if (child == 0) {
        // Instead of the test's handlers.
        for (const int signal : {SIGINT, SIGILL, SIGFPE, SIGSEGV, SIGTERM, SIGABRT}) {
            std::signal(signal, SIG_DFL);
        }
        redirect(STDOUT_FILENO, outputs / "output");
        redirect(STDERR_FILENO, outputs / "errors");
        fs::current_path(folder);
        setenv("PWD", folder.c_str(), 1);
        runHere(arguments, environment);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {}
    return status;
}

// Loads what the loaders of Vulkan and OpenXR load in every run, if it is there: linking LLVM alone takes as
// long as a small frame. Drivers and layers are found as the loaders find them, by their manifests.
bool loadAhead() {
    dlopen("libVkLayer_khronos_validation.so", RTLD_NOW | RTLD_NODELETE);
    for (const char* folder : {"/usr/share/vulkan/icd.d", "/usr/share/vulkan/implicit_layer.d",
                               "/usr/share/openxr/1/api_layers/explicit.d"}) {
        std::error_code missing;
        for (const auto& manifest : fs::directory_iterator(folder, missing)) {
            std::ifstream file(manifest.path());
            const std::string text(std::istreambuf_iterator<char>(file), {});
            std::smatch path;
            if (std::regex_search(text, path, std::regex(R"-("library_path"\s*:\s*"([^"]+)")-"))) {
                dlopen(path[1].str().c_str(), RTLD_NOW | RTLD_NODELETE);
            }
        }
    }
    return true;
}

// OpenEXR's threads would outlive a picture that is read, and a process with threads cannot be forked.
bool readWithoutThreads() {
#ifdef BINOSPLAT_OPENIMAGEIO
    return OIIO::attribute("exr_threads", -1);
#else
    return true;
#endif
}

const bool is_set = loadAhead() && readWithoutThreads() && (run_in_fork = runInFork) != nullptr;

}  // namespace
}  // namespace binosplat::test
