// Head motion files: every mistake is named with its line.
#include "engine/setup/head_motion.h"

#include "engine/error.h"
#include "engine/setup/text_file.h"
#include "engine/setup/values.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

namespace binosplat {

namespace {

constexpr std::size_t kColumns = 8;
constexpr std::array<const char*, kColumns> kNames{"time", "x", "y", "z", "qx", "qy", "qz", "qw"};

// What a header said.
struct Layout {
    std::optional<double> seconds_per_count;
    bool w_first = false;
};

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

Layout readHeader(const std::vector<std::string_view>& fields) {
    Layout layout;
    constexpr std::array<std::pair<std::string_view, double>, 5> kUnits{
        {{"_s", 1.0}, {"_ms", 1e-3}, {"_us", 1e-6}, {"_ns", 1e-9}, {"_ticks", 1e-7}}};
    for (const auto& [suffix, seconds] : kUnits) {
        if (fields[0].ends_with(suffix)) { layout.seconds_per_count = seconds; }
    }
    layout.w_first = fields[4] == "w" || fields[4] == "qw";
    return layout;
}

// A time as counted. Ticks since the year 1 have 18 digits, more than a double keeps: whole numbers stay whole.
struct Time {
    double count = 0.0;
    std::optional<std::int64_t> whole;
};

std::optional<Time> parseTime(std::string_view text) {
    const std::optional<double> count = parseNumber(text);
    // Differences of numbers up to 4e18 do not overflow.
    if (!count || std::abs(*count) > 4e18) { return std::nullopt; }
    Time time{*count, std::nullopt};
    std::int64_t whole = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), whole);
    if (error == std::errc{} && end == text.data() + text.size()) { time.whole = whole; }
    return time;
}

double countsBetween(const Time& from, const Time& to) {
    return from.whole && to.whole ? static_cast<double>(*to.whole - *from.whole) : to.count - from.count;
}

double secondsPerCount(const std::string& place, const Time& first) {
    const double size = std::abs(first.count);
    if (size < 1e12) { return 1.0; }
    check(size >= 1e16 && size < 1e18,
          "{}: time is {}, must be seconds (under 1e12), ticks (1e16 to 1e18), or have its unit in a header "
          "(time_s, time_ms, time_us, time_ns, time_ticks)",
          place, first.count);
    return 1e-7;
}

Pose poseOf(const std::string& place, const std::vector<std::string_view>& fields, const Layout& layout, MotionAxes axes) {
    std::array<double, kColumns> values{};
    for (std::size_t i = 1; i < kColumns; ++i) {
        const std::optional<double> value = parseNumber(fields[i]);
        const char* name = layout.w_first && i >= 4 ? kNames[i == 4 ? 7 : i - 1] : kNames[i];
        check(value.has_value(), "{}: {} is {}, must be a finite number", place, name, fields[i].empty() ? "empty" : fields[i]);
        values[i] = *value;
    }
    const glm::dquat orientation =
        layout.w_first ? glm::dquat(values[4], values[5], values[6], values[7]) : glm::dquat(values[7], values[4], values[5], values[6]);
    const double length = glm::length(orientation);
    check(std::abs(length - 1.0) <= 0.05, "{}: the orientation's length is {}, must be 1", place, length);
    return poseFromRecording({values[1], values[2], values[3]}, orientation / length, axes);
}

}  // namespace

HeadMotion parseHeadMotion(std::string_view text, const std::string& file, MotionAxes axes) {
    if (text.starts_with("\xef\xbb\xbf")) { text.remove_prefix(3); }
    std::vector<HeadSample> samples;
    Layout layout;
    Time first;
    bool header_possible = true;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        const std::string_view line = trim(text.substr(0, length));
        text.remove_prefix(std::min(length + 1, text.size()));
        if (line.empty() || line.starts_with('#')) { continue; }

        const std::string place = fmt::format("{}:{}", file, number);
        const std::vector<std::string_view> fields = splitFields(line);
        check(fields.size() == kColumns, "{}: {} columns, must be 8: time, position x, y, z, orientation x, y, z, w", place, fields.size());
        const std::optional<Time> time = parseTime(fields[0]);
        // A header has names where numbers would be: all of them, or it is a line with a mistake.
        if (std::exchange(header_possible, false) && !time && !parseNumber(fields[1])) {
            layout = readHeader(fields);
            continue;
        }
        check(time.has_value(), "{}: time is {}, must be a finite number of at most 4e18", place, fields[0].empty() ? "empty" : fields[0]);
        if (samples.empty()) {
            first = *time;
            if (!layout.seconds_per_count) { layout.seconds_per_count = secondsPerCount(place, first); }
        }
        const double time_s = countsBetween(first, *time) * *layout.seconds_per_count;
        check(samples.empty() || time_s > samples.back().time_s, "{}: time is {}, must be after the pose before", place, fields[0]);
        samples.push_back({time_s, poseOf(place, fields, layout, axes)});
    }
    check(!samples.empty(), "{}: holds no poses, must be lines of time, position x, y, z, orientation x, y, z, w", file);
    return HeadMotion(std::move(samples));
}

HeadMotion readHeadMotion(const std::filesystem::path& path, MotionAxes axes) {
    return parseHeadMotion(readTextFile(path, "a CSV file of head motion"), path.string(), axes);
}

}  // namespace binosplat
