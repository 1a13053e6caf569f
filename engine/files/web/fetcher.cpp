// One thread that runs curl's transfers; connections are kept between them, and shared if servers allow it
// (HTTP/2).
#include "engine/files/web/fetcher.h"

#include "engine/error.h"
#include "engine/files/web/transfer.h"

#include <algorithm>
#include <mutex>
#include <new>
#include <thread>
#include <utility>
#include <vector>

namespace binosplat {

namespace {

using Transfers = std::vector<std::unique_ptr<Transfer>>;

// Once in a process.
struct CurlLibrary {
    CurlLibrary() { curl_global_init(CURL_GLOBAL_DEFAULT); }
    CurlLibrary(const CurlLibrary&) = delete;
    CurlLibrary& operator=(const CurlLibrary&) = delete;
    ~CurlLibrary() { curl_global_cleanup(); }
    static void require() { static const CurlLibrary library; }
};

// The shortest time between two checks for stalled servers.
constexpr std::chrono::milliseconds kWatch(100), kIdle(10000);

}  // namespace

class Fetcher::Thread {
public:
    Thread(const WebCache& cache, const FetchSettings& settings) : cache_(cache), settings_(settings) {
        CurlLibrary::require();
        multi_.reset(curl_multi_init());
        if (multi_ == nullptr) { throw std::bad_alloc(); }
        curl_multi_setopt(multi_.get(), CURLMOPT_PIPELINING, CURLPIPE_MULTIPLEX);
        thread_ = std::thread([this] { run(); });
    }
    Thread(const Thread&) = delete;
    Thread& operator=(const Thread&) = delete;
    ~Thread() {
        {
            const std::lock_guard lock(mutex_);
            stops_ = true;
        }
        curl_multi_wakeup(multi_.get());
        thread_.join();
        for (const auto& transfer : running_) { curl_multi_remove_handle(multi_.get(), transfer->handle()); }
    }

    std::future<Fetched> request(FetchRequest request) {
        request.most_bytes = std::min(request.most_bytes, settings_.most_bytes);
        auto transfer = std::make_unique<Transfer>(cache_, settings_, tally_, std::move(request));
        std::future<Fetched> future = transfer->future();
        {
            const std::lock_guard lock(mutex_);
            asked_.push_back(std::move(transfer));
        }
        curl_multi_wakeup(multi_.get());
        return future;
    }

    [[nodiscard]] const FetchTally& tally() const { return tally_; }

private:
    void run() {
        while (takeAsked()) {
            startDue();
            int still_running = 0;
            curl_multi_perform(multi_.get(), &still_running);
            int left = 0;
            while (const CURLMsg* message = curl_multi_info_read(multi_.get(), &left)) {
                if (message->msg == CURLMSG_DONE) { end(message->easy_handle, message->data.result, false); }
            }
            Transfers::size_type at = 0;
            while (at < running_.size()) {
                if (!running_[at]->isStalled()) {
                    ++at;
                } else {
                    end(running_[at]->handle(), CURLE_OPERATION_TIMEDOUT, true);
                }
            }
            curl_multi_poll(multi_.get(), nullptr, 0, untilNext(), nullptr);
        }
    }

    // False if nobody is waiting any more.
    bool takeAsked() {
        const std::lock_guard lock(mutex_);
        std::ranges::move(asked_, std::back_inserter(waiting_));
        asked_.clear();
        return !stops_;
    }

    void startDue() {
        const Transfer::Clock::time_point now = Transfer::Clock::now();
        for (auto next = waiting_.begin(); next != waiting_.end() && running_.size() < settings_.at_once;) {
            if ((*next)->due() > now) {
                ++next;
                continue;
            }
            running_.push_back(std::move(*next));
            next = waiting_.erase(next);
            running_.back()->start();
            curl_multi_add_handle(multi_.get(), running_.back()->handle());
        }
    }

    void end(CURL* handle, CURLcode code, bool is_stalled) {
        const auto found =
            std::ranges::find(running_, handle, [](const auto& transfer) { return transfer->handle(); });
        std::unique_ptr<Transfer> transfer = std::move(*found);
        running_.erase(found);
        // It is judged before it is removed, which closes the connection of an interrupted one.
        const bool is_over = transfer->finish(code, is_stalled);
        curl_multi_remove_handle(multi_.get(), handle);
        if (!is_over) { waiting_.push_back(std::move(transfer)); }
    }

    // Milliseconds until something is due; incoming data, and curl's own timers, wake curl anyway.
    [[nodiscard]] int untilNext() const {
        auto pause = running_.empty() ? kIdle : std::min(kWatch, settings_.patience);
        const Transfer::Clock::time_point now = Transfer::Clock::now();
        if (running_.size() < settings_.at_once) {
            for (const auto& transfer : waiting_) {
                pause = std::min(
                    pause, std::max(std::chrono::ceil<std::chrono::milliseconds>(transfer->due() - now), {}));
            }
        }
        return static_cast<int>(pause.count());
    }

    const WebCache& cache_;
    const FetchSettings settings_;
    FetchTally tally_;
    std::unique_ptr<CURLM, CurlCloser<curl_multi_cleanup>> multi_;
    Transfers waiting_, running_;  // for the thread alone

    std::mutex mutex_;
    Transfers asked_;
    bool stops_ = false;
    std::thread thread_;
};

Fetcher::Fetcher(const WebCache& cache, const FetchSettings& settings)
    : thread_(std::make_unique<Thread>(cache, settings)) {}
Fetcher::~Fetcher() = default;

std::future<Fetched> Fetcher::request(FetchRequest request) { return thread_->request(std::move(request)); }

double Fetcher::share() const {
    const FetchTally& tally = thread_->tally();
    const std::uint64_t expected = tally.expected_bytes, got = tally.got_bytes;
    const std::size_t asked = tally.asked, sized = tally.sized;
    if (asked == 0) { return 0.0; }
    const double of_sized =
        expected == 0 ? 1.0 : std::min(1.0, static_cast<double>(got) / static_cast<double>(expected));
    return of_sized * static_cast<double>(sized) / static_cast<double>(asked);
}

}  // namespace binosplat
