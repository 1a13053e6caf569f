// Runs glslang's command line tool as the build does.
#include "app/view/shader_reload.h"

#include "engine/error.h"
#include "engine/platform.h"
#include "engine/temporary_folder.h"
#include "shaders/embedded_shaders.h"

#include <chrono>
#include <cstring>
#include <fstream>
#include <future>
#include <iterator>

namespace binosplat {

namespace {

namespace fs = std::filesystem;

std::vector<std::uint32_t> readWords(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    std::vector<std::uint32_t> words(bytes.size() / sizeof(std::uint32_t));
    if (!words.empty()) { std::memcpy(words.data(), bytes.data(), words.size() * sizeof(std::uint32_t)); }
    return words;
}

// The first complaint in what glslang printed, "ERROR: FILE:LINE: REASON".
std::string firstError(const fs::path& log, const fs::path& source) {
    std::ifstream lines(log, std::ios::binary);
    const std::string mark = "ERROR: ";
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with(mark)) { return line.substr(mark.size()); }
    }
    return source.string() + " does not compile";
}

std::vector<std::uint32_t> compileShader(const fs::path& folder, const std::string& stage,
                                         const std::string& name, const fs::path& scratch) {
    const fs::path source = folder / stage / (name + ".comp"), words = scratch / (name + ".spv"),
                   log = scratch / (name + ".log");
    std::error_code ignored;
    check(fs::exists(source, ignored), "{} is not there", source.string());
    // The compiler would wait for a pipe.
    check(fs::is_regular_file(source, ignored), "{} is not a file", source.string());
    // As in shaders/CMakeLists.txt. The compiler comes with the package glslang-tools.
    const bool ok = runProgram(
        {"glslangValidator", "--quiet", "--target-env", "vulkan1.2", "-I" + (folder / "shared").string(),
         "-I" + folder.string(), "-o", words.string(), source.string()},
        log);
    check(ok, "{}", firstError(log, source));
    return readWords(words);
}

}  // namespace

fs::path shaderFolder(const fs::path& folder) {
    return folder.empty() ? fs::path(environment("BINOSPLAT_SHADERS")) : folder;
}

ShaderWords compileShaders(const fs::path& folder) {
    const TemporaryFolder scratch("binosplat-shaders-", "compiled shaders");
    std::vector<std::pair<std::string, std::future<std::vector<std::uint32_t>>>> results;
    for (const auto& [stage, name] : embeddedShaderNames()) {
        results.emplace_back(name, std::async(std::launch::async, compileShader, folder, std::string(stage),
                                              std::string(name), scratch.path()));
    }
    ShaderWords shaders;
    for (auto& [name, words] : results) { shaders[name] = words.get(); }
    return shaders;
}

std::string reloadShaders(const Context& context, const fs::path& folder,
                          const std::function<void()>& rebuild) {
    const auto start = std::chrono::steady_clock::now();
    ShaderWords before;
    bool replaced = false;
    try {
        ShaderWords shaders = compileShaders(folder);
        const std::size_t count = shaders.size();
        before = std::exchange(context.replacedShaders(), std::move(shaders));
        replaced = true;
        rebuild();
        const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - start;
        return fmt::format("{} shaders reloaded in {:.0f} ms", count, taken.count());
    } catch (const Error& error) {
        if (replaced) {
            context.replacedShaders() = std::move(before);
            rebuild();
        }
        return fmt::format("shaders stay as they were: {}", error.what());
    }
}

}  // namespace binosplat
