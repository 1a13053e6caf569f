// One request to a server, repeated as often as necessary. A file that broke off is resumed where it ended,
// if the server says which version it was (a strong ETag, RFC 9110, section 8.8.3) and sends the rest of the
// same version; otherwise it starts over.
#pragma once

#include "engine/files/web/fetcher.h"

#include <curl/curl.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>

namespace binosplat {

// Releases what curl made.
template <auto kClose>
struct CurlCloser {
    void operator()(auto* made) const { kClose(made); }
};

// For all transfers together: bytes that have come and bytes to come.
struct FetchTally {
    std::atomic<std::uint64_t> got_bytes = 0, expected_bytes = 0;
    std::atomic<std::size_t> asked = 0, sized = 0;  // files, and those of known length
    // Whether the first server is on a private network; only curl's thread uses it.
    std::optional<bool> began_private;
};

// Must not move: curl has its address.
class Transfer {
public:
    using Clock = std::chrono::steady_clock;

    Transfer(const WebCache& cache, const FetchSettings& settings, FetchTally& tally, FetchRequest request);
    Transfer(const Transfer&) = delete;
    Transfer& operator=(const Transfer&) = delete;

    [[nodiscard]] CURL* handle() const { return easy_.get(); }
    [[nodiscard]] std::future<Fetched> future() { return promise_.get_future(); }
    [[nodiscard]] Clock::time_point due() const { return due_; }  // not before that

    // Before it is given to curl.
    void start();
    // True if too little has come for too long.
    [[nodiscard]] bool isStalled();
    // With curl's result, or as stalled. True if it is over; otherwise it is to be started again when it is
    // due.
    [[nodiscard]] bool finish(CURLcode code, bool is_stalled = false);

private:
    static int checkServer(void* transfer, char* ip, char* own_ip, int port, int own_port);
    static std::size_t writeBody(char* data, std::size_t size, std::size_t count, void* transfer);
    [[nodiscard]] std::string ipOfServer(const std::string& ip, int port) const;
    std::size_t take(const char* data, std::size_t bytes);
    // False, with the reason, if the body cannot be used.
    [[nodiscard]] bool beginBody();
    struct ContentRange {
        std::uint64_t first = 0, total = 0;
    };
    [[nodiscard]] std::optional<ContentRange> contentRange() const;
    // True if the answer (206) is the rest of the existing bytes.
    [[nodiscard]] bool isTheRest() const;
    // The rest was requested, and the answer says that the server cannot provide it.
    [[nodiscard]] bool isNoRest() const;
    [[nodiscard]] bool canGoOn() const;
    // True if the body is packed on its way: the lengths and places that the server states are then not the
    // file's.
    [[nodiscard]] bool isEncoded() const;
    [[nodiscard]] bool exceedsCache(std::uint64_t bytes) const;
    [[nodiscard]] std::string cacheLimit() const;
    void setHeaders();
    [[nodiscard]] long status() const;
    [[nodiscard]] std::string header(const char* name) const;
    // True if the answer says how long the body is, or where it ends.
    [[nodiscard]] bool saysLength() const;
    // Short, of letters that can be printed.
    static bool isPlain(const std::string& text);
    [[nodiscard]] FileVersion versionSent() const;
    // Empty: another attempt may succeed.
    [[nodiscard]] std::optional<Fetched> judge(CURLcode code, bool is_stalled);
    [[nodiscard]] std::string describe(CURLcode code, bool is_stalled) const;
    void startOver();

    const WebCache& cache_;
    const FetchSettings& settings_;
    FetchTally& tally_;
    FetchRequest request_;
    std::promise<Fetched> promise_;
    std::unique_ptr<CURL, CurlCloser<curl_easy_cleanup>> easy_;
    std::unique_ptr<curl_slist, CurlCloser<curl_slist_free_all>> headers_;
    std::array<char, CURL_ERROR_SIZE> error_{};

    // An attempt that brought this much, and whose rest can be requested, does not count: large files may
    // break off often.
    static constexpr std::uint64_t kWorthwhileBytes = 1 << 20;
    int attempts_ = 0;  // since the last one that does not count
    // With this much of the file, the next one does not count; it never falls, or a server whose file is
    // always a different one would be asked forever.
    std::uint64_t worthwhile_bytes_ = kWorthwhileBytes;
    Clock::time_point due_{}, watched_since_{};
    std::uint64_t got_bytes_ = 0, watched_bytes_ = 0, expected_bytes_ = 0;
    bool is_sized_ = false;    // the server has stated its length
    bool is_unpacked_ = true;  // according to Content-Encoding
    std::unique_ptr<IncomingFile> file_;
    FileVersion version_;  // of the bytes in file_
    // How many are from earlier attempts; more than 0: only the rest was requested.
    std::uint64_t kept_bytes_ = 0;
    std::string refused_;  // why the body was not used
};

}  // namespace binosplat
