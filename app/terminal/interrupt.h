// Ctrl-C and SIGTERM: asked for where work can stop, so that nothing half-written is left.
#pragma once

namespace binosplat {

// While one lives, SIGINT and SIGTERM only set a mark; the second one ends the program as ever. One within another does nothing.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    ~Interrupt();

    [[nodiscard]] bool came() const;
};

// No error, so that nobody takes it for one: `main` alone catches it.
struct Interrupted {
    int signal;  // SIGINT or SIGTERM
};

// Throws Interrupted if the mark is set. For the main thread, between steps of work that has nothing to show yet.
void stopIfInterrupted();

}  // namespace binosplat
