// Turns the bytes of pixels into stored attributes.
#include "engine/files/sog_splats.h"

#include "engine/error.h"
#include "engine/files/quantized.h"
#include "engine/parallel.h"

#include <algorithm>
#include <cmath>

namespace binosplat {

namespace {

constexpr std::uint64_t kMaxMetaBytes = std::uint64_t{1} << 22;
constexpr std::uint64_t kMaxPictureBytes = std::uint64_t{1} << 30;

// The low bytes of positions are noise: a scene with so many pixels has more bytes than that.
std::uint64_t mostPixels(std::uint64_t bytes) { return 256 * bytes + 65536; }

// A picture that is read but not decoded, so that all sizes can be judged first.
struct Packed {
    std::string place;
    std::vector<std::byte> bytes;
    glm::uvec2 size_px{0, 0};

    [[nodiscard]] std::uint64_t pixels() const { return std::uint64_t{size_px.x} * size_px.y; }
};

Packed readPacked(SogFiles& files, const std::string& name) {
    Packed packed{files.place(name), files.read(name, kMaxPictureBytes), {}};
    packed.size_px = webpSize(packed.bytes, packed.place);
    return packed;
}

// The SH degree in version 1, which follows from the width of its palette.
int paletteDegree(const SogPalette& palette, const Packed& centroids) {
    for (int degree = 1; degree <= kMaxShDegree; ++degree) {
        const std::size_t width =
            kSogPaletteColumns * (static_cast<std::size_t>(shCoefficientCount(degree)) - 1);
        if (centroids.size_px.x == width && (palette.sh_degree == 0 || palette.sh_degree == degree)) {
            return degree;
        }
    }
    fail("{}: is {} pixels wide, expected 192, 512 or 960 for SH of degree 1, 2 or 3", centroids.place,
         centroids.size_px.x);
}

SogPictures decodePictures(SogFiles& files, SogMeta& meta, int threads) {
    Packed means_low = readPacked(files, meta.means_files[0]),
           means_high = readPacked(files, meta.means_files[1]);
    Packed scales = readPacked(files, meta.scales_file), quats = readPacked(files, meta.quats_file);
    Packed sh0 = readPacked(files, meta.sh0_file), centroids, labels;
    std::vector<const Packed*> per_splat{&means_low, &means_high, &scales, &quats, &sh0};
    std::vector<const Packed*> all = per_splat;
    if (meta.palette) {
        centroids = readPacked(files, meta.palette->centroids_file);
        labels = readPacked(files, meta.palette->labels_file);
        per_splat.push_back(&labels);
        all.insert(all.end(), {&centroids, &labels});
        meta.palette->sh_degree = paletteDegree(*meta.palette, centroids);
        const std::uint64_t entries = std::uint64_t{kSogPaletteColumns} * centroids.size_px.y;
        if (meta.palette->count == std::numeric_limits<std::uint64_t>::max()) {
            meta.palette->count = entries;
        }
        check(meta.palette->count <= entries, "{}: holds {} entries, expected the {} of meta.json",
              centroids.place, entries, meta.palette->count);
    }
    std::uint64_t total_bytes = 0;
    for (const Packed* packed : all) { total_bytes += packed->bytes.size(); }
    for (const Packed* packed : per_splat) {
        check(packed->size_px == means_low.size_px, "{}: is {} x {}, expected {} x {} as {}", packed->place,
              packed->size_px.x, packed->size_px.y, means_low.size_px.x, means_low.size_px.y,
              meta.means_files[0]);
        check(meta.count <= packed->pixels(), "{}: has {} pixels, expected one for each of {} splats",
              packed->place, packed->pixels(), meta.count);
    }
    for (const Packed* packed : all) {
        check(packed->pixels() <= mostPixels(total_bytes),
              "{}: {} pixels in a scene of {} bytes, expected fewer than 256 per byte", packed->place,
              packed->pixels(), total_bytes);
    }
    SogPictures pictures;
    std::vector<std::pair<Packed*, Pixels*>> work{{&means_low, &pictures.means_low},
                                                  {&means_high, &pictures.means_high},
                                                  {&scales, &pictures.scales},
                                                  {&quats, &pictures.quats},
                                                  {&sh0, &pictures.sh0}};
    if (meta.palette) {
        work.insert(work.end(), {{&centroids, &pictures.centroids}, {&labels, &pictures.labels}});
    }
    forBlocks(work.size(), 1, threads, [&](std::size_t i, std::size_t) {
        auto& [packed, pixels] = work[i];
        *pixels = decodeWebp(packed->bytes, packed->place);
        packed->bytes = {};
    });
    return pictures;
}

// The inverse of x -> sign(x) ln(1 + |x|).
float expandPosition(float value) { return std::copysign(std::expm1(std::abs(value)), value); }

// `sh_degree` is the block's, at least the palette's; the block's old content is overwritten.
void unpackSplat(const SogMeta& meta, const SogPictures& pictures, std::size_t splat, StoredBlock& block,
                 std::size_t row, int sh_degree) {
    const auto put = [&](int attribute, float value) { block.put(attribute, row, value); };
    const std::size_t pixel = 4 * splat;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const int offset = static_cast<int>(axis);
        const int level = pictures.means_high.rgba[pixel + axis] << 8 | pictures.means_low.rgba[pixel + axis];
        const float share = static_cast<float>(level) / 65535.0f;
        put(kStoredX + offset, expandPosition(meta.mins[axis] * (1.0f - share) + meta.maxs[axis] * share));
        put(kStoredScale0 + offset, meta.scales[axis][pictures.scales.rgba[pixel + axis]]);
        put(kStoredDc0 + offset, meta.sh0[axis][pictures.sh0.rgba[pixel + axis]]);
    }
    put(kStoredOpacity, meta.sh0[3][pictures.sh0.rgba[pixel + 3]]);

    // Alpha 252 to 255 says which of w, x, y, z is the largest; the others lie between -1/sqrt(2) and
    // 1/sqrt(2).
    const std::uint8_t* quat = pictures.quats.rgba.data() + pixel;
    const auto component = [&](std::size_t i) {
        return (static_cast<float>(quat[i]) / 255.0f * 2.0f - 1.0f) * 0.70710678f;
    };
    std::array<float, 4> rotation{};  // any other alpha leaves length zero: skipped and counted
    if (quat[3] >= 252) {
        rotation = fromSmallestThree(quat[3] - 252u, {component(0), component(1), component(2)});
    }
    for (std::size_t i = 0; i < 4; ++i) { put(kStoredRot0 + static_cast<int>(i), rotation[i]); }

    const std::size_t in_block = static_cast<std::size_t>(shCoefficientCount(sh_degree)) - 1;
    if (!meta.palette) {
        std::fill_n(block.rest(row), 3 * in_block, 0.0f);
        return;
    }
    const std::size_t coefficients =
        static_cast<std::size_t>(shCoefficientCount(meta.palette->sh_degree)) - 1;
    const std::size_t label =
        pictures.labels.rgba[pixel] | static_cast<std::size_t>(pictures.labels.rgba[pixel + 1]) << 8;
    const bool known = label < meta.palette->count;
    const std::size_t first = (label / kSogPaletteColumns * pictures.centroids.size_px.x) +
                              label % kSogPaletteColumns * coefficients;
    for (std::size_t channel = 0; channel < 3; ++channel) {
        float* rest = block.rest(row) + channel * in_block;
        for (std::size_t k = 0; k < coefficients; ++k) {
            rest[k] = known ? meta.palette->values[pictures.centroids.rgba[4 * (first + k) + channel]]
                            : std::numeric_limits<float>::quiet_NaN();
        }
        std::fill(rest + coefficients, rest + in_block, 0.0f);
    }
}

}  // namespace

void requireSogDecoder(const std::string& source) {
    check(canDecodeWebp(),
          "{}: a SOG scene, which this build cannot read: configure with BINOSPLAT_SOG=ON, or convert it to "
          "PLY or SPZ",
          source);
}

SogSplats::SogSplats(std::unique_ptr<SogFiles> files) : files_(std::move(files)) {
    meta_ = parseSogMeta(files_->read("meta.json", kMaxMetaBytes), files_->place("meta.json"));
    if (meta_.palette && meta_.palette->sh_degree == 0) {
        meta_.palette->sh_degree =
            paletteDegree(*meta_.palette, readPacked(*files_, meta_.palette->centroids_file));
    }
}

std::vector<std::string> SogSplats::pictures() const {
    std::vector<std::string> names{meta_.means_files[0], meta_.means_files[1], meta_.scales_file,
                                   meta_.quats_file, meta_.sh0_file};
    if (meta_.palette) {
        names.insert(names.end(), {meta_.palette->centroids_file, meta_.palette->labels_file});
    }
    return names;
}

void SogSplats::expect() const { files_->expect(pictures(), kMaxPictureBytes); }

void SogSplats::requirePlausibleCount() const {
    std::uint64_t total_bytes = 0;
    for (const std::string& name : pictures()) { total_bytes += files_->sizeBytes(name); }
    check(count() <= mostPixels(total_bytes),
          "{}: count: is {}, expected fewer than 256 for each of the {} bytes of its pictures",
          files_->place("meta.json"), count(), total_bytes);
    files_->close();
}

SogPictures SogSplats::decode(int threads) {
    SogPictures pictures = decodePictures(*files_, meta_, threads);
    files_->close();
    return pictures;
}

void SogSplats::append(const SogPictures& pictures, SplatRange range, int sh_degree, SceneBuilder& builder,
                       const Progress& progress) const {
    StoredBlock block;
    for (std::uint64_t done = 0, blocks = 0; done < range.count; done += block.rows, ++blocks) {
        if (progress && blocks % 128 == 0) {
            progress(static_cast<double>(done) / static_cast<double>(range.count));
        }
        block.rows =
            static_cast<std::size_t>(std::min<std::uint64_t>(StoredBlock::kRows, range.count - done));
        for (std::size_t row = 0; row < block.rows; ++row) {
            unpackSplat(meta_, pictures, range.first + done + row, block, row, sh_degree);
        }
        builder.append(block);
    }
}

}  // namespace binosplat
