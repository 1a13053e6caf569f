// A signal handler may only set a mark, and only a global one.
#include "app/interrupt.h"

#include <csignal>

namespace binosplat {

namespace {

volatile std::sig_atomic_t g_interrupted = 0;

void mark(int signal) {
    g_interrupted = 1;
    std::signal(signal, SIG_DFL);
}

}  // namespace

Interrupt::Interrupt() {
    g_interrupted = 0;
    std::signal(SIGINT, mark);
    std::signal(SIGTERM, mark);
}

Interrupt::~Interrupt() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

bool Interrupt::came() const { return g_interrupted != 0; }

}  // namespace binosplat
