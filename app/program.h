// The whole program as a function.
#pragma once

namespace binosplat {

// What `main` does: arguments as it has them, the first is the program's name; returns the exit code. Once in a process.
int runProgram(int argument_count, const char* const* arguments);

}  // namespace binosplat
