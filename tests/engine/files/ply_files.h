// PLY files made to measure, in a folder that is removed with them.
#pragma once

#include "engine/files/load_scene.h"
#include "engine/platform.h"
#include "tests/script.h"

namespace binosplat::test {

class Folder {
public:
    Folder() = default;
    ~Folder() { fs::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
    [[nodiscard]] std::string write(const std::string& name, const std::string& bytes) const {
        // Some file systems wait for the disk when a file is truncated and rewritten.
        fs::remove(file(name));
        std::ofstream(file(name), std::ios::binary) << bytes;
        return file(name);
    }
    [[nodiscard]] std::ptrdiff_t fileCount() const {
        return std::distance(fs::directory_iterator(path_), {});
    }

private:
    fs::path path_ = createFolder(fs::temp_directory_path(), "binosplat_scene_test_");
};
// For facts that use one: TEST_CASE_FIXTURE(InFolder, "...").
struct InFolder {
    const Folder folder;
};

enum class Encoding { kAscii, kLittle, kBig };
inline constexpr Encoding kEncodings[] = {Encoding::kAscii, Encoding::kLittle, Encoding::kBig};

struct Column {
    std::string name, type;
    std::vector<double> values;
};

template <typename T>
void appendValue(std::string& bytes, double value, bool big) {
    T typed = static_cast<T>(value);
    char raw[sizeof(T)];
    std::memcpy(raw, &typed, sizeof(T));
    if (big != (std::endian::native == std::endian::big)) { std::reverse(std::begin(raw), std::end(raw)); }
    bytes.append(raw, sizeof(T));
}

inline void appendTyped(std::string& bytes, const std::string& type, double value, Encoding encoding) {
    static const std::map<std::string, void (*)(std::string&, double, bool)> kTypes{
        {"char", appendValue<std::int8_t>},     {"int8", appendValue<std::int8_t>},
        {"uchar", appendValue<std::uint8_t>},   {"uint8", appendValue<std::uint8_t>},
        {"short", appendValue<std::int16_t>},   {"int16", appendValue<std::int16_t>},
        {"ushort", appendValue<std::uint16_t>}, {"uint16", appendValue<std::uint16_t>},
        {"int", appendValue<std::int32_t>},     {"int32", appendValue<std::int32_t>},
        {"uint", appendValue<std::uint32_t>},   {"uint32", appendValue<std::uint32_t>},
        {"float", appendValue<float>},          {"float32", appendValue<float>},
        {"double", appendValue<double>},        {"float64", appendValue<double>}};
    if (encoding == Encoding::kAscii) {
        bytes += fmt::format("{} ", value);
    } else {
        kTypes.at(type)(bytes, value, encoding == Encoding::kBig);
    }
}

inline void appendLittle(std::string& bytes, const std::string& type, const std::vector<double>& values) {
    for (const double value : values) { appendTyped(bytes, type, value, Encoding::kLittle); }
}

// A PLY file as other programs would write it; `before` and `after` are additional elements (header lines and
// data).
struct PlyText {
    std::vector<Column> columns;
    Encoding encoding = Encoding::kLittle;
    std::string header_before, data_before, header_after, data_after, line_break = "\n";

    [[nodiscard]] std::string bytes() const {
        const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        const std::size_t rows = columns.front().values.size();
        std::string text = "ply\nformat " + std::string(names[static_cast<int>(encoding)]) +
                           " 1.0\ncomment made for a test\n" + header_before;
        text += fmt::format("element vertex {}\n", rows);
        for (const Column& column : columns) { text += "property " + column.type + " " + column.name + "\n"; }
        text += header_after + "end_header\n";
        for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += line_break.size()) {
            text.replace(at, 1, line_break);
        }
        text += data_before;
        for (std::size_t row = 0; row < rows; ++row) {
            for (const Column& column : columns) {
                appendTyped(text, column.type, column.values[row], encoding);
            }
            if (encoding == Encoding::kAscii) { text += "\n"; }
        }
        return text + data_after;
    }
    void add(const std::string& name, const std::string& type, const std::vector<double>& values) {
        columns.push_back({name, type, values});
    }
    // Makes the scene one of so many splats; new ones are like the first.
    void resize(std::size_t rows) {
        for (Column& column : columns) { column.values.resize(rows, column.values[0]); }
    }
    Column& operator[](const std::string& name) {
        const auto found = std::ranges::find(columns, name, &Column::name);
        REQUIRE(found != columns.end());
        return *found;
    }
};

// Three plausible splats whose numbers are exact in float32.
inline PlyText makePly(int rest_count = 0, bool three_scales = false) {
    PlyText ply;
    const auto add = [&](const std::string& name, double a, double b, double c) {
        ply.add(name, "float", {a, b, c});
    };
    add("x", 1.0, 2.0, -3.0);
    add("y", 0.5, 0.25, 0.125);
    add("z", 4.0, 5.0, 6.0);
    for (const char* name : {"nx", "ny", "nz"}) { add(name, 0.0, 0.0, 0.0); }
    for (int i = 0; i < 3; ++i) { add(fmt::format("f_dc_{}", i), 0.25 * i, 0.5 * i, -0.5 * i); }
    for (int i = 0; i < rest_count; ++i) { add(fmt::format("f_rest_{}", i), 1.0 + i, 100.0 + i, 200.0 + i); }
    add("opacity", 0.0, 2.0, -2.0);
    add("scale_0", 0.0, -1.0, -2.0);
    add("scale_1", -3.0, -2.5, -1.5);
    if (three_scales) { add("scale_2", -5.0, -6.0, -4.0); }
    add("rot_0", 2.0, 1.0, 0.0);
    add("rot_1", 0.0, 1.0, 0.0);
    add("rot_2", 0.0, 1.0, -4.0);
    add("rot_3", 0.0, 1.0, 0.0);
    return ply;
}

inline std::string loadError(const std::string& source, std::uint64_t splats = 0) {
    return errorOf([&] { (void)loadScene(source, splats); });
}
inline std::string loadError(const Folder& folder, const std::string& bytes) {
    return loadError(folder.write("broken.ply", bytes));
}
// What `loadError` gives contains this part.
template <typename... Source>
void checkError(const std::string& part, const Source&... source) {
    const std::string error = loadError(source...);
    CHECK_MESSAGE(contains(error, part), "'", error, "' should contain '", part, "'");
}

// `action` reports progress from 0 to 1 at least this often, and stops when the callback throws.
inline void checkProgress(std::size_t times, const std::function<void(const Progress&)>& action) {
    std::vector<double> told;
    action([&](double share) { told.push_back(share); });
    CHECK(told.size() >= times);
    CHECK(std::ranges::is_sorted(told));
    CHECK(told.back() == 1.0);
    struct Enough {};
    for (const double limit : {-1.0, 0.0, 0.3, 0.5}) {
        const auto stop = [&](double share) {
            if (share > limit) { throw Enough(); }
        };
        CHECK_THROWS_AS(action(stop), Enough);
    }
}

// There is exactly one line, and it contains this part.
inline void checkSays(const std::vector<std::string>& lines, const std::string& part) {
    REQUIRE(lines.size() == 1);
    CHECK_MESSAGE(contains(lines[0], part), lines[0]);
}

inline std::ptrdiff_t countSaying(const std::vector<std::string>& lines, const std::string& part) {
    return std::ranges::count_if(lines, [&](const std::string& line) { return contains(line, part); });
}

struct ReadScene {
    LoadNotes notes;
    Scene scene;
};
inline ReadScene readScene(const std::string& source) {
    ReadScene read;
    read.scene = loadScene(source, 0, &read.notes);
    return read;
}

inline void checkSameScene(const Scene& a, const Scene& b) {
    REQUIRE(a.size() == b.size());
    CHECK(these(a.sh_degree, a.positions, a.rotations, a.scales, a.thicknesses, a.opacities, a.sh) ==
          these(b.sh_degree, b.positions, b.rotations, b.scales, b.thicknesses, b.opacities, b.sh));
}

// Replaces the first `from`, which must exist.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

// A script in which `> FROM => TO` reads `good` with FROM replaced by TO; `read` returns the error, if any.
inline void runFaults(const std::string& good,
                      const std::function<std::string(const std::string& broken)>& read,
                      const std::map<std::string, std::function<void(const std::string&)>>& verbs = {}) {
    ScriptHost host{[&](const std::string& edit, const std::string&) {
        const std::string error = read(edited(good, edit));
        return Outcome{error.empty() ? 0 : 1, "", withSlashes(error) + "\n"};
    }};
    host.verbs = verbs;
    runScript(host);
}

inline PlyText makeIn(Encoding encoding, int rest_count = 0, bool three_scales = false) {
    PlyText ply = makePly(rest_count, three_scales);
    ply.encoding = encoding;
    return ply;
}

}  // namespace binosplat::test
