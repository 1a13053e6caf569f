// Translates the engine's exceptions to the interface's codes and texts.
#pragma once

#include "engine/error.h"
#include "engine/library/binosplat.h"

#include <exception>

namespace binosplat {

// Thrown by Progress where a call that loads or draws was cancelled.
struct Cancelled {};

struct Failure {
    bsp_result code = BSP_ERROR_INPUT;
    std::string text;
};

// For the exception that is being handled.
Failure failureNow() noexcept;

// Becomes the thread's error text; returns the code.
bsp_result report(const Failure& failure) noexcept;

// Runs the body of an interface function.
template <typename Body>
bsp_result guarded(Body&& body) noexcept {
    try {
        return body();
    } catch (...) { return report(failureNow()); }
}

}  // namespace binosplat
