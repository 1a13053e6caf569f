// What a server says about what it sends.
#include "engine/files/web/transfer.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <string_view>

namespace binosplat {

bool Transfer::isPlain(const std::string& text) {
    constexpr std::size_t kLongestVersion = 256;
    return text.size() <= kLongestVersion &&
           std::ranges::all_of(text, [](unsigned char letter) { return std::isprint(letter) != 0; });
}

long Transfer::status() const {
    long status = 0;
    curl_easy_getinfo(easy_.get(), CURLINFO_RESPONSE_CODE, &status);
    return status;
}

std::string Transfer::header(const char* name) const {
    curl_header* found = nullptr;
    return curl_easy_header(easy_.get(), name, 0, CURLH_HEADER, -1, &found) == CURLHE_OK ? found->value : "";
}

bool Transfer::saysLength() const {
    long http = 0;
    curl_off_t length = -1;
    curl_easy_getinfo(easy_.get(), CURLINFO_HTTP_VERSION, &http);
    curl_easy_getinfo(easy_.get(), CURLINFO_CONTENT_LENGTH_DOWNLOAD_T, &length);
    return length >= 0 || http >= CURL_HTTP_VERSION_2_0 || !header("Transfer-Encoding").empty();
}

// Refused if the server does not say where the file ends: a truncated file would be taken for a whole one
// forever.
FileVersion Transfer::versionSent() const {
    if (!saysLength()) { return {}; }
    FileVersion version{header("ETag"), header("Last-Modified")};
    if (!isPlain(version.etag)) { version.etag.clear(); }
    if (!isPlain(version.last_modified)) { version.last_modified.clear(); }
    return version;
}

bool Transfer::isEncoded() const {
    const std::string encoding = header("Content-Encoding");
    return is_unpacked_ && !encoding.empty() && encoding != "identity";
}

std::optional<Transfer::ContentRange> Transfer::contentRange() const {
    constexpr std::string_view kUnit = "bytes ";
    const std::string text = header("Content-Range");
    const std::size_t slash = text.find('/');
    if (!text.starts_with(kUnit) || slash == std::string::npos) { return std::nullopt; }
    ContentRange range;
    const char *const from = text.data() + kUnit.size(), *const end = text.data() + text.size();
    const auto [after, error] = std::from_chars(from, end, range.first);
    if (error != std::errc{} || after == end || *after != '-') { return std::nullopt; }
    std::from_chars(text.data() + slash + 1, end, range.total);  // 0 if the server does not know it
    return range;
}

bool Transfer::isTheRest() const {
    const std::optional<ContentRange> range = contentRange();
    if (!range || isEncoded() || range->first != kept_bytes_ || header("ETag") != version_.etag) {
        return false;
    }
    return is_sized_ ? range->total == 0 || range->total == expected_bytes_ : range->total > 0;
}

}  // namespace binosplat
