// Broken PLY files: one line each that says what is wrong and what was expected.
#include "engine/scene/ply.h"
#include "tests/engine/scene/ply_files.h"

TEST_SUITE_BEGIN("ply_errors");

namespace ply_errors_test {

using namespace binosplat;
using namespace binosplat::test;

TEST_CASE("errors of the source itself say what it is") {
    const Folder folder;
    CHECK(contains(loadError(folder.file("absent.ply")), "absent.ply: no such file"));
    CHECK(contains(loadError(folder.file(".")), "is a directory"));
    CHECK(contains(loadError(folder.write("zero.ply", "")), "is empty"));
#ifndef _WIN32
    CHECK(contains(loadError("/dev/null"), "not a regular file"));
    CHECK(contains(loadError(std::string(5000, 'x')), "cannot be read"));
#endif
    const std::string other = loadError(folder.write("picture.ply", "P6 not a scene"));
    CHECK(contains(other, "not a scene file"));
    CHECK(contains(other, "PLY"));
    CHECK(loadScene(folder.write("named_otherwise.txt", makePly().bytes())).size() == 3);
}

TEST_CASE("a point cloud or a mesh is named as what it is, with the place where a training leaves its splats") {
    const Folder folder;
    for (const Encoding encoding : kEncodings) {
        PlyText ply;
        ply.encoding = encoding;
        for (const char* name : {"x", "y", "z"}) { ply.columns.push_back({name, "float", {1.0, 2.0}}); }
        const auto errorOf = [&] { return loadError(folder.write("points3D.ply", ply.bytes())); };
        CHECK(contains(errorOf(), "points3D.ply: a point cloud (2 points), not a splat scene"));
        for (const char* name : {"nx", "ny", "nz"}) { ply.columns.push_back({name, "float", {0.0, 1.0}}); }
        for (const char* name : {"red", "green", "blue"}) { ply.columns.push_back({name, "uchar", {0.0, 255.0}}); }
        CHECK(contains(errorOf(), "a point cloud (2 points, with colours, with normals)"));
        CHECK(contains(errorOf(), "point_cloud/iteration_N/point_cloud.ply"));
        ply.header_after = "element face 1\nproperty list uchar int vertex_indices\n";
        CHECK(contains(errorOf(), "a mesh (2 vertices, with colours, with normals)"));
        ply.columns.push_back({"opacity", "float", {0.0, 1.0}});  // a splat scene that lacks the rest
        CHECK(contains(errorOf(), "no property f_dc_0"));
    }
}

TEST_CASE("a Git LFS pointer in place of a scene is named as what it is") {
    const Folder folder;
    const std::string pointer = "version https://git-lfs.github.com/spec/v1\noid sha256:" + std::string(64, 'a') + "\nsize 12345\n";
    for (const char* name : {"scene.ply", "scene.splat", "scene.spz", "scene.sog", "meta.json", "lod-meta.json"}) {
        CHECK(contains(loadError(folder.write(name, pointer)), std::string(name) + ": is a Git LFS pointer"));
    }
    CHECK(contains(loadError(folder.write("short", pointer.substr(0, 30))), "not a scene file"));
    CHECK(contains(loadError(folder.write("long", pointer + std::string(2000, 'x'))), "not a scene file"));
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

}  // namespace ply_errors_test
