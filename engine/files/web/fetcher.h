// Fetches files from the web, several at once, on a thread of its own. For a build without libcurl, see
// no_fetcher.cpp.
#pragma once

#include "engine/files/web/address.h"
#include "engine/files/web/web_cache.h"

#include <chrono>
#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <string>

namespace binosplat {

struct FetchSettings {
    using Milliseconds = std::chrono::milliseconds;
    std::uint64_t most_bytes = std::uint64_t{64} << 30;  // for one file
    // Limit for the whole cache; 0: nothing is kept, and downloads have no limit.
    std::uint64_t cache_bytes = 0;
    int attempts = 4;
    Milliseconds first_pause{500};   // before the second attempt, then doubled each time
    Milliseconds most_pause{20000};  // the longest that a server may ask for
    Milliseconds patience{20000};    // with a server that sends almost nothing
    std::size_t at_once = 8;
    // By a server's address; redirects from public servers must not lead there.
    std::function<bool(const std::string& ip)> is_private = isPrivateAddress;
};

struct FetchRequest {
    std::string address;
    FileVersion version;  // of the existing copy; empty: none
    std::uint64_t most_bytes = 0;
};

struct Fetched {
    enum class Kind {
        kNew,          // the whole file
        kUnchanged,    // the existing copy is still current
        kUnreachable,  // no server answers, or it cannot serve anyone at present
        kRefused,      // there is no such file, or it may not be taken
    };
    Kind kind = Kind::kRefused;
    std::string reason;  // for the last two: what is wrong and what to do; follows the address in messages
    std::unique_ptr<IncomingFile> file{};
    FileVersion version{};
};

class Fetcher {
public:
    // `cache` must outlive it. Throws Error in a build without network access.
    Fetcher(const WebCache& cache, const FetchSettings& settings);
    Fetcher(const Fetcher&) = delete;
    Fetcher& operator=(const Fetcher&) = delete;
    ~Fetcher();  // abandons what is on its way

    [[nodiscard]] std::future<Fetched> request(FetchRequest request);

    // The share that is done of everything requested so far, as far as servers have stated sizes.
    [[nodiscard]] double share() const;

private:
    class Thread;
    std::unique_ptr<Thread> thread_;
};

}  // namespace binosplat
