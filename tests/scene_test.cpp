// Scenes: reading and writing PLY, its errors and skips; the built-in scenes; what is said about a scene.
#include "engine/scene/scene.h"
#include "engine/error.h"
#include "engine/scene/describe.h"
#include "engine/scene/ply.h"
#include "engine/scene/procedural.h"
#include "tests/shared_data.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include <unistd.h>

using namespace binosplat;

namespace {

// A folder of its own for each test case, gone afterwards.
class Folder {
public:
    Folder() : path_(std::filesystem::temp_directory_path() / fmt::format("binosplat_scene_test_{}", ::getpid())) {
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    [[nodiscard]] std::string file(const std::string& name) const { return (path_ / name).string(); }
    [[nodiscard]] std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(file(name), std::ios::binary) << bytes;
        return file(name);
    }
    [[nodiscard]] std::ptrdiff_t fileCount() const {
        return std::distance(std::filesystem::directory_iterator(path_), std::filesystem::directory_iterator());
    }

private:
    std::filesystem::path path_;
};

enum class Encoding { kAscii, kLittle, kBig };
constexpr Encoding kEncodings[] = {Encoding::kAscii, Encoding::kLittle, Encoding::kBig};

struct Column {
    std::string name;
    std::string type;
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

void appendTyped(std::string& bytes, const std::string& type, double value, Encoding encoding) {
    const bool big = encoding == Encoding::kBig;
    if (encoding == Encoding::kAscii) {
        bytes += fmt::format("{} ", value);
    } else if (type == "char" || type == "int8") {
        appendValue<std::int8_t>(bytes, value, big);
    } else if (type == "uchar" || type == "uint8") {
        appendValue<std::uint8_t>(bytes, value, big);
    } else if (type == "short" || type == "int16") {
        appendValue<std::int16_t>(bytes, value, big);
    } else if (type == "ushort" || type == "uint16") {
        appendValue<std::uint16_t>(bytes, value, big);
    } else if (type == "int" || type == "int32") {
        appendValue<std::int32_t>(bytes, value, big);
    } else if (type == "uint" || type == "uint32") {
        appendValue<std::uint32_t>(bytes, value, big);
    } else if (type == "float" || type == "float32") {
        appendValue<float>(bytes, value, big);
    } else {
        REQUIRE((type == "double" || type == "float64"));
        appendValue<double>(bytes, value, big);
    }
}

// A PLY file as other programs would write it; `before` and `after` are further elements (header lines and data).
struct PlyText {
    std::vector<Column> columns;
    Encoding encoding = Encoding::kLittle;
    std::string header_before, data_before, header_after, data_after, line_break = "\n";

    [[nodiscard]] std::string bytes() const {
        const char* names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        const std::size_t rows = columns.front().values.size();
        std::string text =
            "ply\nformat " + std::string(names[static_cast<int>(encoding)]) + " 1.0\ncomment made for a test\n" + header_before;
        text += fmt::format("element vertex {}\n", rows);
        for (const Column& column : columns) { text += "property " + column.type + " " + column.name + "\n"; }
        text += header_after + "end_header\n";
        if (line_break != "\n") {
            std::string broken;
            for (const char letter : text) { broken += letter == '\n' ? line_break : std::string(1, letter); }
            text = broken;
        }
        text += data_before;
        for (std::size_t row = 0; row < rows; ++row) {
            for (const Column& column : columns) { appendTyped(text, column.type, column.values[row], encoding); }
            if (encoding == Encoding::kAscii) { text += "\n"; }
        }
        return text + data_after;
    }
    Column& operator[](const std::string& name) {
        const auto found = std::find_if(columns.begin(), columns.end(), [&](const Column& column) { return column.name == name; });
        REQUIRE(found != columns.end());
        return *found;
    }
    void remove(const std::string& name) {
        std::erase_if(columns, [&](const Column& column) { return column.name == name; });
    }
};

// Three splats with numbers that are exact in float32; value = 1000 * splat + column would also do, but these are plausible.
PlyText makePly(int rest_count = 0, bool three_scales = false) {
    PlyText ply;
    const auto add = [&](const std::string& name, double a, double b, double c) { ply.columns.push_back({name, "float", {a, b, c}}); };
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

// The message of the Error that loading gives; empty if there is none.
std::string loadError(const std::string& source, std::uint64_t splats = 0) {
    try {
        (void)loadScene(source, splats);
    } catch (const Error& error) { return error.what(); }
    return {};
}
std::string loadError(const Folder& folder, const std::string& bytes) { return loadError(folder.write("broken.ply", bytes)); }

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

void checkSameScene(const Scene& a, const Scene& b) {
    REQUIRE(a.size() == b.size());
    CHECK(a.sh_degree == b.sh_degree);
    CHECK(a.positions == b.positions);
    CHECK(a.rotations == b.rotations);
    CHECK(a.scales == b.scales);
    CHECK(a.opacities == b.opacities);
    CHECK(a.sh == b.sh);
}

// Replaces the first `from`; it must be there.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

}  // namespace

TEST_CASE("a PLY's numbers arrive activated, in every encoding") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly();
        ply.encoding = encoding;
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("known.ply", ply.bytes()), 0, &notes);
        REQUIRE(scene.size() == 3);
        CHECK(scene.sh_degree == 0);
        CHECK(scene.positions[2] == glm::vec3(-3.0f, 0.125f, 6.0f));
        CHECK(scene.sh == std::vector<float>{0.0f, 0.25f, 0.5f, 0.0f, 0.5f, 1.0f, 0.0f, -0.5f, -1.0f});
        CHECK(scene.opacities[0] == 0.5f);
        CHECK(scene.opacities[1] == doctest::Approx(1.0 / (1.0 + std::exp(-2.0))).epsilon(1e-6));
        CHECK(scene.scales[0].x == 1.0f);
        CHECK(scene.scales[0].y == doctest::Approx(std::exp(-3.0)).epsilon(1e-6));
        CHECK(scene.rotations[0] == glm::quat(1.0f, 0.0f, 0.0f, 0.0f));
        CHECK(scene.rotations[1] == glm::quat(0.5f, 0.5f, 0.5f, 0.5f));
        CHECK(scene.rotations[2] == glm::quat(0.0f, 0.0f, -1.0f, 0.0f));
        CHECK(notes.splats_in_file == 3);
        CHECK_FALSE(notes.three_scales);
        CHECK(notes.lines.empty());
    }
}

TEST_CASE("f_rest is channel-major in the file and coefficient-major in the scene") {
    const Folder folder;
    for (const int degree : {1, 2, 3}) {
        const int per_channel = shCoefficientCount(degree) - 1;
        const Scene scene = loadScene(folder.write("sh.ply", makePly(3 * per_channel).bytes()));
        REQUIRE(scene.sh_degree == degree);
        for (int channel = 0; channel < 3; ++channel) {
            for (int k = 1; k <= per_channel; ++k) {
                const std::size_t at = static_cast<std::size_t>((1 * shCoefficientCount(degree) + k) * 3 + channel);
                CHECK(scene.sh[at] == static_cast<float>(100 + channel * per_channel + k - 1));
            }
        }
    }
}

TEST_CASE("SH bands that are all zero are left out, even if a band below is used late") {
    const Folder folder;
    PlyText ply = makePly(45);
    for (int i = 0; i < 45; ++i) {
        for (double& value : ply[fmt::format("f_rest_{}", i)].values) { value = 0.0; }
    }
    LoadNotes notes;
    CHECK(loadScene(folder.write("flat.ply", ply.bytes()), 0, &notes).sh_degree == 0);
    CHECK(notes.sh_degree_in_file == 3);
    REQUIRE(notes.lines.size() == 1);
    CHECK(contains(notes.lines[0], "SH bands above degree 0"));

    // 700 splats are three blocks; the only coefficient of band 2 is in the last splat, so rows stored before are widened.
    for (Column& column : ply.columns) { column.values.resize(700, column.values[0]); }
    ply["f_rest_0"].values[3] = 7.0;     // channel 0, k = 1
    ply["f_rest_21"].values[699] = 9.0;  // channel 1, k = 7
    const Scene scene = loadScene(folder.write("late.ply", ply.bytes()));
    REQUIRE(scene.sh_degree == 2);
    REQUIRE(scene.sh.size() == 700 * 27);
    CHECK(scene.sh[3 * 27 + 3 * 1 + 0] == 7.0f);
    CHECK(scene.sh[699 * 27 + 3 * 7 + 1] == 9.0f);
    CHECK(std::count(scene.sh.begin(), scene.sh.end(), 0.0f) == 700 * 25 - 2 + 0);  // f_dc_1 and f_dc_2 are not zero
}

TEST_CASE("properties come in any order, of any type, among others") {
    const Folder folder;
    const Scene expected = loadScene(folder.write("plain.ply", makePly(9).bytes()));
    std::uint32_t state = 1;
    for (int round = 0; round < 12; ++round) {
        PlyText ply = makePly(9);
        ply.encoding = kEncodings[round % 3];
        for (std::size_t i = ply.columns.size(); i > 1; --i) {
            state = state * 1664525u + 1013904223u;
            std::swap(ply.columns[i - 1], ply.columns[state % i]);
        }
        for (const char* name : {"x", "f_rest_3", "rot_1", "opacity"}) { ply[name].type = round % 2 == 0 ? "double" : "float64"; }
        ply["f_rest_0"].type = "short";
        ply["f_rest_1"].type = "uint16";
        ply["f_rest_2"].type = "int32";
        ply["z"].type = "uchar";
        ply["scale_0"].type = "int8";
        ply["rot_2"].type = "char";
        ply["rot_0"].type = "uint";
        ply.columns.insert(ply.columns.begin() + round, {"red", "uchar", {255.0, 0.0, 17.0}});
        ply.columns.push_back({"confidence", "ushort", {1.0, 2.0, 3.0}});
        checkSameScene(loadScene(folder.write("shuffled.ply", ply.bytes())), expected);
    }
}

TEST_CASE("other elements are passed over, with and without lists, before and after the splats") {
    const Folder folder;
    const Scene expected = loadScene(folder.write("plain.ply", makePly().bytes()));
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly();
        ply.encoding = encoding;
        ply.header_before =
            "element camera 2\nproperty float a\nproperty uchar b\nelement strip 2\nproperty list uchar int index\nproperty double "
            "w\nelement none 5\n";
        ply.header_after = "element face 1\nproperty list uchar int vertex_indices\n";
        for (const double row : {1.0, 2.0}) {
            appendTyped(ply.data_before, "float", row, encoding);
            appendTyped(ply.data_before, "uchar", 3.0, encoding);
            if (encoding == Encoding::kAscii) { ply.data_before += "\n"; }
        }
        for (const int count : {3, 0}) {
            appendTyped(ply.data_before, "uchar", count, encoding);
            for (int i = 0; i < count; ++i) { appendTyped(ply.data_before, "int", i, encoding); }
            appendTyped(ply.data_before, "double", 0.5, encoding);
            if (encoding == Encoding::kAscii) { ply.data_before += "\n"; }
        }
        ply.data_after = "whatever follows";
        checkSameScene(loadScene(folder.write("more.ply", ply.bytes())), expected);
    }
}

TEST_CASE("line breaks of Windows are read") {
    const Folder folder;
    PlyText ply = makePly();
    const Scene expected = loadScene(folder.write("plain.ply", ply.bytes()));
    ply.line_break = "\r\n";
    checkSameScene(loadScene(folder.write("windows.ply", ply.bytes())), expected);
    ply.encoding = Encoding::kAscii;
    checkSameScene(loadScene(folder.write("windows.ply", replaced(ply.bytes(), "\n", "\n"))), expected);
}

TEST_CASE("of three scales the shortest axis is dropped and the frame stays right-handed") {
    const Folder folder;
    for (std::size_t shortest = 0; shortest < 3; ++shortest) {
        PlyText ply = makePly(0, true);
        const double logs[] = {-1.0, -2.0, -0.5};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (double& value : ply[fmt::format("scale_{}", axis)].values) { value = axis == shortest ? -7.0 : logs[axis]; }
        }
        const double rotation[] = {0.3, -0.5, 0.7, 0.2};
        for (std::size_t i = 0; i < 4; ++i) {
            for (double& value : ply[fmt::format("rot_{}", i)].values) { value = rotation[i]; }
        }
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("three.ply", ply.bytes()), 0, &notes);
        const glm::mat3 trained = glm::mat3_cast(glm::normalize(glm::quat(0.3f, -0.5f, 0.7f, 0.2f)));
        const glm::mat3 kept = glm::mat3_cast(scene.rotations[0]);
        const int u = static_cast<int>((shortest + 1) % 3), v = static_cast<int>((shortest + 2) % 3);
        CHECK(glm::length(kept[0] - trained[u]) < 1e-6f);
        CHECK(glm::length(kept[1] - trained[v]) < 1e-6f);
        CHECK(glm::length(kept[2] - trained[static_cast<int>(shortest)]) < 1e-6f);  // the normal lies along the dropped axis
        CHECK(glm::determinant(kept) == doctest::Approx(1.0));
        CHECK(scene.scales[0].x == doctest::Approx(std::exp(logs[u])));
        CHECK(scene.scales[0].y == doctest::Approx(std::exp(logs[v])));
        CHECK(notes.three_scales);
        CHECK(notes.median_flatness == doctest::Approx(std::exp(-7.0 - std::min(logs[u], logs[v]))));
        REQUIRE(notes.lines.size() == 1);
        CHECK(contains(notes.lines[0], "shortest axis"));
    }
}

TEST_CASE("splats with NaN, infinity, overflow or no rotation are skipped and counted") {
    const Folder folder;
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    for (const Encoding encoding : kEncodings) {
        for (const char* name : {"x", "z", "f_dc_1", "f_rest_8", "opacity", "scale_1", "rot_3"}) {
            for (const double bad : {nan, infinity, -infinity}) {
                PlyText ply = makePly(9);
                ply.encoding = encoding;
                ply[name].values[1] = bad;
                LoadNotes notes;
                const Scene scene = loadScene(folder.write("nan.ply", ply.bytes()), 0, &notes);
                REQUIRE(scene.size() == 2);
                CHECK(scene.positions[1].x == -3.0f);
                CHECK(scene.sh.size() == 2 * 12);
                CHECK(notes.skipped_not_finite == 1);
                CHECK(notes.skipped_zero_rotation == 0);
                REQUIRE(notes.lines.size() == 1);
                CHECK(contains(notes.lines[0], "1 of 3 splats skipped"));
            }
        }
    }
    PlyText ply = makePly(9);
    ply["scale_0"].values[0] = 89.0;  // exp(89) is beyond float32
    ply["rot_2"].values[2] = 0.0;
    ply["nx"].values[1] = nan;  // of no interest
    LoadNotes notes;
    CHECK(loadScene(folder.write("bad.ply", ply.bytes()), 0, &notes).size() == 1);
    CHECK(notes.skipped_not_finite == 1);
    CHECK(notes.skipped_zero_rotation == 1);
    CHECK(notes.lines.size() == 2);
}

TEST_CASE("tiny and huge quaternions are normalised") {
    const Folder folder;
    for (const double length : {1e-30, 1e30}) {
        PlyText ply = makePly();
        for (const char* name : {"rot_0", "rot_1", "rot_2", "rot_3"}) { ply[name].values[0] = length; }
        CHECK(loadScene(folder.write("length.ply", ply.bytes())).rotations[0] == glm::quat(0.5f, 0.5f, 0.5f, 0.5f));
    }
}

TEST_CASE("an empty scene is a scene") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply = makePly(9, true);
        ply.encoding = encoding;
        for (Column& column : ply.columns) { column.values.clear(); }
        LoadNotes notes;
        const Scene scene = loadScene(folder.write("empty.ply", ply.bytes()), 0, &notes);
        CHECK(scene.size() == 0);
        CHECK(notes.median_flatness == 0.0);
        CHECK(describeScene(scene, &notes).splats == 0);
        writePly(scene, folder.file("again.ply"));
        CHECK(loadScene(folder.file("again.ply")).size() == 0);
    }
}

TEST_CASE("errors of the source itself say what it is") {
    const Folder folder;
    CHECK(contains(loadError(folder.file("absent.ply")), "absent.ply: no such file"));
    CHECK(contains(loadError(folder.file(".")), "is a directory"));
    CHECK(contains(loadError(folder.write("zero.ply", "")), "is empty"));
    CHECK(contains(loadError("/dev/null"), "not a regular file"));
    CHECK(contains(loadError(std::string(5000, 'x')), "cannot be read"));
    const std::string other = loadError(folder.write("picture.ply", "P6 not a scene"));
    CHECK(contains(other, "not a scene file"));
    CHECK(contains(other, "PLY"));
    CHECK(loadScene(folder.write("named_otherwise.txt", makePly().bytes())).size() == 3);
}

TEST_CASE("errors in a header name the file, the line and what was expected") {
    const Folder folder;
    const std::string good = makePly(9).bytes();
    const auto errorWith = [&](const std::string& from, const std::string& to) {
        const std::string message = loadError(folder, replaced(good, from, to));
        CHECK(contains(message, "broken.ply: header"));
        CHECK(message.find('\n') == std::string::npos);
        return message;
    };
    CHECK(contains(errorWith("end_header\n", "comment x\n"), "end_header"));
    CHECK(contains(errorWith("property float x", "property half x"), "header line 5: unknown type 'half'"));
    CHECK(contains(errorWith("property float x", "property float"), "expected 'property TYPE NAME'"));
    CHECK(contains(errorWith("property float x", "property list float int x"), "counted by 'float'"));
    CHECK(contains(errorWith("property float nx", "property list uchar int nx"), "nx of element vertex is a list"));
    CHECK(contains(errorWith("property float nx", "property float x"), "property x of element vertex twice"));
    CHECK(contains(errorWith("property float opacity", "property float opaque"), "no property opacity"));
    CHECK(contains(errorWith("property float scale_1", "property float scale"), "no property scale_1"));
    CHECK(contains(errorWith("property float f_dc_2", "property float dc"), "no property f_dc_2"));
    CHECK(contains(errorWith("property float f_rest_8", "property float other"), "8 f_rest properties, expected 0, 9, 24 or 45"));
    CHECK(contains(errorWith("property float f_rest_8", "property float f_rest_9"), "no f_rest_8"));
    CHECK(contains(errorWith("element vertex 3", "element vertex -3"), "count of element vertex is '-3'"));
    CHECK(contains(errorWith("element vertex 3", "element vertex many"), "count of element vertex is 'many'"));
    CHECK(contains(errorWith("element vertex 3", "element vertex 99999999999999999999999"), "count of element vertex"));
    CHECK(contains(errorWith("element vertex 3", "element points 3"), "no element vertex"));
    CHECK(contains(errorWith("element vertex 3", "element vertex 0\nelement vertex 3"), "element vertex twice"));
    CHECK(contains(errorWith("element vertex 3", "vertices 3"), "unknown keyword 'vertices'"));
    CHECK(contains(errorWith("comment made for a test", "property float x"), "a property before any element"));
    CHECK(contains(errorWith("binary_little_endian", "binary_middle_endian"), "unknown encoding"));
    CHECK(contains(errorWith("1.0", "2.0"), "version is '2.0'"));
    CHECK(contains(errorWith("format binary_little_endian 1.0\n", ""), "no format line"));
    CHECK(contains(errorWith("comment made for a test", "format ascii 1.0"), "second format line"));
}

TEST_CASE("absurd counts are refused before anything is allocated") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        for (const char* count : {"4", "1000000000", "18446744073709551615"}) {
            PlyText ply = makePly();
            ply.encoding = encoding;
            const std::string message =
                loadError(folder, replaced(ply.bytes(), "element vertex 3", fmt::format("element vertex {}", count)));
            CHECK(contains(message, "broken.ply: data: ends"));
            CHECK(contains(message, fmt::format("of {}", count)));
        }
        PlyText ply = makePly();
        ply.encoding = encoding;
        ply.header_before = "element list 18446744073709551615\nproperty list uint int values\n";
        CHECK_FALSE(loadError(folder, ply.bytes()).empty());
        ply.header_before = "element pair 18446744073709551615\nproperty double a\nproperty double b\n";
        CHECK_FALSE(loadError(folder, ply.bytes()).empty());
    }
}

TEST_CASE("a file cut off at any byte is an error") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        for (const bool more : {false, true}) {
            PlyText ply = makePly(9, more);
            ply.encoding = encoding;
            if (more) {
                ply.header_before = "element strip 1\nproperty list uchar short index\n";
                appendTyped(ply.data_before, "uchar", 2.0, encoding);
                appendTyped(ply.data_before, "short", 1.0, encoding);
                appendTyped(ply.data_before, "short", 2.0, encoding);
                if (encoding == Encoding::kAscii) { ply.data_before += "\n"; }
            }
            const std::string whole = ply.bytes();
            CHECK(loadError(folder, whole).empty());
            for (std::size_t length = 0; length < whole.size(); ++length) {
                const std::string message = loadError(folder, whole.substr(0, length));
                CHECK_MESSAGE(contains(message, "broken.ply: "), length, " bytes: ", message);
            }
        }
    }
    const std::string whole = makePly().bytes();
    CHECK(contains(loadError(folder, whole.substr(0, whole.size() - 1)), "ends in splat 2 of 3"));
}

TEST_CASE("ascii values that are no numbers are named, with their splat") {
    const Folder folder;
    PlyText ply = makePly();
    ply.encoding = Encoding::kAscii;
    const std::string good = ply.bytes();
    CHECK(contains(loadError(folder, replaced(good, "\n2 0.25", "\n2 zwei")), "splat 1 of 3: property y is 'zwei'"));
    CHECK(contains(loadError(folder, replaced(good, "\n2 0.25", "\n2")), "splat 1 of 3: property rot_3 is ''"));
    CHECK(contains(loadError(folder, replaced(good, "\n2 0.25", "\n2 0.25 1")), "splat 1 of 3: more than the expected 16 values"));
    CHECK(loadError(folder, replaced(good, "\n2 0.25", "\n\n+2 \t 2.5e-1")).empty());
}

TEST_CASE("what is written reads back the same") {
    const Folder folder;
    for (const int rest_count : {0, 9, 24, 45}) {
        const Scene scene = loadScene(folder.write("in.ply", makePly(rest_count).bytes()));
        double last = -1.0;
        writePly(scene, folder.file("out.ply"), [&](double share) {
            CHECK(share > last);
            last = share;
        });
        CHECK(last == 1.0);
        const Scene again = loadScene(folder.file("out.ply"));
        CHECK(again.positions == scene.positions);
        CHECK(again.sh == scene.sh);
        for (std::size_t i = 0; i < scene.size(); ++i) {
            CHECK(glm::length(again.rotations[i] - scene.rotations[i]) < 1e-6f);
            CHECK(glm::length(again.scales[i] / scene.scales[i] - 1.0f) < 1e-6f);
            CHECK(again.opacities[i] == doctest::Approx(scene.opacities[i]).epsilon(1e-6));
        }
    }
}

TEST_CASE("opacity 0 and 1 and scale 0 survive writing exactly") {
    const Folder folder;
    Scene scene;
    for (const float opacity : {0.0f, 1.0f, 1e-6f, 0.999999f}) {
        scene.positions.emplace_back(0.0f);
        scene.rotations.push_back(glm::identity<glm::quat>());
        scene.scales.emplace_back(0.0f, 1e-6f);
        scene.opacities.push_back(opacity);
        scene.sh.insert(scene.sh.end(), {0.0f, 0.0f, 0.0f});
    }
    writePly(scene, folder.file("ends.ply"));
    const Scene again = loadScene(folder.file("ends.ply"));
    REQUIRE(again.size() == 4);
    CHECK(again.opacities[0] == 0.0f);
    CHECK(again.opacities[1] == 1.0f);
    CHECK(again.opacities[2] == doctest::Approx(1e-6).epsilon(1e-5));
    CHECK(again.opacities[3] == doctest::Approx(0.999999).epsilon(1e-6));
    CHECK(again.scales[0].x == 0.0f);
    CHECK(again.scales[0].y == doctest::Approx(1e-6).epsilon(1e-5));
}

TEST_CASE("writing leaves nothing half-written") {
    const Folder folder;
    const Scene scene = makeBuiltin("builtin:one-splat");
    const auto errorOf = [&](const std::string& path) -> std::string {
        try {
            writePly(scene, path);
        } catch (const Error& error) { return error.what(); }
        return {};
    };
    CHECK(contains(errorOf(folder.file("absent/scene.ply")), "cannot be written"));
    CHECK(contains(errorOf(folder.file(".")), "is a directory"));
    std::filesystem::create_symlink("/dev/null", folder.file("device.ply"));
    CHECK(contains(errorOf(folder.file("device.ply")), "not a regular file"));
    std::filesystem::remove(folder.file("device.ply"));
    // An old file stays as it was if the new one does not come to its end.
    writePly(scene, folder.file("kept.ply"));
    CHECK_THROWS_AS(writePly(makeBuiltin("builtin:atelier", 10'000), folder.file("kept.ply"),
                             [](double share) {
                                 if (share > 0.5) { fail("stopped"); }
                             }),
                    Error);
    CHECK(loadScene(folder.file("kept.ply")).size() == 1);
    CHECK(folder.fileCount() == 1);
}

TEST_CASE("loading reports progress from 0 to 1") {
    const Folder folder;
    writePly(makeBuiltin("builtin:atelier", 100'000), folder.file("large.ply"));
    std::vector<double> shares;
    (void)loadScene(folder.file("large.ply"), 0, nullptr, [&](double share) { shares.push_back(share); });
    CHECK(shares.size() > 3);
    CHECK(std::is_sorted(shares.begin(), shares.end()));
    CHECK(shares.front() == 0.0);
    CHECK(shares.back() == 1.0);
}

namespace {

void checkSound(const Scene& scene, std::uint64_t splats) {
    REQUIRE(scene.size() == splats);
    REQUIRE(scene.rotations.size() == splats);
    REQUIRE(scene.scales.size() == splats);
    REQUIRE(scene.opacities.size() == splats);
    REQUIRE(scene.sh.size() == splats * 3 * static_cast<std::size_t>(shCoefficientCount(scene.sh_degree)));
    bool finite = true, unit = true, positive = true, opaque = true;
    for (std::size_t i = 0; i < splats; ++i) {
        finite &= std::isfinite(scene.positions[i].x + scene.positions[i].y + scene.positions[i].z);
        unit &= std::abs(glm::length(scene.rotations[i]) - 1.0f) < 1e-5f;
        positive &= scene.scales[i].x > 0.0f && scene.scales[i].y > 0.0f && std::isfinite(scene.scales[i].x + scene.scales[i].y);
        opaque &= scene.opacities[i] > 0.0f && scene.opacities[i] <= 1.0f;
    }
    for (const float value : scene.sh) { finite &= std::isfinite(value); }
    CHECK(finite);
    CHECK(unit);
    CHECK(positive);
    CHECK(opaque);
}

}  // namespace

TEST_CASE("every built-in scene is sound, repeats exactly and has a view") {
    for (const BuiltinInfo& info : listBuiltins()) {
        CAPTURE(info.name);
        LoadNotes notes;
        const Scene scene = loadScene("builtin:" + info.name, 0, &notes);
        checkSound(scene, info.default_splats);
        CHECK(scene.name == "builtin:" + info.name);
        CHECK(notes.splats_in_file == info.default_splats);
        checkSameScene(scene, makeBuiltin(info.name, info.default_splats));
        CHECK(builtinView(info.name).has_value());
        CHECK(builtinView("builtin:" + info.name)->fov_x_deg > 0.0);
    }
}

TEST_CASE("the atelier has exactly the splats asked for, and its light is baked alike at any number") {
    glm::dvec3 colour_before(0.0);
    for (const std::uint64_t splats : {1000u, 1001u, 4999u, 50'000u, 333'333u}) {
        const Scene scene = makeBuiltin("builtin:atelier", splats);
        checkSound(scene, splats);
        CHECK(scene.sh_degree == 3);
        glm::dvec3 colour(0.0);
        for (std::size_t i = 0; i < splats; ++i) {
            colour += glm::dvec3(scene.sh[48 * i], scene.sh[48 * i + 1], scene.sh[48 * i + 2]) / double(splats);
        }
        if (splats > 1001) { CHECK(glm::length(colour - colour_before) < 0.12); }
        colour_before = colour;
    }
}

TEST_CASE("only the atelier's glazed vase shines") {
    const SceneSummary summary = describeScene(makeBuiltin("builtin:atelier", 200'000));
    for (const std::size_t band : {1u, 2u, 3u}) {
        CHECK(summary.splats_using_band[band] > 200);
        CHECK(summary.splats_using_band[band] < 20'000);
    }
    CHECK(summary.max_position.y < 50.0f);  // y is down: the feet of the hills lie a little below, the sky far above
    CHECK(summary.min_position.y < -100.0f);
    CHECK(summary.max_position.z > 300.0f);
}

TEST_CASE("the analytic scenes are as documented") {
    const Scene slanted = makeBuiltin("builtin:slanted-wall");
    const glm::vec3 t_w = slanted.rotations[0] * glm::vec3(0.0f, 0.0f, 1.0f);
    CHECK(glm::length(t_w - glm::vec3(-std::sqrt(0.5f), 0.0f, std::sqrt(0.5f))) < 1e-6f);
    for (const glm::vec3& p : slanted.positions) { CHECK(p.z == doctest::Approx(4.0 + p.x).epsilon(1e-6)); }
    const Scene one = makeBuiltin("builtin:one-splat");
    CHECK(0.5 + 0.28209479177387814 * one.sh[0] == doctest::Approx(0.9));
    const Scene step = makeBuiltin("builtin:step-edge");
    CHECK(step.positions[29].x == doctest::Approx(-0.05));
    CHECK(step.positions.back().z == 4.0f);
    CHECK(makeBuiltin("builtin:fence").positions[80].y == doctest::Approx(1.0));
    CHECK(makeBuiltin("builtin:two-layers").opacities[0] == 0.5f);
}

TEST_CASE("built-in names and counts that do not exist are refused") {
    const std::string message = loadError("builtin:castle");
    CHECK(contains(message, "builtin:castle: no such built-in scene"));
    for (const BuiltinInfo& info : listBuiltins()) { CHECK(contains(message, info.name)); }
    CHECK(contains(loadError("builtin:atelier", 999), "999 splats asked for, expected 1000 to 10000000"));
    CHECK(contains(loadError("builtin:atelier", 10'000'001), "expected 1000 to 10000000"));
    CHECK(contains(loadError("builtin:one-splat", 2), "expected 1"));
    CHECK_FALSE(builtinView("castle").has_value());
}

TEST_CASE("a summary counts what is there and what is not needed") {
    const Folder folder;
    PlyText ply = makePly(45);
    for (int i = 0; i < 45; ++i) {
        const bool kept = i % 15 < 3;
        for (double& value : ply[fmt::format("f_rest_{}", i)].values) { value = kept ? value : 0.0; }
    }
    ply["opacity"].values[2] = -9.0;
    LoadNotes notes;
    const Scene scene = loadScene(folder.write("bands.ply", ply.bytes()), 0, &notes);
    const SceneSummary summary = describeScene(scene, &notes);
    CHECK(summary.splats == 3);
    CHECK(summary.min_position == glm::vec3(-3.0f, 0.125f, 4.0f));
    CHECK(summary.max_position == glm::vec3(2.0f, 0.5f, 6.0f));
    CHECK(summary.sh_degree == 1);
    CHECK(summary.splats_using_band[1] == 3);
    CHECK(summary.splats_using_band[2] == 0);
    CHECK(summary.invisible_splats == 1);
    CHECK(summary.host_bytes == 3 * (12 + 16 + 8 + 4 + 48));
    CHECK(summary.opacity_quantiles[2] == 0.5f);
    CHECK(summary.scale_quantiles[4] == 1.0f);
    CHECK(summary.scale_quantiles[0] == doctest::Approx(std::exp(-1.5)));
    REQUIRE(summary.left_out.size() == 2);
    CHECK(contains(summary.left_out[0], "SH bands 2 to 3"));
}

TEST_CASE("the shared scenes load whole") {
    const auto data = test::sharedData();
    if (!data) { return; }
    const auto load = [&](const char* file, std::size_t splats, int degree) {
        LoadNotes notes;
        const Scene scene = loadScene((*data / file).string(), 0, &notes);
        CHECK(scene.size() == splats);
        CHECK(scene.sh_degree == degree);
        CHECK(notes.skipped_not_finite + notes.skipped_zero_rotation == 0);
        CHECK_FALSE(notes.three_scales);
    };
    load("playbot/playbot_lod2_2dgs_sh2.ply", 125'000, 2);
    load("playbot/playbot_lod3_2dgs_sh2.ply", 31'000, 2);
    load("statues/angel_2dgs_sh0.ply", 71'359, 0);
}
