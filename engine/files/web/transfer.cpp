// Requests to curl, and what its results mean.
#include "engine/files/web/transfer.h"

#include "engine/address.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <string_view>
#include <utility>

namespace binosplat {

namespace {

constexpr long kMostRedirects = 5;
constexpr long kBufferBytes = 1 << 18;
constexpr std::uint64_t kLongestErrorPage = 1 << 16;
// Fewer bytes than this within the time limit count as none.
constexpr std::uint64_t kLeastBytes = 1024;
constexpr long kOk = 200, kPartial = 206, kNoSuchRange = 416;

// Another attempt may find the server in a better state.
bool isBusy(long status) {
    constexpr std::array kBusy{408l, 429l, 500l, 502l, 503l, 504l};
    return std::ranges::find(kBusy, status) != kBusy.end();
}

bool isCut(CURLcode code) {
    constexpr std::array kCut{
        CURLE_PARTIAL_FILE, CURLE_RECV_ERROR,   CURLE_SEND_ERROR,         CURLE_GOT_NOTHING,
        CURLE_HTTP2,        CURLE_HTTP2_STREAM, CURLE_OPERATION_TIMEDOUT, CURLE_SSL_CONNECT_ERROR};
    return std::ranges::find(kCut, code) != kCut.end();
}

bool isNoServer(CURLcode code) {
    return code == CURLE_COULDNT_RESOLVE_HOST || code == CURLE_COULDNT_RESOLVE_PROXY ||
           code == CURLE_COULDNT_CONNECT;
}

std::string explainStatus(long status) {
    if (status == 404 || status == 410) {
        return fmt::format("is not there (the server answers {}), expected the address of a scene file",
                           status);
    }
    if (status == 401 || status == 403) {
        return fmt::format(
            "may not be read (the server answers {}), expected an address that anybody may read", status);
    }
    return fmt::format("cannot be fetched (the server answers {}), expected the address of a scene file",
                       status);
}

}  // namespace

Transfer::Transfer(const WebCache& cache, const FetchSettings& settings, FetchTally& tally,
                   FetchRequest request)
    : cache_(cache),
      settings_(settings),
      tally_(tally),
      request_(std::move(request)),
      easy_(curl_easy_init()) {
    if (easy_ == nullptr) { throw std::bad_alloc(); }
    const auto set = [&](CURLoption option, auto value) { curl_easy_setopt(easy_.get(), option, value); };
    // Redirects that are never followed: to a file of this machine, and from a secure address to an insecure
    // one.
    const bool is_secure = request_.address.substr(0, 5).find_first_of("sS") != std::string::npos;
    set(CURLOPT_URL, request_.address.c_str());
    set(CURLOPT_PROTOCOLS_STR, "http,https");
    set(CURLOPT_REDIR_PROTOCOLS_STR, is_secure ? "https" : "http,https");
    set(CURLOPT_FOLLOWLOCATION, 1l);
    set(CURLOPT_MAXREDIRS, kMostRedirects);
    set(CURLOPT_DISALLOW_USERNAME_IN_URL, 1l);
    set(CURLOPT_PREREQFUNCTION, &Transfer::checkServer);
    set(CURLOPT_PREREQDATA, static_cast<void*>(this));
    set(CURLOPT_HTTP_VERSION, static_cast<long>(CURL_HTTP_VERSION_2TLS));
    set(CURLOPT_PIPEWAIT, 1l);
    set(CURLOPT_NOSIGNAL, 1l);
    set(CURLOPT_BUFFERSIZE, kBufferBytes);
    set(CURLOPT_USERAGENT, "binosplat");
    if (const std::string trusted = environment("SSL_CERT_FILE"); !trusted.empty()) {
        set(CURLOPT_CAINFO, trusted.c_str());
    }
    set(CURLOPT_ERRORBUFFER, error_.data());
    set(CURLOPT_WRITEFUNCTION, &Transfer::writeBody);
    set(CURLOPT_WRITEDATA, static_cast<void*>(this));
    set(CURLOPT_PRIVATE, static_cast<void*>(this));
    ++tally_.asked;
}

void Transfer::start() {
    ++attempts_;
    error_[0] = '\0';
    got_bytes_ = kept_bytes_ = file_ != nullptr ? file_->sizeBytes() : 0;
    setHeaders();
    watched_since_ = Clock::now();
    watched_bytes_ = got_bytes_;
}

void Transfer::setHeaders() {
    std::unique_ptr<curl_slist, CurlCloser<curl_slist_free_all>> headers;
    const auto add = [&](const char* name, const std::string& value) {
        if (value.empty() || !isPlain(value)) { return; }
        curl_slist* longer = curl_slist_append(headers.get(), fmt::format("{}: {}", name, value).c_str());
        if (longer == nullptr) { throw std::bad_alloc(); }
        (void)headers.release();
        headers.reset(longer);
    };
    // Files are requested whole and as they are, but some servers only have packed ones.
    add("Accept-Encoding", "identity");
    curl_easy_setopt(easy_.get(), CURLOPT_ACCEPT_ENCODING, is_unpacked_ ? "gzip, deflate" : nullptr);
    if (kept_bytes_ == 0) {
        add("If-None-Match", request_.version.etag);
        add("If-Modified-Since", request_.version.last_modified);
    } else {
        add("If-Range", version_.etag);
    }
    curl_easy_setopt(easy_.get(), CURLOPT_RANGE,
                     kept_bytes_ == 0 ? nullptr : fmt::format("{}-", kept_bytes_).c_str());
    curl_easy_setopt(easy_.get(), CURLOPT_HTTPHEADER, headers.get());
    headers_ = std::move(headers);
}

// The address of the server, to which curl is connected as `ip`; empty if that is a proxy's, since only the
// proxy knows it. A proxy on the server's very port is taken for the server.
std::string Transfer::ipOfServer(const std::string& ip, int port) const {
    char* text = nullptr;
    curl_easy_getinfo(easy_.get(), CURLINFO_EFFECTIVE_URL, &text);
    const std::unique_ptr<CURLU, CurlCloser<curl_url_cleanup>> url(curl_url());
    curl_url_set(url.get(), CURLUPART_URL, text, 0);
    const auto part = [&](CURLUPart which) {
        char* found = nullptr;
        curl_url_get(url.get(), which, &found, CURLU_DEFAULT_PORT);
        std::string copy = found != nullptr ? found : "";
        curl_free(found);
        return copy;
    };
    std::string host = part(CURLUPART_HOST);
    if (host.starts_with('[')) { host = host.substr(1, host.size() - 2); }
    if (parseIp(host)) { return host; }
    if (host.ends_with('.')) { host.pop_back(); }
    constexpr std::string_view kHere = "localhost";
    const bool is_here = host.size() >= kHere.size() &&
                         beginsWith(std::string_view(host).substr(host.size() - kHere.size()), kHere) &&
                         (host.size() == kHere.size() || host[host.size() - kHere.size() - 1] == '.');
    if (is_here) { return "127.0.0.1"; }
    return part(CURLUPART_PORT) == std::to_string(port) ? ip : "";
}

// A scene from a public server must not make us ask servers that only this machine or its network can reach.
int Transfer::checkServer(void* transfer, char* ip, char*, int port, int) {
    auto& self = *static_cast<Transfer*>(transfer);
    try {
        const std::string server = self.ipOfServer(ip, port);
        const bool is_private = !server.empty() && self.settings_.is_private(server);
        if (!self.tally_.began_private) { self.tally_.began_private = is_private; }
        if (!is_private || *self.tally_.began_private) { return CURL_PREREQFUNC_OK; }
        self.refused_ = fmt::format(
            "leads from the public web to {}, which is on a private network, expected a public server",
            server);
    } catch (const std::exception& error) {
        self.refused_ = fmt::format("cannot be fetched ({})", error.what());
    }
    return CURL_PREREQFUNC_ABORT;
}

bool Transfer::isStalled() {
    const Clock::time_point now = Clock::now();
    if (now - watched_since_ < settings_.patience) { return false; }
    if (got_bytes_ - watched_bytes_ < kLeastBytes) { return true; }
    watched_since_ = now;
    watched_bytes_ = got_bytes_;
    return false;
}

std::size_t Transfer::writeBody(char* data, std::size_t size, std::size_t count, void* transfer) {
    return static_cast<Transfer*>(transfer)->take(data, size * count);
}

// Returning anything other than `bytes` stops the transfer. Nothing is thrown through curl.
std::size_t Transfer::take(const char* data, std::size_t bytes) {
    got_bytes_ += bytes;
    try {
        const long answer = status();
        if (answer == kPartial && kept_bytes_ > 0) {
            if (!isTheRest()) { return 0; }
        } else if (answer != kOk) {
            return got_bytes_ - kept_bytes_ <= kLongestErrorPage ? bytes : 0;
        } else if (kept_bytes_ > 0) {  // another version, or a server that only sends whole files
            startOver();
            got_bytes_ = bytes;
        }
        if (file_ == nullptr && !beginBody()) { return 0; }
    } catch (const std::exception& error) {
        refused_ = fmt::format("cannot be kept ({})", error.what());
        return 0;
    }
    if (file_->sizeBytes() + bytes > request_.most_bytes) {
        refused_ =
            fmt::format("is longer than {} bytes, which is the most that is taken", request_.most_bytes);
    } else if (exceedsCache(file_->sizeBytes() + bytes)) {
        refused_ = fmt::format("is longer than {}", cacheLimit());
    }
    if (!refused_.empty()) { return 0; }
    if (!file_->write(data, bytes)) {
        refused_ = "cannot be kept: the cache's disk is full; free some space";
        return 0;
    }
    tally_.got_bytes += bytes;
    return bytes;
}

bool Transfer::isNoRest() const {
    const long answer = status();
    return kept_bytes_ > 0 && (answer == kNoSuchRange || (answer == kPartial && !isTheRest()));
}

bool Transfer::beginBody() {
    curl_off_t said = -1;
    curl_easy_getinfo(easy_.get(), CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &said);
    file_ = cache_.begin(request_.address);
    if (file_ == nullptr) {
        refused_ = "cannot be kept: no file can be made in the folder of the cache";
        return false;
    }
    version_ = versionSent();
    if (said < 0 || isEncoded()) { return true; }
    const auto expected = static_cast<std::uint64_t>(said);
    if (expected > request_.most_bytes) {
        refused_ = fmt::format("is {} bytes long, expected at most {}", expected, request_.most_bytes);
    } else if (exceedsCache(expected)) {
        refused_ = fmt::format("is {} bytes long, more than {}", expected, cacheLimit());
    } else if (expected > file_->spaceBytes()) {
        refused_ = fmt::format("is {} bytes long, but the cache's disk has only {} free; free some space",
                               expected, file_->spaceBytes());
    }
    if (!refused_.empty()) { return false; }
    is_sized_ = true;
    expected_bytes_ = expected;
    tally_.expected_bytes += expected;
    ++tally_.sized;
    return true;
}

void Transfer::startOver() {
    if (file_ != nullptr) { tally_.got_bytes -= file_->sizeBytes(); }
    if (std::exchange(is_sized_, false)) {
        tally_.expected_bytes -= expected_bytes_;
        --tally_.sized;
    }
    file_.reset();
    version_ = {};
    got_bytes_ = kept_bytes_ = expected_bytes_ = watched_bytes_ = 0;
}

bool Transfer::canGoOn() const {
    const bool is_strong = version_.etag.starts_with('"');
    return file_ != nullptr && file_->sizeBytes() > 0 && is_strong && !isEncoded() && !isNoRest();
}

bool Transfer::exceedsCache(std::uint64_t bytes) const {
    return settings_.cache_bytes > 0 && bytes > settings_.cache_bytes;
}

std::string Transfer::cacheLimit() const {
    return fmt::format("the cache's {} bytes; a larger --cache-limit takes it, and 0, which keeps nothing",
                       settings_.cache_bytes);
}

bool Transfer::finish(CURLcode code, bool is_stalled) {
    // Some servers state an encoding that is none (UTF-8, aws-chunked), or one that they did not apply: ask
    // again, and take the bytes as they come.
    if (code == CURLE_BAD_CONTENT_ENCODING && got_bytes_ == kept_bytes_ &&
        std::exchange(is_unpacked_, false)) {
        --attempts_;
        return false;
    }
    std::optional<Fetched> verdict = judge(code, is_stalled);
    if (!verdict) {
        if (!canGoOn()) { startOver(); }
        return false;
    }
    if (!is_sized_) { ++tally_.sized; }
    if (verdict->kind != Fetched::Kind::kNew) { file_.reset(); }
    promise_.set_value(std::move(*verdict));
    return true;
}

std::optional<Fetched> Transfer::judge(CURLcode code, bool is_stalled) {
    using Kind = Fetched::Kind;
    const long answer = status();
    // An answer that curl considers complete, but that ended before it began.
    if (code == CURLE_OK && answer == kOk && (file_ == nullptr || kept_bytes_ > 0) && !saysLength()) {
        code = CURLE_GOT_NOTHING;
    }
    if (!refused_.empty()) { return Fetched{Kind::kRefused, refused_}; }
    const bool is_rest = answer == kPartial && kept_bytes_ > 0 && isTheRest();
    // A resumed file is as long as the server first said, whatever it says about the rest.
    if (code == CURLE_OK && is_rest &&
        file_->sizeBytes() != (is_sized_ ? expected_bytes_ : contentRange()->total)) {
        code = CURLE_PARTIAL_FILE;
    }
    if (!is_stalled && code == CURLE_OK && (answer == kOk || is_rest)) {
        if (answer == kOk && (file_ == nullptr || kept_bytes_ > 0)) {  // of an empty file
            startOver();
            if (!beginBody()) { return Fetched{Kind::kRefused, refused_}; }
        }
        return Fetched{Kind::kNew, "", std::move(file_), version_};
    }
    if (!is_stalled && code == CURLE_OK && answer == 304 && kept_bytes_ == 0 &&
        (!request_.version.etag.empty() || !request_.version.last_modified.empty())) {
        return Fetched{Kind::kUnchanged, ""};
    }

    const bool is_answer = !is_stalled && (code == CURLE_OK || code == CURLE_WRITE_ERROR);
    const std::string reason = describe(code, is_stalled);
    const bool may_be_back = isCut(code) || (isNoServer(code) && canGoOn());
    if (is_answer ? isBusy(answer) || isNoRest() : is_stalled || may_be_back) {
        if (canGoOn() && file_->sizeBytes() >= worthwhile_bytes_) {
            worthwhile_bytes_ = file_->sizeBytes() + kWorthwhileBytes;
            attempts_ = 1;
        }
        curl_off_t asked_s = 0;
        if (is_answer) { curl_easy_getinfo(easy_.get(), CURLINFO_RETRY_AFTER, &asked_s); }
        const bool is_too_long =
            asked_s > std::chrono::duration_cast<std::chrono::seconds>(settings_.most_pause).count();
        if (is_too_long) {
            return Fetched{Kind::kUnreachable,
                           fmt::format("the server asks to wait {} s; try again then", asked_s)};
        }
        const auto own = settings_.first_pause * (1 << std::min(attempts_ - 1, 10));
        const auto pause = std::max<std::chrono::milliseconds>(own, std::chrono::seconds(asked_s));
        due_ = Clock::now() + std::min(pause, settings_.most_pause);
        if (attempts_ < settings_.attempts) { return std::nullopt; }
        return Fetched{Kind::kUnreachable,
                       fmt::format("{}, after {} attempts; try again later", reason, attempts_)};
    }
    return Fetched{!is_answer && isNoServer(code) ? Kind::kUnreachable : Kind::kRefused, reason};
}

std::string Transfer::describe(CURLcode code, bool is_stalled) const {
    const char* const detail = error_[0] != '\0' ? error_.data() : curl_easy_strerror(code);
    if (is_stalled) { return fmt::format("the server has fallen silent after {} bytes", got_bytes_); }
    if (code == CURLE_OK || code == CURLE_WRITE_ERROR) {
        return isBusy(status()) ? fmt::format("the server cannot serve it (it answers {})", status())
                                : explainStatus(status());
    }
    if (isNoServer(code)) {
        return fmt::format("cannot be reached ({}); look at the network and at the address", detail);
    }
    if (code == CURLE_PARTIAL_FILE || (isCut(code) && got_bytes_ > 0)) {
        return fmt::format("was cut off after {}{} bytes", got_bytes_,
                           expected_bytes_ > 0 ? fmt::format(" of {}", expected_bytes_) : "");
    }
    if (isCut(code)) { return fmt::format("the server hangs up ({})", detail); }
    if (code == CURLE_UNSUPPORTED_PROTOCOL && status() / 100 == 3) {
        return "redirects to an address that may not be followed, expected one of http or https, and of "
               "https after https";
    }
    if (code == CURLE_TOO_MANY_REDIRECTS) {
        return fmt::format("redirects more than {} times, expected a file", kMostRedirects);
    }
    if (code == CURLE_PEER_FAILED_VERIFICATION) {
        return fmt::format(
            "the server's certificate is not valid ({}), so it may be another server; expected a valid one",
            detail);
    }
    return fmt::format("cannot be fetched ({}), expected the address of a scene file", detail);
}

}  // namespace binosplat
