// XR_KHR_convert_timespec_time: between OpenXR's time and CLOCK_MONOTONIC.
#include "xr/simulated/api/api.h"
#include "xr/simulated/api/instance.h"
#include "xr/simulated/api/spaces.h"
#include "xr/simulated/api/structures.h"

namespace simulated {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

}  // namespace

XrResult xrConvertTimespecTimeToTimeKHR(XrInstance instance, const struct timespec* timespecTime,
                                        XrTime* time) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        require(timespecTime != nullptr, XR_ERROR_VALIDATION_FAILURE, "a time is missing");
        XrTime& output = checkOutput(time);
        const bool is_time = timespecTime->tv_sec >= 0 && timespecTime->tv_sec < INT64_MAX / kSecond - 1 &&
                             timespecTime->tv_nsec >= 0 && timespecTime->tv_nsec < kSecond;
        require(is_time, XR_ERROR_TIME_INVALID, timespecTime->tv_sec, " s ", timespecTime->tv_nsec,
                " ns is not a time of CLOCK_MONOTONIC");
        const XrTime converted = timespecTime->tv_sec * kSecond + timespecTime->tv_nsec -
                                 owner.simulation->clock.monotonicOffset();
        checkTime(converted);
        output = converted;
    });
}

XrResult xrConvertTimeToTimespecTimeKHR(XrInstance instance, XrTime time, struct timespec* timespecTime) {
    return answerFor<Instance>(__func__, instance, [&](Instance& owner) {
        struct timespec& output = checkOutput(timespecTime);
        checkTime(time);
        const std::int64_t offset = owner.simulation->clock.monotonicOffset();
        require(time < INT64_MAX - std::max<std::int64_t>(offset, 0) && time + offset >= 0,
                XR_ERROR_TIME_INVALID, "CLOCK_MONOTONIC does not have the time ", time);
        output.tv_sec = (time + offset) / kSecond;
        output.tv_nsec = static_cast<long>((time + offset) % kSecond);
    });
}

}  // namespace simulated
