// The program's entry point.
#include "app/program.h"
#include "engine/platform.h"

#include <string>
#include <vector>

int main(int argument_count, char** arguments) {
    const std::vector<std::string> words = binosplat::programArguments(argument_count, arguments);
    std::vector<const char*> pointers;
    for (const std::string& word : words) { pointers.push_back(word.c_str()); }
    return binosplat::runProgram(static_cast<int>(pointers.size()), pointers.data());
}
