// Runs work over blocks on a few threads, with a stable counting sort on top. Results never depend on the
// number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <mutex>
#include <span>
#include <thread>
#include <utility>
#include <vector>

namespace binosplat {

// Calls work(begin, end) for the blocks [0, block), [block, 2 block), ... of [0, count), each once, in no
// fixed order. The first exception is rethrown on the calling thread.
template <typename Work>
void forBlocks(std::size_t count, std::size_t block, int threads, const Work& work) {
    const std::size_t block_count = (count + block - 1) / block;
    std::atomic<std::size_t> next{0};
    std::exception_ptr failure;
    std::mutex failure_mutex;
    const auto drain = [&] {
        try {
            for (std::size_t i = next++; i < block_count; i = next++) {
                work(i * block, std::min(count, (i + 1) * block));
            }
        } catch (...) {
            const std::lock_guard lock(failure_mutex);
            failure = std::current_exception();
            next = block_count;
        }
    };
    {
        std::vector<std::jthread> helpers;
        const std::size_t wanted =
            std::min<std::size_t>(block_count, static_cast<std::size_t>(std::max(threads, 1)));
        for (std::size_t i = 1; i < wanted; ++i) { helpers.emplace_back(drain); }
        drain();
    }
    if (failure) { std::rethrow_exception(failure); }
}

// Moves `from` to `to` (same size) by ascending bucket(element) in [0, bucket_count), keeping the order
// within a bucket.
template <typename T, typename Bucket>
void sortByBucket(std::span<const T> from, std::span<T> to, std::size_t bucket_count, int threads,
                  const Bucket& bucket) {
    const std::size_t part_count = static_cast<std::size_t>(std::clamp(threads, 1, 16));
    const std::size_t part = std::max<std::size_t>(1, (from.size() + part_count - 1) / part_count);
    std::vector<std::vector<std::size_t>> places(part_count, std::vector<std::size_t>(bucket_count, 0));
    forBlocks(from.size(), part, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::size_t>& counts = places[begin / part];
        for (std::size_t i = begin; i < end; ++i) { ++counts[bucket(from[i])]; }
    });
    // Within a bucket, elements of an earlier part come before those of a later one.
    std::size_t sum = 0;
    for (std::size_t b = 0; b < bucket_count; ++b) {
        for (auto& counts : places) { sum += std::exchange(counts[b], sum); }
    }
    forBlocks(from.size(), part, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<std::size_t>& place = places[begin / part];
        for (std::size_t i = begin; i < end; ++i) { to[place[bucket(from[i])]++] = from[i]; }
    });
}

}  // namespace binosplat
