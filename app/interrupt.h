// Ctrl-C, and a polite kill, as a question.
#pragma once

namespace binosplat {

// While one lives, SIGINT and SIGTERM only set a mark; the second one ends the program as ever.
class Interrupt {
public:
    Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;
    ~Interrupt();

    [[nodiscard]] bool came() const;
};

}  // namespace binosplat
