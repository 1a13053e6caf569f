// Whether a thread's result is there.
#pragma once

#include <chrono>
#include <future>

namespace binosplat {

// Does not wait.
template <typename T>
[[nodiscard]] bool isReady(const std::future<T>& result) {
    return result.valid() && result.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace binosplat
