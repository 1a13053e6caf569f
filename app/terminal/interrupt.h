// Ctrl-C and SIGTERM: checked where work can stop, so that nothing half-written is left.
#pragma once

#include <string>

namespace binosplat {

// While one exists, SIGINT and SIGTERM only set a flag; a second signal ends the program as usual. The
// program has one.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    ~Interrupt();
};

// Not an Error, so that nobody handles it as one; runProgram catches it.
struct Interrupted {
    int signal;             // SIGINT or SIGTERM
    std::string written{};  // what is kept of the work; empty: nothing was written
};

// True if the flag is set.
bool isInterrupted();
// Throws Interrupted if it is. For the main thread, between steps of work that has no output yet.
void stopIfInterrupted();

}  // namespace binosplat
