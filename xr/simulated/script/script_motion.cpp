// Recorded head motion.
#include "xr/simulated/script/script_files.h"
#include "xr/simulated/script/script_words.h"

#include <array>
#include <charconv>
#include <cmath>

namespace simulated {

namespace {

constexpr std::size_t kColumns = 8;

std::string_view trim(std::string_view text) {
    const std::size_t first = text.find_first_not_of(" \t\r"), last = text.find_last_not_of(" \t\r");
    return first == std::string_view::npos ? std::string_view{} : text.substr(first, last - first + 1);
}

std::vector<std::string_view> splitFields(std::string_view line) {
    std::vector<std::string_view> fields;
    for (std::size_t comma = line.find(','); comma != std::string_view::npos; comma = line.find(',')) {
        fields.push_back(trim(line.substr(0, comma)));
        line.remove_prefix(comma + 1);
    }
    fields.push_back(trim(line));
    return fields;
}

// Ticks since the year 1 have 18 digits, more than a double keeps: whole numbers stay whole.
struct Time {
    double count = 0.0;
    std::optional<std::int64_t> whole;
};

std::optional<Time> parseTime(std::string_view text) {
    const std::optional<double> count = parseNumber(text);
    // Differences of numbers up to 4e18 do not overflow.
    if (!count || std::abs(*count) > 4e18) { return std::nullopt; }
    std::int64_t whole = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), whole);
    const bool is_whole = error == std::errc{} && end == text.data() + text.size();
    return Time{*count, is_whole ? std::optional(whole) : std::nullopt};
}

double countsBetween(const Time& from, const Time& to) {
    return from.whole && to.whole ? static_cast<double>(*to.whole - *from.whole) : to.count - from.count;
}

std::optional<double> secondsPerCount(std::string_view header) {
    if (header.ends_with("_s")) { return 1.0; }
    if (header.ends_with("_ms")) { return 1e-3; }
    if (header.ends_with("_us")) { return 1e-6; }
    if (header.ends_with("_ns")) { return 1e-9; }
    if (header.ends_with("_ticks")) { return 1e-7; }
    return std::nullopt;
}

double guessSecondsPerCount(const std::string& place, const Time& first) {
    const double size = std::abs(first.count);
    if (size < 1e12) { return 1.0; }
    if (size < 1e16 || size >= 1e18) {
        failAt(place,
               "the time is {}, must be seconds (under 1e12), ticks (1e16 to 1e18), or have its unit in a header (time_s, time_ms ...)",
               first.count);
    }
    return 1e-7;
}

Pose poseOf(const std::string& place, const std::vector<std::string_view>& fields, bool w_first, MotionAxes axes) {
    std::array<double, kColumns> values{};
    for (std::size_t i = 1; i < kColumns; ++i) {
        const std::optional<double> value = parseNumber(fields[i]);
        if (!value) { failAt(place, "column {} is {}, must be a finite number", i + 1, fields[i].empty() ? "empty" : shown(fields[i])); }
        values[i] = *value;
    }
    const glm::dquat read =
        w_first ? glm::dquat(values[4], values[5], values[6], values[7]) : glm::dquat(values[7], values[4], values[5], values[6]);
    const double length = glm::length(read);
    if (!(std::abs(length - 1.0) <= 0.05)) { failAt(place, "the orientation's length is {}, must be 1", length); }
    const glm::dquat q = read / length;
    if (axes == MotionAxes::kOpenXr) { return {q, {values[1], values[2], values[3]}}; }
    // A reflection in z turns the axis and reverses the sense.
    return {glm::dquat(q.w, -q.x, -q.y, q.z), {values[1], values[2], -values[3]}};
}

}  // namespace

Track<Pose> parseHeadMotion(std::string_view text, const std::string& name, MotionAxes axes) {
    if (text.starts_with("\xef\xbb\xbf")) { text.remove_prefix(3); }
    Track<Pose> track;
    Time first;
    std::optional<double> seconds_per_count;
    bool w_first = false, is_first_line = true;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        const std::string_view line = trim(text.substr(0, length));
        text.remove_prefix(std::min(length + 1, text.size()));
        if (line.empty() || line.starts_with('#')) { continue; }

        const std::string place = fmt::format("{}:{}", name, number);
        const std::vector<std::string_view> fields = splitFields(line);
        if (fields.size() != kColumns) {
            failAt(place, "{} columns, must be 8: time, position x, y, z, orientation x, y, z, w", fields.size());
        }
        const std::optional<Time> time = parseTime(fields[0]);
        // A header has names where numbers would be.
        if (std::exchange(is_first_line, false) && !time && !parseNumber(fields[1])) {
            seconds_per_count = secondsPerCount(fields[0]);
            w_first = fields[4] == "w" || fields[4] == "qw";
            continue;
        }
        if (!time) { failAt(place, "the time is {}, must be a finite number of at most 4e18", shown(fields[0])); }
        if (track.empty()) {
            first = *time;
            if (!seconds_per_count) { seconds_per_count = guessSecondsPerCount(place, first); }
        }
        if (!track.add(countsBetween(first, *time) * *seconds_per_count, poseOf(place, fields, w_first, axes))) {
            failAt(place, "the time is {}, must be after the pose before", shown(fields[0]));
        }
    }
    if (track.empty()) { failAt(name, "holds no poses, must be lines of time, position x, y, z, orientation x, y, z, w"); }
    return track;
}

}  // namespace simulated
