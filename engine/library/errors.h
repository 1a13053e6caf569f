// Between the engine's exceptions and the interface's codes and texts.
#pragma once

#include "engine/error.h"
#include "engine/library/binosplat.h"

#include <exception>

namespace binosplat {

// Of a call that loads or draws, as told by Progress.
struct Cancelled {};

struct Failure {
    bsp_result code = BSP_ERROR_INPUT;
    std::string text;
};

// Of the exception that is being handled.
Failure failureNow() noexcept;

// From now on the thread's error text; returns the code.
bsp_result report(const Failure& failure) noexcept;

// Runs what a function of the interface does.
template <typename Body>
bsp_result guarded(Body&& body) noexcept {
    try {
        return body();
    } catch (...) { return report(failureNow()); }
}

}  // namespace binosplat
