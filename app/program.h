// The whole program as a function.
#pragma once

namespace binosplat {

// Called by `main` with its arguments, the first being the program's name; returns the exit code. Only once
// in a process.
int runProgram(int argument_count, const char* const* arguments);

}  // namespace binosplat
