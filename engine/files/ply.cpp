// From PLY properties to stored attributes: names, counts, and anything missing.
#include "engine/files/ply.h"

#include "engine/error.h"
#include "engine/files/ply_header.h"
#include "engine/files/ply_moment.h"
#include "engine/files/ply_rows.h"
#include "engine/files/read_ahead.h"
#include "engine/files/scene_builder.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>

namespace binosplat {

namespace {

constexpr std::array<const char*, kStoredRest0> kRequiredNames{
    "x",       "y",       "z",       "f_dc_0", "f_dc_1", "f_dc_2", "opacity",
    "scale_0", "scale_1", "scale_2", "rot_0",  "rot_1",  "rot_2",  "rot_3"};

// The columns that the vertex element provides, and what follows from their number.
struct Layout {
    std::vector<ply::Column> columns;
    int sh_degree = 0;
    int sh_degree_in_file = 0;
    bool three_scales = false;
};

// CloudCompare writes fields that it does not know as scalar_NAME.
void dropPrefixes(ply::Header& header) {
    constexpr std::string_view kPrefix = "scalar_";
    for (ply::Element& element : header.elements) {
        std::set<std::string> names;
        for (const ply::Property& property : element.properties) { names.insert(property.name); }
        for (ply::Property& property : element.properties) {
            if (!property.name.starts_with(kPrefix)) { continue; }
            const std::string plain = property.name.substr(kPrefix.size());
            if (names.insert(plain).second) { property.name = plain; }
        }
    }
}

ply::Header readPlainHeader(InputFile& file) {
    ply::Header header = ply::readHeader(file);
    dropPrefixes(header);
    return header;
}

const ply::Element& findVertexElement(const InputFile& file, const ply::Header& header) {
    const ply::Element* found = nullptr;
    for (const ply::Element& element : header.elements) {
        if (element.name != "vertex") { continue; }
        check(found == nullptr, "{}: header: element vertex twice", file.name());
        found = &element;
    }
    check(found != nullptr, "{}: header: no element vertex, expected one with the splats", file.name());
    return *found;
}

// Such files lie beside every training's output, under names like input.ply, points3D.ply and fused.ply.
void refusePointCloud(const InputFile& file, const ply::Header& header, const ply::Element& vertex) {
    const auto has = [&](std::string_view name) {
        return std::ranges::find(vertex.properties, name, &ply::Property::name) != vertex.properties.end();
    };
    const bool any_splat = has("f_dc_0") || has("opacity") || has("scale_0") || has("rot_0");
    if (any_splat || !has("x") || !has("y") || !has("z")) { return; }
    const bool faces = std::ranges::any_of(
        header.elements, [](const ply::Element& e) { return e.name == "face" && e.count > 0; });
    fail(
        "{}: a {} ({} {}{}{}), not a splat scene, expected the one that a training leaves in "
        "point_cloud/iteration_N/point_cloud.ply",
        file.name(), faces ? "mesh" : "point cloud", vertex.count, faces ? "vertices" : "points",
        has("red") || has("r") || has("diffuse_red") ? ", with colours" : "",
        has("nx") ? ", with normals" : "");
}

void refuseAnchors(const InputFile& file, const ply::Element& vertex) {
    const bool has_features = std::ranges::any_of(
        vertex.properties, [](const ply::Property& p) { return p.name.starts_with("f_anchor_feat"); });
    check(!has_features,
          "{}: anchors of Scaffold-GS, from which a network makes other splats for each view, expected "
          "splats as a 3DGS or 2DGS training "
          "leaves them",
          file.name());
}

const ply::Element& findSplats(const InputFile& file, const ply::Header& header) {
    const ply::Element& vertex = findVertexElement(file, header);
    refusePointCloud(file, header, vertex);
    refuseAnchors(file, vertex);
    return vertex;
}

// Harmonics of one channel, without the constant one.
std::size_t restPerChannel(int sh_degree) {
    return static_cast<std::size_t>(shCoefficientCount(sh_degree)) - 1;
}

Layout planColumns(const InputFile& file, const ply::Element& vertex) {
    std::map<std::string, std::size_t> index_of;
    std::size_t rest_count = 0;
    for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
        const ply::Property& property = vertex.properties[i];
        check(!property.is_list, "{}: header: property {} of element vertex is a list, expected scalars only",
              file.name(), property.name);
        check(index_of.emplace(property.name, i).second, "{}: header: property {} of element vertex twice",
              file.name(), property.name);
        rest_count += property.name.starts_with("f_rest_");
    }

    Layout layout;
    layout.three_scales = index_of.contains("scale_2");
    for (int attribute = 0; attribute < kStoredRest0; ++attribute) {
        const char* name = kRequiredNames[static_cast<std::size_t>(attribute)];
        if (attribute == kStoredScale2 && !layout.three_scales) { continue; }
        const auto found = index_of.find(name);
        check(found != index_of.end(),
              "{}: header: element vertex has no property {}, expected a splat scene with x y z f_dc_0..2 "
              "opacity scale_0..1 rot_0..3",
              file.name(), name);
        layout.columns.push_back({found->second, attribute});
    }
    constexpr int kMostDegree = kMaxShDegree + 1;  // its highest band is left out
    int& in_file = layout.sh_degree_in_file;
    while (in_file <= kMostDegree && 3 * restPerChannel(in_file) != rest_count) { ++in_file; }
    check(in_file <= kMostDegree,
          "{}: header: element vertex has {} f_rest properties, expected 0, 9, 24, 45 or 72", file.name(),
          rest_count);
    layout.sh_degree = std::min(in_file, kMaxShDegree);
    int attribute = kStoredRest0;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        for (std::size_t k = 0; k < restPerChannel(layout.sh_degree); ++k, ++attribute) {
            const std::size_t i = channel * restPerChannel(in_file) + k;
            const auto found = index_of.find(fmt::format("f_rest_{}", i));
            check(found != index_of.end(),
                  "{}: header: element vertex has {} f_rest properties but no f_rest_{}", file.name(),
                  rest_count, i);
            layout.columns.push_back({found->second, attribute});
        }
    }
    return layout;
}

// True if all scales so far are positive and all opacities within 0 to 1: no training has such logarithms and
// logits.
bool looksActivated(const StoredBlock& block, bool three_scales) {
    const auto all = [&](int attribute, auto&& isSo) {
        return std::all_of(block.column(attribute), block.column(attribute) + block.rows, isSo);
    };
    const auto is_positive = [](float value) { return value > 0.0f; };
    return all(kStoredOpacity, [](float value) { return value >= 0.0f && value <= 1.0f; }) &&
           all(kStoredScale0, is_positive) && all(kStoredScale1, is_positive) &&
           (!three_scales || all(kStoredScale2, is_positive));
}

// Only for float64 axes: float32 has lost its detail already.
glm::dvec3 findOrigin(const ply::Element& vertex, const Layout& layout, const StoredBlock& some) {
    glm::dvec3 origin(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const ply::Column& column = layout.columns[static_cast<std::size_t>(axis)];
        if (vertex.properties[column.property].type != ply::Type::kFloat64) { continue; }
        origin[axis] = originAbout(medianOf(some, column.attribute));
    }
    return origin;
}

// A file before its first splat.
struct OpenedPly {
    explicit OpenedPly(InputFile& file)
        : header(readPlainHeader(file)),
          vertex(findSplats(file, header)),
          layout(planColumns(file, vertex)),
          moment(vertex, kStoredRest0 + 3 * static_cast<int>(restPerChannel(layout.sh_degree)),
                 layout.columns) {
        for (const ply::Element* element = header.elements.data(); element != &vertex; ++element) {
            ply::skipElement(file, header.encoding, *element);
        }
        rows = ply::openRows(file, header, vertex, layout.columns);
        rows->sample(some);
        origin = findOrigin(vertex, layout, some);
        rows->countFrom(origin);
    }

    ply::Header header;
    const ply::Element& vertex;
    Layout layout;
    ply::Moment moment;  // of splats that move
    std::unique_ptr<ply::RowReader> rows;
    StoredBlock some;
    glm::dvec3 origin{0.0};
};

// Notes about the parts, as about one scene.
void addNotes(LoadNotes& notes, LoadNotes part) {
    part.skipped_not_finite += notes.skipped_not_finite;
    part.skipped_zero_rotation += notes.skipped_zero_rotation;
    part.lines.insert(part.lines.begin(), notes.lines.begin(), notes.lines.end());
    notes = std::move(part);
}

void readParts(InputFile& file, std::uint64_t part_splats, LoadNotes& notes, const Progress& progress,
               const std::function<void(Scene)>& take) {
    OpenedPly ply(file);
    const ply::Element& vertex = ply.vertex;
    const Layout& layout = ply.layout;
    ply::Moment& moment = ply.moment;

    constexpr std::uint64_t kBlocksPerReport = 128;
    if (progress) { progress(0.0); }
    moment.choose(ply.some);
    if (moment.isDynamic()) { moment.apply(ply.some); }
    std::uint64_t done = 0, count = 0, in_part = 0;
    const auto begin = [&] {
        in_part = 0;
        SceneBuilder builder(file.name(), std::min(part_splats, vertex.count - done), layout.sh_degree,
                             layout.three_scales);
        builder.expect(ply.some);
        return builder;
    };
    SceneBuilder builder = begin();
    notes = {};
    const auto end = [&] {
        LoadNotes of_part;
        Scene scene = builder.finish(of_part);
        scene.antialiased = ply.header.antialiased && layout.three_scales;
        scene.vertical_axis = ply.header.vertical_axis;
        setOrigin(scene, ply.origin, of_part);
        addNotes(notes, std::move(of_part));
        take(std::move(scene));
    };
    ReadAhead blocks(vertex.count, [&](ReadAhead::Block& block) {
        ply.rows->read(block.stored);
        if (moment.isDynamic()) { moment.apply(block.stored); }
        activate(block.stored, layout.sh_degree, layout.three_scales, block.active);
    });
    bool activated = vertex.count > 0;
    while (const ReadAhead::Block* block = blocks.next()) {
        if (in_part >= part_splats) { end(), builder = begin(); }
        activated = activated && looksActivated(block->stored, layout.three_scales);
        builder.append(block->stored, block->active);
        done += block->stored.rows, in_part += block->stored.rows;
        if (progress && ++count % kBlocksPerReport == 0) {
            progress(static_cast<double>(done) / static_cast<double>(vertex.count));
        }
    }
    if (progress) { progress(1.0); }
    end();
    notes.splats_in_file = vertex.count;
    if (ply.header.vertical_axis >= 0) {
        notes.axes = fmt::format("{} is vertical (named by the file)", "xyz"[ply.header.vertical_axis]);
    }
    if (layout.sh_degree_in_file > layout.sh_degree) {
        notes.lines.push_back(fmt::format("{}: SH of degree {} were left out, degree {} is kept", file.name(),
                                          layout.sh_degree_in_file, layout.sh_degree));
    }
    if (moment.isDynamic()) { notes.lines.push_back(fmt::format("{}: {}", file.name(), moment.describe())); }
    if (activated) {
        notes.lines.push_back(
            fmt::format("{}: all scales are positive and all opacities lie within 0 to 1: it looks as if it "
                        "was written with the activations "
                        "applied; it was read as trainings write it, as logarithms and logits",
                        file.name()));
    }
}

}  // namespace

bool isPly(InputFile& file) {
    const std::string_view start = withoutByteOrderMark(file.peek(8));
    return start.starts_with("ply\n") || start.starts_with("ply\r\n");
}

glm::dvec3 originOfPly(InputFile& file) { return OpenedPly(file).origin; }

std::uint64_t countPly(InputFile& file) { return OpenedPly(file).vertex.count; }

Scene readPly(InputFile& file, LoadNotes& notes, const Progress& progress) {
    Scene scene;
    readParts(file, std::numeric_limits<std::uint64_t>::max(), notes, progress,
              [&](Scene part) { scene = std::move(part); });
    return scene;
}

void readPlyParts(InputFile& file, std::uint64_t part_splats, LoadNotes& notes,
                  const std::function<void(Scene)>& take) {
    readParts(file, part_splats, notes, {}, take);
}

}  // namespace binosplat
