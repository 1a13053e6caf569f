// Head motion files: every mistake is named with its line.
#include "xr/simulated/files/motion_file.h"

#include "xr/simulated/files/file_words.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace files {

namespace {

constexpr std::size_t kColumns = 8;
constexpr std::array<const char*, kColumns> kNames{"time", "x", "y", "z", "qx", "qy", "qz", "qw"};
// A file whose end never reached the disk may end in zeros.
constexpr std::string_view kBlank(" \t\r\n\0", 5);
constexpr std::string_view kExpected = "time, position x, y, z, orientation x, y, z, w";

// The contents of a header.
struct Layout {
    std::optional<double> seconds_per_count;
    bool w_first = false;
};

// Ticks since the year 1 have 18 digits, more than a double keeps: whole numbers stay whole.
struct Time {
    double count = 0.0;
    std::optional<std::int64_t> whole;
};

// A line that is neither empty nor a comment.
struct Line {
    std::string_view file;
    std::size_t number = 0;
    std::vector<std::string_view> fields;

    template <typename... Parts>
    [[noreturn]] void fail(const Parts&... parts) const {
        failAt(file, number, parts...);
    }
};

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

// As a row is that a recorder was stopped in.
bool isUnfinished(const std::vector<std::string_view>& fields, bool has_break) {
    const auto isBlank = [](std::string_view field) {
        return field.find_first_not_of(kBlank) == std::string_view::npos;
    };
    const auto isNumber = [](std::string_view field) { return parseNumber(field).has_value(); };
    if (fields.size() != kColumns) { return fields.size() < kColumns; }
    return std::all_of(fields.begin() + 1, fields.end(), isBlank) ||
           (!has_break && std::all_of(fields.begin(), fields.end() - 1, isNumber));
}

std::optional<Time> parseTime(std::string_view text) {
    const std::optional<double> count = parseNumber(text);
    // Differences of numbers up to 4e18 do not overflow.
    if (!count || std::abs(*count) > 4e18) { return std::nullopt; }
    return Time{*count, parseWhole<std::int64_t>(text)};
}

double countBetween(const Time& from, const Time& to) {
    return from.whole && to.whole ? static_cast<double>(*to.whole - *from.whole) : to.count - from.count;
}

double guessSecondsPerCount(const Line& line, const Time& first) {
    const double size = std::abs(first.count);
    if (size < 1e12) { return 1.0; }
    if (size < 1e16 || size >= 1e18) {
        line.fail("time is ", shown(line.fields[0]),
                  ", must be seconds (under 1e12), ticks (1e16 to 1e18), or have its unit in a header "
                  "(time_s, time_ms, time_us, time_ns, time_ticks)");
    }
    return 1e-7;
}

void readPose(const Line& line, bool w_first, MotionSample& sample) {
    std::array<double, kColumns> values{};
    for (std::size_t i = 1; i < kColumns; ++i) {
        const std::optional<double> value = parseNumber(line.fields[i]);
        const char* name = w_first && i >= 4 ? kNames[i == 4 ? 7 : i - 1] : kNames[i];
        if (!value) {
            line.fail(name, " is ", line.fields[i].empty() ? "empty" : shown(line.fields[i]),
                      ", must be a finite number");
        }
        values[i] = *value;
    }
    sample.position_m = {values[1], values[2], values[3]};
    std::array<double, 4>& q = sample.orientation_xyzw;
    q = w_first ? std::array{values[5], values[6], values[7], values[4]}
                : std::array{values[4], values[5], values[6], values[7]};
    const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
    if (!(std::abs(length - 1.0) <= 0.05)) {
        line.fail("the orientation's length is ", length, ", must be 1");
    }
    for (double& part : q) { part /= length; }
}

}  // namespace

MotionFile parseMotion(std::string_view text, const std::string& file) {
    if (text.starts_with("\xef\xbb\xbf")) { text.remove_prefix(3); }
    MotionFile motion;
    std::vector<MotionSample>& samples = motion.samples;
    Layout layout;
    Time first;
    bool header_possible = true;
    const auto readRow = [&](const Line& line) {
        if (line.fields.size() != kColumns) {
            line.fail(line.fields.size(), " columns, must be 8: ", kExpected);
        }
        const std::optional<Time> time = parseTime(line.fields[0]);
        // A header has names in place of the first two numbers; otherwise it is a line with a mistake.
        if (std::exchange(header_possible, false) && !time && !parseNumber(line.fields[1])) {
            layout = readHeader(line.fields);
            return;
        }
        if (!time) {
            line.fail("time is ", line.fields[0].empty() ? "empty" : shown(line.fields[0]),
                      ", must be a finite number of at most 4e18");
        }
        if (samples.empty()) {
            first = *time;
            if (!layout.seconds_per_count) { layout.seconds_per_count = guessSecondsPerCount(line, first); }
        }
        MotionSample sample;
        sample.time_s = countBetween(first, *time) * *layout.seconds_per_count;
        if (!samples.empty() && !(sample.time_s > samples.back().time_s)) {
            line.fail("time is ", shown(line.fields[0]), ", must be after the pose before");
        }
        readPose(line, layout.w_first, sample);
        samples.push_back(sample);
    };
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t length = std::min(text.find('\n'), text.size());
        const bool has_break = length < text.size();
        const std::string_view words = trim(text.substr(0, length));
        text.remove_prefix(std::min(length + 1, text.size()));
        if (words.empty() || words.starts_with('#')) { continue; }
        const Line line{file, number, splitFields(words)};
        try {
            readRow(line);
        } catch (const Error& error) {
            const bool is_last = text.find_first_not_of(kBlank) == std::string_view::npos;
            if (!is_last || samples.empty() || !isUnfinished(line.fields, has_break)) { throw; }
            motion.note = std::string(error.what()) + "; the last row, cut off, is left out";
        }
    }
    if (samples.empty()) {
        throw Error(file + ": holds no poses, must be lines of " + std::string(kExpected));
    }
    return motion;
}

}  // namespace files
