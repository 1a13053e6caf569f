// A signal handler may only set a flag, and only a global one.
#include "app/terminal/interrupt.h"

#include "engine/platform.h"

#include <csignal>

namespace binosplat {

namespace {

volatile std::sig_atomic_t g_signal = 0;  // the signal received, or 0

void mark(int signal) {
    g_signal = signal;
    std::signal(signal, SIG_DFL);
}

}  // namespace

Interrupt::Interrupt() {
    g_signal = 0;
    std::signal(SIGINT, mark);
    std::signal(SIGTERM, mark);
    watchForEnd();
}

Interrupt::~Interrupt() {
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

bool isInterrupted() { return g_signal != 0; }

void stopIfInterrupted() {
    if (g_signal != 0) { throw Interrupted{g_signal, {}}; }
}

}  // namespace binosplat
